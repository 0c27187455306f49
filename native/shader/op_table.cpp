#include "shader/op_table.h"

#include <string>
#include <unordered_map>

namespace komorebi {

const OpInfo* find_op(std::string_view name) {
  static const auto kTable = [] {
    std::unordered_map<std::string_view, const OpInfo*> table;
    for (const auto& family :
         {arithmetic_ops(), math_ops(), vector_ops(), color_ops(), table_ops(), spectrum_ops(),
          surface_ops(), noise_ops(), voronoi_ops(), pattern_ops(), sky_ops(), texture_ops()}) {
      for (const OpInfo& op : family) table.emplace(op.name, &op);
    }
    return table;
  }();
  const auto found = kTable.find(name);
  return found == kTable.end() ? nullptr : found->second;
}

}  // namespace komorebi
