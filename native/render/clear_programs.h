#pragma once

#include <memory>

#include "core/path_key.h"
#include "render/material.h"

namespace komorebi {

/// A material's transparency (3 outputs) to each kind of ray: of its programs what that needs.
struct ClearPrograms {
  std::shared_ptr<const Program> of_kind[3];  ///< PathKind; null: opaque to all

  ClearPrograms() = default;
  explicit ClearPrograms(const Material& material);

  bool exist() const { return of_kind[0] != nullptr; }
  const Program& of(PathKind kind) const { return *of_kind[static_cast<std::size_t>(kind)]; }
};

}  // namespace komorebi
