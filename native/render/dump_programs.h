#pragma once

#include <map>
#include <memory>

#include "io/array_file.h"
#include "parallel/thread_pool.h"
#include "shader/program.h"
#include "texture/texture.h"

namespace komorebi {

/// Writes programs and their textures into a dump, each once:
///
///     program/N/name, ops, names, sizes, numbers, tables, operands, outputs  (OpInput)
///     texture/N/name, header, texels  or  name, tiles
///
/// Textures are kept as they are in memory, without their coarser levels.
class ProgramWriter {
 public:
  explicit ProgramWriter(ArrayFile& file) : file_(file) {}
  /// 1 + N; 0: there is none.
  std::uint32_t add(const Program* program);

 private:
  std::uint32_t add(const Texture* texture);

  ArrayFile& file_;
  std::map<const Program*, std::uint32_t> programs_;
  std::map<const Texture*, std::uint32_t> textures_;
};

/// The way back. Throws std::runtime_error and std::invalid_argument naming what is wrong.
class ProgramReader {
 public:
  ProgramReader(const ArrayFile& file, ThreadPool& pool);
  /// By what ProgramWriter::add gave; null for 0.
  std::shared_ptr<const Program> program(std::uint32_t index);

 private:
  std::shared_ptr<const Texture> texture(std::uint32_t index);

  const ArrayFile& file_;
  ThreadPool& pool_;
  std::map<std::uint32_t, std::shared_ptr<const Program>> programs_;
  std::map<std::uint32_t, std::shared_ptr<const Texture>> textures_;
};

}  // namespace komorebi
