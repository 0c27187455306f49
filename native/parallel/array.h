#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "parallel/pages.h"

namespace komorebi {

/// Allocates as std::allocator does, with two differences that a large array's filling feels:
/// elements made without a value stay as they are (they are about to be written, by all threads),
/// and large arrays come in huge pages, where a fresh page is 512 times rarer.
template <class T>
class ArrayAllocator {
 public:
  using value_type = T;
  ArrayAllocator() = default;
  // Implicit, as the standard's.
  template <class U>
  ArrayAllocator(const ArrayAllocator<U>&) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(bytes >= kLarge ? map_pages(whole_huge_pages(bytes))
                                           : ::operator new(bytes, kAlignment));
  }
  void deallocate(T* memory, std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes >= kLarge) {
      unmap_pages(memory, whole_huge_pages(bytes));
    } else {
      ::operator delete(memory, kAlignment);
    }
  }

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const ArrayAllocator&, const ArrayAllocator&) { return true; }

 private:
  static constexpr std::size_t kLarge = 2 * kHugePage;  ///< bytes
  static constexpr std::align_val_t kAlignment{64};
};

/// A std::vector that `resize` does not fill: whoever resizes it writes every element.
template <class T>
using Array = std::vector<T, ArrayAllocator<T>>;

}  // namespace komorebi
