#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

#include "parallel/pages.h"
#include "parallel/scratch.h"

namespace komorebi {

/// An array whose length is known when it has been filled: there is room for the most that it may
/// get. Where that is much, the room is address space, memory stands behind what is written, and
/// the end gives back the rest; where it is little, it is filled on the side and then copied.
template <class T>
class LateArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LateArray() = default;
  explicit LateArray(std::size_t room) {
    if (room * sizeof(T) >= kMuch) {
      mapped_ = whole_huge_pages(room * sizeof(T));
      data_ = static_cast<T*>(map_pages(mapped_));
    } else {
      aside_ = Scratch<T>(room);
    }
  }
  LateArray(LateArray&& other) noexcept { swap(other); }
  LateArray& operator=(LateArray&& other) noexcept {
    LateArray(std::move(other)).swap(*this);
    return *this;
  }
  ~LateArray() {
    if (mapped_ > 0) {
      unmap_pages(data_, mapped_);
    } else if (data_ != nullptr) {
      ::operator delete(data_, kAlignment);
    }
  }

  /// Where to write, before the end.
  T* room() { return mapped_ > 0 ? data_ : aside_.data(); }
  /// Has memory put behind these bytes of the room, what is there staying as it is.
  void back(std::size_t first, std::size_t last) {
    last = std::min(last, mapped_);
    if (first < last) back_pages(reinterpret_cast<std::byte*>(data_) + first, last - first);
  }
  /// The first `size` values have been written.
  void end_at(std::size_t size) {
    size_ = size;
    if (mapped_ > 0) {
      mapped_ = trim_pages(data_, mapped_, size * sizeof(T));
      if (mapped_ == 0) data_ = nullptr;
    } else if (size > 0) {
      data_ = static_cast<T*>(::operator new(size * sizeof(T), kAlignment));
      std::copy_n(aside_.data(), size, data_);
    }
    aside_ = Scratch<T>();
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t byte_count() const { return size_ * sizeof(T); }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  static constexpr std::size_t kMuch = 2 * kHugePage;  ///< bytes
  static constexpr std::align_val_t kAlignment{64};

  void swap(LateArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    std::swap(aside_, other.aside_);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t mapped_ = 0;  ///< bytes
  Scratch<T> aside_;
};

}  // namespace komorebi
