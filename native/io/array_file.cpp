#include "io/array_file.h"

#include <bit>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace komorebi {
namespace {

static_assert(std::endian::native == std::endian::little, "the file format is little-endian");

constexpr char kMagic[8] = {'K', 'O', 'M', 'O', 'R', 'E', 'B', 'I'};
constexpr std::uint32_t kVersion = 1;

template <class T>
constexpr ArrayFile::Type type_of();
template <>
constexpr ArrayFile::Type type_of<std::uint8_t>() {
  return ArrayFile::Type::kUint8;
}
template <>
constexpr ArrayFile::Type type_of<std::int32_t>() {
  return ArrayFile::Type::kInt32;
}
template <>
constexpr ArrayFile::Type type_of<std::uint32_t>() {
  return ArrayFile::Type::kUint32;
}
template <>
constexpr ArrayFile::Type type_of<std::int64_t>() {
  return ArrayFile::Type::kInt64;
}
template <>
constexpr ArrayFile::Type type_of<float>() {
  return ArrayFile::Type::kFloat32;
}
template <>
constexpr ArrayFile::Type type_of<double>() {
  return ArrayFile::Type::kFloat64;
}

std::size_t size_of(std::uint32_t type) {
  constexpr std::size_t kSizes[] = {0, 1, 4, 4, 8, 4, 8};
  return type < std::size(kSizes) ? kSizes[type] : 0;
}

/// Reads a file front to back; every length is checked against what is left before it is believed.
class Reader {
 public:
  explicit Reader(const std::string& path)
      : path_(path), file_(path, std::ios::binary | std::ios::ate) {
    if (!file_) fail("cannot be opened");
    left_ = static_cast<std::uint64_t>(file_.tellg());
    file_.seekg(0);
  }
  [[noreturn]] void fail(const char* what) const {
    throw std::runtime_error("scene file \"" + path_ + "\" " + what);
  }
  void bytes(void* out, std::uint64_t n) {
    if (n > left_) fail("is cut short");
    file_.read(static_cast<char*>(out), static_cast<std::streamsize>(n));
    if (!file_) fail("cannot be read");
    left_ -= n;
  }
  template <class T>
  T value() {
    T v;
    bytes(&v, sizeof v);
    return v;
  }
  std::uint64_t left() const { return left_; }

 private:
  std::string path_;
  std::ifstream file_;
  std::uint64_t left_ = 0;
};

}  // namespace

ArrayFile ArrayFile::read(const std::string& path) {
  Reader in(path);
  char magic[8];
  in.bytes(magic, sizeof magic);
  if (std::memcmp(magic, kMagic, sizeof magic) != 0) in.fail("is not a Komorebi scene");
  if (in.value<std::uint32_t>() != kVersion) in.fail("has a version that this program cannot read");
  ArrayFile file;
  for (auto n = in.value<std::uint32_t>(); n > 0; --n) {
    const auto name_length = in.value<std::uint32_t>();
    if (name_length > in.left()) in.fail("is cut short");
    std::string name(name_length, '\0');
    in.bytes(name.data(), name_length);
    Array array;
    const auto type = in.value<std::uint32_t>();
    std::uint64_t size = size_of(type);
    if (size == 0) in.fail("holds an array of an unknown type");
    array.type = static_cast<Type>(type);
    const auto dimensions = in.value<std::uint32_t>();
    if (dimensions > 8) in.fail("holds an array of more than eight dimensions");
    for (std::uint32_t d = 0; d < dimensions; ++d) {
      array.shape.push_back(in.value<std::uint64_t>());
      if (array.shape.back() != 0 && size > in.left() / array.shape.back()) in.fail("is cut short");
      size *= array.shape.back();
    }
    if (size > in.left()) in.fail("is cut short");
    array.bytes.resize(size);
    in.bytes(array.bytes.data(), size);
    if (!file.arrays_.emplace(std::move(name), std::move(array)).second) {
      in.fail("holds two arrays of one name");
    }
  }
  if (in.left() != 0) in.fail("has bytes after its end");
  return file;
}

void ArrayFile::write(const std::string& path) const {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](const auto& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
  };
  out.write(kMagic, sizeof kMagic);
  put(kVersion);
  put(static_cast<std::uint32_t>(arrays_.size()));
  for (const auto& [name, array] : arrays_) {
    put(static_cast<std::uint32_t>(name.size()));
    out.write(name.data(), static_cast<std::streamsize>(name.size()));
    put(static_cast<std::uint32_t>(array.type));
    put(static_cast<std::uint32_t>(array.shape.size()));
    for (const std::uint64_t n : array.shape) put(n);
    out.write(reinterpret_cast<const char*>(array.bytes.data()),
              static_cast<std::streamsize>(array.bytes.size()));
  }
  out.close();
  if (!out) throw std::runtime_error("scene file \"" + path + "\" cannot be written");
}

template <class T>
void ArrayFile::put(const std::string& name, std::span<const T> values,
                    std::vector<std::uint64_t> shape) {
  Array array{type_of<T>(), std::move(shape), std::vector<std::byte>(values.size_bytes())};
  if (!values.empty()) std::memcpy(array.bytes.data(), values.data(), values.size_bytes());
  arrays_[name] = std::move(array);
}

void ArrayFile::put_text(const std::string& name, const std::string& text) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(text.data());
  put<std::uint8_t>(name, {data, text.size()}, {text.size()});
}

const ArrayFile::Array& ArrayFile::array(const std::string& name) const {
  const auto found = arrays_.find(name);
  if (found == arrays_.end()) throw std::runtime_error("the scene has no array \"" + name + "\"");
  return found->second;
}

template <class T>
std::vector<T> ArrayFile::get(const std::string& name, std::uint64_t count) const {
  const Array& found = array(name);
  if (found.type != type_of<T>()) {
    throw std::runtime_error("the scene's array \"" + name + "\" has another type than expected");
  }
  std::vector<T> values(found.bytes.size() / sizeof(T));
  if (count != kAny && values.size() != count) {
    throw std::runtime_error("the scene's array \"" + name + "\" has " +
                             std::to_string(values.size()) + " values, not " +
                             std::to_string(count));
  }
  if (!values.empty()) std::memcpy(values.data(), found.bytes.data(), found.bytes.size());
  return values;
}

std::string ArrayFile::get_text(const std::string& name) const {
  const auto bytes = get<std::uint8_t>(name);
  return {bytes.begin(), bytes.end()};
}

#define KOMOREBI_ARRAY_TYPE(T)                                            \
  template void ArrayFile::put<T>(const std::string&, std::span<const T>, \
                                  std::vector<std::uint64_t>);            \
  template std::vector<T> ArrayFile::get<T>(const std::string&, std::uint64_t) const;
KOMOREBI_ARRAY_TYPE(std::uint8_t)
KOMOREBI_ARRAY_TYPE(std::int32_t)
KOMOREBI_ARRAY_TYPE(std::uint32_t)
KOMOREBI_ARRAY_TYPE(std::int64_t)
KOMOREBI_ARRAY_TYPE(float)
KOMOREBI_ARRAY_TYPE(double)
#undef KOMOREBI_ARRAY_TYPE

}  // namespace komorebi
