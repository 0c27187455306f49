#include "render/shade.h"

namespace komorebi {

void shade_surfaces(const RenderContext& context, std::uint32_t vertex, SurfaceBatch& surfaces) {
  const Shading shading = shade_surface(context, vertex);
  surfaces.make_room_for_shading();
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    surfaces.set_shading(s, shading);
  }
}

}  // namespace komorebi
