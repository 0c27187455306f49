#pragma once

#include "bench/options.h"

/// The parts that are measured in C++. Each prints one JSON row a line.
namespace komorebi::bench {

void build_part(const Options& options);
void rays_part(const Options& options);
void scale_part(const Options& options);
void curves_part(const Options& options);

}  // namespace komorebi::bench
