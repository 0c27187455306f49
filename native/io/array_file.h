#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace komorebi {

/// A file of named arrays: what a dumped scene is made of. Little-endian, no compression:
///
///     8 bytes   "KOMOREBI"
///     uint32    version (1)
///     uint32    number of arrays
///     for each array:
///       uint32  length of the name, then the name in UTF-8
///       uint32  type: 1 uint8, 2 int32, 3 uint32, 4 int64, 5 float32, 6 float64
///       uint32  number of dimensions, then that many uint64, slowest first
///       the values, without padding
///
/// Readers refuse other versions, truncated files and trailing bytes.
class ArrayFile {
 public:
  enum class Type : std::uint32_t {
    kUint8 = 1,
    kInt32 = 2,
    kUint32 = 3,
    kInt64 = 4,
    kFloat32 = 5,
    kFloat64 = 6
  };
  struct Array {
    Type type = Type::kUint8;
    std::vector<std::uint64_t> shape;
    std::vector<std::byte> bytes;
  };

  /// Throws std::runtime_error naming the file.
  static ArrayFile read(const std::string& path);
  void write(const std::string& path) const;

  template <class T>
  void put(const std::string& name, std::span<const T> values, std::vector<std::uint64_t> shape);
  void put_text(const std::string& name, const std::string& text);
  template <class T>
  void put_value(const std::string& name, T value) {
    put<T>(name, std::span<const T>(&value, 1), {});
  }

  bool has(const std::string& name) const { return arrays_.count(name) != 0; }
  /// The values of an array; throws std::runtime_error naming the array when it is missing, of
  /// another type, or does not hold `count` values (any number when `count` is kAny).
  static constexpr std::uint64_t kAny = ~std::uint64_t{0};
  template <class T>
  std::vector<T> get(const std::string& name, std::uint64_t count = kAny) const;
  template <class T>
  T get_value(const std::string& name) const {
    return get<T>(name, 1).front();
  }
  std::string get_text(const std::string& name) const;
  const Array& array(const std::string& name) const;

 private:
  std::map<std::string, Array> arrays_;  // by name: files of equal scenes are equal
};

}  // namespace komorebi
