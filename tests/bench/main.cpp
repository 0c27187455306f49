// komorebi_bench PART [--name value]…: prints JSON rows; `./run bench` runs it and makes tables.
#include <cstdio>
#include <exception>

#include "bench/parts.h"
#include "bvh/traverse.h"

int main(int count, char** words) {
  using namespace komorebi::bench;
  const std::map<std::string, void (*)(const Options&)> parts = {
      {"build", build_part}, {"rays", rays_part}, {"scale", scale_part}, {"curves", curves_part}};
  try {
    const std::string part = count > 1 ? words[1] : "";
    if (part == "instructions") {
      std::printf("%s\n", komorebi::active_instruction_set());
      return 0;
    }
    if (!parts.contains(part)) throw std::invalid_argument("the first word names a part");
    parts.at(part)(Options(count - 2, words + 2));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "komorebi_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
