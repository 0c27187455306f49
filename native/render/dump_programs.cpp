#include "render/dump_programs.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace komorebi {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error("the scene's " + what);
}

/// Operands as they stand in a file: operation and output, and the number where there is neither.
struct Operands {
  std::vector<std::uint32_t> of;
  std::vector<float> constant;

  void add(const std::vector<Operand>& operands) {
    for (const Operand& operand : operands) {
      of.insert(of.end(), {operand.op, operand.output});
      constant.push_back(operand.constant);
    }
  }
  std::vector<Operand> take(std::size_t& from, std::size_t count) const {
    if (from + count > constant.size()) refuse("programs have too few operands");
    std::vector<Operand> operands;
    for (; count > 0; --count, ++from) {
      operands.push_back({of[2 * from], of[2 * from + 1], constant[from]});
    }
    return operands;
  }
  void put(ArrayFile& file, const std::string& key) const {
    file.put<std::uint32_t>(key, of, {constant.size(), 2});
    file.put<float>(key + "_constant", constant, {constant.size()});
  }
  static Operands get(const ArrayFile& file, const std::string& key) {
    Operands operands;
    operands.constant = file.get<float>(key + "_constant");
    operands.of = file.get<std::uint32_t>(key, 2 * operands.constant.size());
    return operands;
  }
};

std::vector<float> part(const std::vector<float>& all, std::size_t& from, std::size_t count) {
  if (from + count > all.size()) refuse("programs have too few numbers");
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(from);
  from += count;
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

/// Texts one after the other, each with a zero behind it.
void put_texts(ArrayFile& file, const std::string& key, const std::vector<std::string>& texts) {
  std::vector<std::uint8_t> bytes;
  for (const std::string& text : texts) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
  }
  file.put<std::uint8_t>(key, bytes, {bytes.size()});
}

std::vector<std::string> get_texts(const ArrayFile& file, const std::string& key,
                                   std::size_t count) {
  const auto bytes = file.get<std::uint8_t>(key);
  std::vector<std::string> texts(1);
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) {
      texts.emplace_back();
    } else {
      texts.back().push_back(static_cast<char>(byte));
    }
  }
  texts.pop_back();
  if (texts.size() != count) refuse("programs have not a name an operation");
  return texts;
}

std::string key_of(const char* kind, std::size_t index) {
  return std::string(kind) + "/" + std::to_string(index) + "/";
}

}  // namespace

std::uint32_t ProgramWriter::add(const Program* program) {
  if (program == nullptr) return 0;
  const auto [known, is_new] = programs_.try_emplace(program, programs_.size() + 1);
  if (!is_new) return known->second;
  const std::string key = key_of("program", known->second - 1);
  const WrittenProgram written = program->written();
  Operands operands, outputs;
  std::vector<std::uint32_t> sizes;  // operands, numbers, table, 1 + texture
  std::vector<float> numbers, tables;
  std::vector<std::string> ops, names;
  for (const OpInput& op : written.ops) {
    ops.push_back(op.op);
    names.push_back(op.name);
    operands.add(op.operands);
    numbers.insert(numbers.end(), op.numbers.begin(), op.numbers.end());
    tables.insert(tables.end(), op.table.begin(), op.table.end());
    sizes.insert(sizes.end(), {static_cast<std::uint32_t>(op.operands.size()),
                               static_cast<std::uint32_t>(op.numbers.size()),
                               static_cast<std::uint32_t>(op.table.size()), add(op.texture.get())});
  }
  outputs.add(written.outputs);
  file_.put_text(key + "name", program->name());
  put_texts(file_, key + "ops", ops);
  put_texts(file_, key + "names", names);
  file_.put<std::uint32_t>(key + "sizes", sizes, {written.ops.size(), 4});
  file_.put<float>(key + "numbers", numbers, {numbers.size()});
  file_.put<float>(key + "tables", tables, {tables.size()});
  operands.put(file_, key + "operands");
  outputs.put(file_, key + "outputs");
  return known->second;
}

