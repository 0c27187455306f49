#pragma once

#include <sstream>

#include "support/mesh_file.h"

namespace komorebi::testing {

/// Reads PLY, ascii or little-endian, with scalar vertex properties and one list of corners a face.
class PlyReader {
 public:
  explicit PlyReader(const std::string& bytes) : bytes_(bytes), words_(nullptr) {
    const std::size_t body = read_header();
    words_ = Words(bytes.c_str() + body);
    at_ = body;
  }

  TriangleMesh read() {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < vertex_count_; ++i) {
      for (std::size_t k = 0; k < vertex_types_.size(); ++k) {
        const double value = next(vertex_types_[k]);
        if (k < 3) mesh.vtx2xyz.push_back(static_cast<float>(value));
      }
    }
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < face_count_; ++i) {
      corners.resize(static_cast<std::size_t>(next(count_type_)));
      for (std::int64_t& corner : corners) corner = static_cast<std::int64_t>(next(corner_type_));
      mesh.add_polygon(corners);
    }
    mesh.drop_not_finite();
    return mesh;
  }

 private:
  std::size_t read_header() {
    const std::size_t end = bytes_.find("end_header");
    if (end == std::string::npos) throw std::runtime_error("not a PLY file");
    std::istringstream header(bytes_.substr(0, end));
    std::string line, element;
    while (std::getline(header, line)) {
      std::istringstream words(line);
      std::string word, type;
      words >> word;
      if (word == "format") {
        words >> type;
        ascii_ = type == "ascii";
        if (!ascii_ && type != "binary_little_endian") throw std::runtime_error("PLY: " + type);
      } else if (word == "element") {
        std::size_t count = 0;
        words >> element >> count;
        if (element == "vertex") vertex_count_ = count;
        if (element == "face") face_count_ = count;
      } else if (word == "property") {
        words >> type;
        if (type == "list") words >> count_type_ >> corner_type_;
        if (type != "list" && element == "vertex") vertex_types_.push_back(type);
        if (type != "list" && element == "face") throw std::runtime_error("PLY: face property");
      }
    }
    return bytes_.find('\n', end) + 1;
  }

  double next(const std::string& type) {
    if (ascii_) return words_.number();
    if (type == "float" || type == "float32") return binary<float>();
    if (type == "double" || type == "float64") return binary<double>();
    if (type == "int" || type == "int32") return binary<std::int32_t>();
    if (type == "uint" || type == "uint32") return binary<std::uint32_t>();
    if (type == "short" || type == "int16") return binary<std::int16_t>();
    if (type == "ushort" || type == "uint16") return binary<std::uint16_t>();
    if (type == "char" || type == "int8") return binary<std::int8_t>();
    if (type == "uchar" || type == "uint8") return binary<std::uint8_t>();
    throw std::runtime_error("PLY: property type " + type);
  }

  template <class T>
  double binary() {
    if (at_ + sizeof(T) > bytes_.size()) throw std::runtime_error("PLY: the file ends early");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(value);
  }

  const std::string& bytes_;
  Words words_;
  std::size_t at_ = 0;
  bool ascii_ = true;
  std::size_t vertex_count_ = 0, face_count_ = 0;
  std::vector<std::string> vertex_types_;
  std::string count_type_, corner_type_;
};

}  // namespace komorebi::testing
