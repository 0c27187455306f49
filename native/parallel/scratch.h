#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace komorebi {

/// Memory for the time of a build, uninitialised. Fresh pages cost a fast build up to a third of
/// its time, so the blocks of builds that have ended are kept for the next ones, up to
/// kScratchKept bytes in all; a block that has no place there goes back to the system.
void* borrow_scratch(std::size_t bytes, std::size_t* capacity);
void return_scratch(void* block, std::size_t capacity);
/// Gives every kept block back to the system, as a cold start would find it.
void release_scratch();

inline constexpr std::size_t kScratchKept = std::size_t{1} << 28;

/// An array of `count` values that nobody has written yet.
template <class T>
class Scratch {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  Scratch() = default;
  explicit Scratch(std::size_t count)
      : size_(count), data_(static_cast<T*>(borrow_scratch(count * sizeof(T), &capacity_))) {}
  Scratch(Scratch&& other) noexcept { swap(other); }
  Scratch& operator=(Scratch&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Scratch() {
    if (data_ != nullptr) return_scratch(data_, capacity_);
  }

  std::size_t size() const { return size_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  void swap(Scratch& other) noexcept {
    std::swap(capacity_, other.capacity_);
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
  }

  std::size_t capacity_ = 0;  ///< bytes
  std::size_t size_ = 0;
  T* data_ = nullptr;
};

}  // namespace komorebi