std::uint32_t ProgramWriter::add(const Texture* texture) {
  if (texture == nullptr) return 0;
  const auto known = textures_.find(texture);
  if (known != textures_.end()) return known->second;
  std::vector<std::uint32_t> tiles;  // number, 1 + texture
  for (const auto& [number, tile] : texture->tiles()) {
    tiles.insert(tiles.end(), {number, add(tile.get())});
  }
  const auto index = static_cast<std::uint32_t>(textures_.size() + 1);
  textures_.emplace(texture, index);
  const std::string key = key_of("texture", index - 1);
  file_.put_text(key + "name", texture->name());
  if (!tiles.empty()) {
    file_.put<std::uint32_t>(key + "tiles", tiles, {tiles.size() / 2, 2});
    return index;
  }
  const auto texels = texture->finest_texels();
  const std::uint32_t header[] = {texture->width(),
                                  texture->height(),
                                  texture->channels(),
                                  static_cast<std::uint32_t>(texture->type()),
                                  texture->is_srgb() ? 1u : 0u,
                                  texture->is_data() ? 1u : 0u};
  file_.put<std::uint32_t>(key + "header", header, {std::size(header)});
  file_.put<std::uint8_t>(key + "texels",
                          {reinterpret_cast<const std::uint8_t*>(texels.data()), texels.size()},
                          {texels.size()});
  return index;
}

ProgramReader::ProgramReader(const ArrayFile& file, ThreadPool& pool) : file_(file), pool_(pool) {}

std::shared_ptr<const Program> ProgramReader::program(std::uint32_t index) {
  if (index == 0) return nullptr;
  std::shared_ptr<const Program>& known = programs_[index];
  if (known) return known;
  const std::string key = key_of("program", index - 1);
  const auto sizes = file_.get<std::uint32_t>(key + "sizes");
  const std::size_t count = sizes.size() / 4;
  const auto ops = get_texts(file_, key + "ops", count);
  const auto names = get_texts(file_, key + "names", count);
  const auto numbers = file_.get<float>(key + "numbers"), tables = file_.get<float>(key + "tables");
  const Operands operands = Operands::get(file_, key + "operands");
  const Operands outputs = Operands::get(file_, key + "outputs");
  std::vector<OpInput> made;
  std::size_t operand = 0, number = 0, table = 0, output = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t* const size = &sizes[4 * i];
    OpInput op;
    op.op = ops[i];
    op.name = names[i];
    op.operands = operands.take(operand, size[0]);
    op.numbers = part(numbers, number, size[1]);
    op.table = part(tables, table, size[2]);
    op.texture = texture(size[3]);
    made.push_back(std::move(op));
  }
  known = std::make_shared<const Program>(file_.get_text(key + "name"), std::move(made),
                                          outputs.take(output, outputs.constant.size()));
  return known;
}

std::shared_ptr<const Texture> ProgramReader::texture(std::uint32_t index) {
  if (index == 0) return nullptr;
  std::shared_ptr<const Texture>& known = textures_[index];
  if (known) return known;
  const std::string key = key_of("texture", index - 1);
  const std::string name = file_.get_text(key + "name");
  if (file_.has(key + "tiles")) {
    const auto pairs = file_.get<std::uint32_t>(key + "tiles");
    std::vector<Texture::Tile> tiles;
    for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
      // Tiles come before what they are tiles of, so that this ends.
      if (pairs[i + 1] >= index) refuse("texture \"" + name + "\" is a tile of itself");
      tiles.emplace_back(pairs[i], texture(pairs[i + 1]));
    }
    return known = std::make_shared<const Texture>(name, std::move(tiles));
  }
  const auto header = file_.get<std::uint32_t>(key + "header", 6);
  const auto bytes = file_.get<std::uint8_t>(key + "texels");
  Texels texels;
  texels.width = header[0];
  texels.height = header[1];
  texels.channels = header[2];
  texels.type = static_cast<TexelType>(header[3]);
  if (header[3] > 3 || header[2] > 4 || texels.byte_count() != bytes.size()) {
    refuse("texture \"" + name + "\" has not as many texels as it should");
  }
  texels.data.reset(new std::byte[bytes.size()]);
  std::memcpy(texels.data.get(), bytes.data(), bytes.size());
  TextureColor color;
  color.srgb = header[4] != 0;
  color.data = header[5] != 0;
  return known = std::make_shared<const Texture>(name, std::move(texels), color, pool_);
}

}  // namespace komorebi
