#pragma once

#include "support/ply_file.h"

namespace komorebi::testing {

/// Reads the v and f lines of an OBJ; lines may be continued with a backslash.
inline TriangleMesh read_obj(std::string bytes) {
  for (std::size_t at = bytes.find('\\'); at != std::string::npos; at = bytes.find('\\', at)) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size() - 1);
    std::fill(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(end) + 1, ' ');
  }
  TriangleMesh mesh;
  std::vector<std::vector<std::int64_t>> faces;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string line = bytes.substr(at, end - at);
    at = end + 1;
    if (line.rfind("v ", 0) == 0) {
      Words words(line.c_str() + 2);
      for (int k = 0; k < 3; ++k) mesh.vtx2xyz.push_back(static_cast<float>(words.number()));
    } else if (line.rfind("f ", 0) == 0) {
      std::vector<std::int64_t>& corners = faces.emplace_back();
      for (const char* c = line.c_str() + 1; *c != '\0';) {
        while (std::isspace(static_cast<unsigned char>(*c))) ++c;
        if (*c == '\0') break;
        const std::int64_t index = std::strtoll(c, nullptr, 10);
        corners.push_back(index > 0 ? index - 1
                                    : static_cast<std::int64_t>(mesh.vtx2xyz.size() / 3) + index);
        while (*c != '\0' && !std::isspace(static_cast<unsigned char>(*c))) ++c;
      }
    }
  }
  for (const auto& corners : faces) mesh.add_polygon(corners);
  mesh.drop_not_finite();
  return mesh;
}

/// Reads an STL, binary or text; every triangle has corners of its own.
inline TriangleMesh read_stl(const std::string& bytes) {
  TriangleMesh mesh;
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, bytes.data() + 80, 4);
  if (bytes.size() == 84 + 50 * std::size_t{count}) {
    mesh.vtx2xyz.resize(9 * std::size_t{count});
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&mesh.vtx2xyz[9 * i], bytes.data() + 84 + 50 * i + 12, 36);
    }
  } else {
    for (std::size_t at = bytes.find("vertex"); at != std::string::npos;
         at = bytes.find("vertex", at + 6)) {
      Words words(bytes.c_str() + at + 6);
      for (int k = 0; k < 3; ++k) mesh.vtx2xyz.push_back(static_cast<float>(words.number()));
    }
  }
  mesh.tri2vtx.resize(mesh.vtx2xyz.size() / 3);
  for (std::size_t i = 0; i < mesh.tri2vtx.size(); ++i) {
    mesh.tri2vtx[i] = static_cast<std::uint32_t>(i);
  }
  mesh.drop_not_finite();
  return mesh;
}

/// Whether read_mesh knows the format (GLB it does not).
inline bool can_read_mesh(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* ending : {".ply", ".ply.gz", ".obj", ".obj.gz", ".stl"}) {
    if (name.size() > std::strlen(ending) &&
        name.compare(name.size() - std::strlen(ending), std::string::npos, ending) == 0) {
      return true;
    }
  }
  return false;
}

/// @throws std::runtime_error naming the file if it cannot be read
inline TriangleMesh read_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  const std::filesystem::path plain = path.extension() == ".gz" ? path.stem() : path.filename();
  try {
    const std::string ending = plain.extension().string();
    if (ending == ".ply") return PlyReader(bytes).read();
    if (ending == ".obj") return read_obj(bytes);
    if (ending == ".stl" || ending == ".STL") return read_stl(bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
  throw std::runtime_error(path.string() + ": unknown mesh format");
}

}  // namespace komorebi::testing
