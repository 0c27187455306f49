#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace komorebi {

/// Allocates as std::allocator does, with two differences that a large array's filling feels:
/// elements made without a value stay as they are (they are about to be written, by all threads),
/// and large arrays ask the system for huge pages, where a fresh page is 512 times rarer.
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
    void* memory = ::operator new(bytes, alignment(count));
#if defined(__linux__)
    // Advice: where it is refused, the pages are small ones.
    if (bytes >= kLarge) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    ::operator delete(memory, alignment(count));
  }

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const ArrayAllocator&, const ArrayAllocator&) {
    return true;
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;
  static constexpr std::size_t kLarge = 2 * kHugePage;  ///< bytes

  static std::align_val_t alignment(std::size_t count) {
    return std::align_val_t{count * sizeof(T) >= kLarge ? kHugePage : 64};
  }
};

/// A std::vector that `resize` does not fill: whoever resizes it writes every element.
template <class T>
using Array = std::vector<T, ArrayAllocator<T>>;

}  // namespace komorebi
