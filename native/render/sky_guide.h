#pragma once

#include <memory>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "render/context.h"
#include "render/environment.h"
#include "render/sky_places.h"

namespace komorebi {

/// Decides before a render where its light rays go: to the parts of the sky that its surfaces see
/// (SkyVisibility), and where these see different parts, by their place (SkyPlaces). Under a map
/// that is sampled by its product with the cosine, always; for ambient occlusion, where most rays
/// would be spent on what hides the sky.
class SkyGuide {
 public:
  /// Sets `sky` and `product` of a context that make_context made, once; valid as long as this
  /// lives. Without effect when cancelled: then it is to be called again.
  void prepare(const Scene& scene, ThreadPool& pool, const Cancel& cancel, RenderContext& context);

 private:
  bool done_ = false;
  std::unique_ptr<const SkyPlaces> places_;
  std::unique_ptr<const ProductTable> table_;
};

}  // namespace komorebi
