#include "parallel/scratch.h"

#include <algorithm>
#include <mutex>
#include <new>
#include <vector>

#include "parallel/pages.h"

namespace komorebi {
namespace {

struct Block {
  void* data;
  std::size_t capacity;
};

struct Kept {
  std::mutex mutex;
  std::vector<Block> blocks;
  std::size_t bytes = 0;
};

/// Never destroyed: a build on a host's thread may outlive the module's static objects.
Kept& kept() {
  static Kept* const blocks = new Kept;
  return *blocks;
}

void free_block(const Block& block) {
  if (block.capacity < kHugePage) {
    ::operator delete (block.data, std::align_val_t{64});
  } else {
    unmap_pages(block.data, block.capacity);
  }
}

}  // namespace

void* borrow_scratch(std::size_t bytes, std::size_t* capacity) {
  {
    Kept& pool = kept();
    const std::lock_guard lock(pool.mutex);
    // The smallest block that holds it without wasting more than half.
    auto best = pool.blocks.end();
    for (auto block = pool.blocks.begin(); block != pool.blocks.end(); ++block) {
      if (block->capacity < bytes || block->capacity / 2 > bytes + kHugePage) continue;
      if (best == pool.blocks.end() || block->capacity < best->capacity) best = block;
    }
    if (best != pool.blocks.end()) {
      const Block block = *best;
      pool.blocks.erase(best);
      pool.bytes -= block.capacity;
      *capacity = block.capacity;
      return block.data;
    }
  }
  if (bytes < kHugePage) {
    *capacity = std::max<std::size_t>(bytes, 64);
    return ::operator new (*capacity, std::align_val_t{64});
  }
  *capacity = whole_huge_pages(bytes);
  return map_pages(*capacity);
}

void return_scratch(void* block, std::size_t capacity) {
  {
    Kept& pool = kept();
    const std::lock_guard lock(pool.mutex);
    if (capacity <= kScratchKept - pool.bytes) {
      pool.blocks.push_back({block, capacity});
      pool.bytes += capacity;
      return;
    }
  }
  free_block({block, capacity});
}

void release_scratch() {
  Kept& pool = kept();
  const std::lock_guard lock(pool.mutex);
  for (const Block& block : pool.blocks) free_block(block);
  pool.blocks.clear();
  pool.bytes = 0;
}

}  // namespace komorebi
