#include "bvh/topology.h"

#include <stdexcept>

namespace komorebi {

namespace {

struct Name {
  Builder builder;
  const char* name;
};
constexpr Name kNames[] = {{Builder::kLinear, "LINEAR"},
                           {Builder::kSah, "SAH"},
                           {Builder::kPrincipalAxis, "PRINCIPAL_AXIS"},
                           {Builder::kList, "LIST"}};

}  // namespace

Builder builder_from_name(const std::string& name) {
  for (const Name& known : kNames) {
    if (name == known.name) return known.builder;
  }
  throw std::invalid_argument("there is no tree builder \"" + name +
                              "\" (LINEAR, SAH, PRINCIPAL_AXIS or LIST)");
}

const char* builder_name(Builder builder) {
  for (const Name& known : kNames) {
    if (builder == known.builder) return known.name;
  }
  return "";
}

Topology build_topology(std::span<const Aabb> boxes, Builder builder, const Cancel& cancel) {
  if (boxes.size() > kMaxItems) {
    throw std::invalid_argument("a tree holds at most " + std::to_string(kMaxItems) +
                                " items, not " + std::to_string(boxes.size()));
  }
  Topology topology;
  if (builder == Builder::kPrincipalAxis) {
    topology = build_principal_axis(boxes, cancel);
  } else if (builder == Builder::kList) {
    topology = build_list(boxes);
  } else {
    throw std::invalid_argument(std::string(builder_name(builder)) + " is not built by this");
  }
  check(cancel);
  if (topology.depth > kMaxDepth) {
    throw std::runtime_error("a tree of depth " + std::to_string(topology.depth) +
                             " is deeper than traversal allows");
  }
  return topology;
}

}  // namespace komorebi
