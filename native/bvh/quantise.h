#pragma once

#include "bvh/wide_node.h"

namespace komorebi {

/// Lays the node's grid around `boxes` (1…8, none empty) and stores for each the smallest box on
/// the grid that contains it, as the traversal will decode it.
void quantise(const Aabb* boxes, int count, WideNode& node);

}  // namespace komorebi
