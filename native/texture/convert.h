#pragma once

#include <cstdint>

#include "parallel/thread_pool.h"
#include "texture/texture.h"

namespace komorebi {

// When cancelled they leave what they have begun half done.

/// Makes texels of which a channel is not finite black and transparent; returns how many.
std::uint64_t clean_texels(Texels& texels, ThreadPool& pool, const Cancel& cancel);

/// What texels are stored as once their colours are those of another space.
inline TexelType converted_type(TexelType type) {
  return type == TexelType::kFloat ? TexelType::kFloat : TexelType::kHalf;
}

/// Texels of another space as linear Rec. 709: divided by alpha (unless they are data), decoded,
/// multiplied by the matrix, and by alpha again. A grey becomes the mean of its three channels.
Texels convert_texels(Texels texels, const TextureColor& color, ThreadPool& pool,
                      const Cancel& cancel);

}  // namespace komorebi
