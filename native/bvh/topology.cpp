#include "bvh/topology.h"

#include <stdexcept>

namespace komorebi {

Builder builder_from_name(const std::string& name) {
  if (name == "LINEAR") return Builder::kLinear;
  if (name == "PRINCIPAL_AXIS") return Builder::kPrincipalAxis;
  if (name == "LIST") return Builder::kList;
  throw std::invalid_argument("there is no tree builder \"" + name +
                              "\" (LINEAR, PRINCIPAL_AXIS or LIST)");
}

Topology build_topology(std::span<const Aabb> boxes, Builder builder, ThreadPool& pool,
                        const Cancel& cancel) {
  if (boxes.size() > kMaxItems) {
    throw std::invalid_argument("a tree holds at most " + std::to_string(kMaxItems) +
                                " items, not " + std::to_string(boxes.size()));
  }
  Topology topology;
  switch (builder) {
    case Builder::kLinear:
      topology = build_linear(boxes, pool, cancel);
      break;
    case Builder::kPrincipalAxis:
      topology = build_principal_axis(boxes, cancel);
      break;
    case Builder::kList:
      topology = build_list(boxes);
      break;
  }
  check(cancel);
  if (topology.depth > kMaxDepth) {
    throw std::runtime_error("a tree of depth " + std::to_string(topology.depth) +
                             " is deeper than traversal allows");
  }
  return topology;
}

}  // namespace komorebi
