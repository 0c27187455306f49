#include "render/content_hash.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

namespace komorebi {
namespace {

__extension__ using Wide = unsigned __int128;
constexpr std::size_t kWords = kHashBlock / sizeof(std::uint64_t);
using Key = std::array<std::uint64_t, kWords + 2>;  // the second pass starts two words further

const Key& process_key() {
  static const Key key = [] {
    std::random_device device;
    Key words{};
    for (std::uint64_t& word : words) word = (std::uint64_t{device()} << 32) | device();
    return words;
  }();
  return key;
}

void tag_block(const std::uint64_t* words, const Key& key, std::uint64_t* tag) {
  Wide first = 0, second = 0;
  for (std::size_t i = 0; i < kWords; i += 2) {
    first += Wide{words[i] + key[i]} * (words[i + 1] + key[i + 1]);
    second += Wide{words[i] + key[i + 2]} * (words[i + 1] + key[i + 3]);
  }
  tag[0] = static_cast<std::uint64_t>(first);
  tag[1] = static_cast<std::uint64_t>(first >> 64);
  tag[2] = static_cast<std::uint64_t>(second);
  tag[3] = static_cast<std::uint64_t>(second >> 64);
}

}  // namespace

std::vector<std::uint64_t> content_tags(std::span<const std::byte> bytes, ThreadPool& pool) {
  constexpr std::size_t kGrain = 64;  // blocks
  const Key& key = process_key();
  const std::size_t blocks = (bytes.size() + kHashBlock - 1) / kHashBlock;
  std::vector<std::uint64_t> tags(4 * blocks);
  pool.for_each_chunk(blocks, kGrain, [&](std::size_t begin, std::size_t end) {
    std::array<std::uint64_t, kWords> words;
    for (std::size_t b = begin; b < end; ++b) {
      const std::span<const std::byte> block =
          bytes.subspan(b * kHashBlock, std::min(kHashBlock, bytes.size() - b * kHashBlock));
      if (block.size() < kHashBlock) words.fill(0);  // the length tells padding from zeros
      std::memcpy(words.data(), block.data(), block.size());
      tag_block(words.data(), key, &tags[4 * b]);
    }
  });
  return tags;
}

}  // namespace komorebi
