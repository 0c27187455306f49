#include "render/sky_guide.h"

#include "render/sky_visibility.h"

namespace komorebi {
namespace {

/// Ambient occlusion from the cosine alone has no noise where nothing is hidden, and costs least a
/// ray: it is left only where so little of its variance would remain (docs/performance.md).
constexpr float kWorthwhile = 0.45f;

/// A white map whose patches are the table's cells.
const Environment& white_sky() {
  constexpr std::uint32_t kWidth = 64, kHeight = 31;
  static const Environment sky("white", kWidth, kHeight,
                               std::vector<float>(3 * kWidth * kHeight, 1.0f));
  return sky;  // its tables are made once, not every frame
}

}  // namespace

void SkyGuide::prepare(const Scene& scene, ThreadPool& pool, const Cancel& cancel,
                       RenderContext& context) {
  const bool ambient = context.method == Method::kAmbientOcclusion;
  if (done_ ||
      (context.product.bins == 0 && !(ambient && context.ao_sampling == AoSampling::kCosine))) {
    return;
  }
  SkyVisibility visibility;
  RenderContext looked_by = context;
  if (context.fast_gi.last_vertex != kNone) end_in_ambient(looked_by);  // sees most of the sky
  if (!measure_sky_visibility(looked_by, pool, cancel, visibility)) return;
  done_ = true;
  if (ambient) {
    if (visibility.variance_left() > kWorthwhile) return;
    context.sky = white_sky().view();
  }
  const Environment& map = ambient ? white_sky() : *scene.world_environment();
  table_ = std::make_unique<ProductTable>(map.product_table(), visibility, pool);
  context.product = table_->view();
}

}  // namespace komorebi
