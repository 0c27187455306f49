#pragma once

#include <cstdlib>
#include <memory>
#include <new>

namespace komorebi {

/// An array of zeros of which the system gives the pages only when they are first written, by the
/// thread that writes them: a large frame costs nothing before its first tile.
template <class T>
class ZeroedArray {
 public:
  ZeroedArray() = default;
  explicit ZeroedArray(std::size_t size) : size_(size) {
    if (size == 0) return;
    values_.reset(static_cast<T*>(std::calloc(size, sizeof(T))));
    if (!values_) throw std::bad_alloc();
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }
  T& operator[](std::size_t i) { return values_.get()[i]; }
  const T& operator[](std::size_t i) const { return values_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T, Free> values_;
  std::size_t size_ = 0;
};

}  // namespace komorebi
