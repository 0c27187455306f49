#include "render/sky_guide.h"

#include "render/sky_visibility.h"

namespace komorebi {
namespace {

/// Ambient occlusion from the cosine alone has no noise where nothing is hidden, and costs least a
/// ray: it is left only where so little of its variance would remain (docs/performance.md).
constexpr float kWorthwhile = 0.45f;

/// Places are looked at more closely if few rays let this much of the variance be expected by them,
/// and get tables if it is confirmed.
constexpr float kWorthSurvey = 0.97f, kWorthTables = 0.9f;

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
  RenderContext looked_by = context;
  if (context.fast_gi.last_vertex != kNone) end_in_ambient(looked_by);  // sees most of the sky
  SkySurvey survey;
  if (!survey_sky(looked_by, kWholeSurvey, pool, cancel, survey)) return;
  auto visibility = std::make_unique<const SkyVisibility>(survey);
  std::unique_ptr<const SkyPlaces> places;
  const SkyPlaces trial(survey, *visibility, pool, SkyPlaces::Purpose::kTrial);
  if (trial.variance_left() < kWorthSurvey) {
    SkySurvey closer;
    if (!survey_sky(looked_by, kPlacesSurvey, pool, cancel, closer)) return;
    if (closer.cells.size() > survey.cells.size()) {
      survey = std::move(closer);
      visibility = std::make_unique<const SkyVisibility>(survey);
    }
    places = std::make_unique<const SkyPlaces>(survey, *visibility, pool);
  }
  done_ = true;
  const bool has_places = places != nullptr && places->variance_left() < kWorthTables;
  if (ambient) {
    const float gained = has_places ? places->variance_left() : 1.0f;
    if (visibility->variance_left() * gained > kWorthwhile) return;
    context.sky = white_sky().view();
  }
  const Environment& map = ambient ? white_sky() : *scene.world_environment();
  auto table = std::make_unique<ProductTable>(map.product_table(), *visibility, pool);
  if (has_places) {
    places_ = std::move(places);
    table->add_places(*places_, pool);
  }
  table_ = std::move(table);
  context.product = table_->view();
}

}  // namespace komorebi
