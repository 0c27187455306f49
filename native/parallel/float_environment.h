#pragma once

#include <cfenv>

namespace komorebi {

/// Puts this thread into the default floating-point environment (round to nearest, denormals kept,
/// no traps) for as long as it lives. Hosts change it (Blender's own threads flush denormals to
/// zero), and new threads inherit it; a picture must not depend on that.
class DefaultFloatEnvironment {
 public:
  DefaultFloatEnvironment() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatEnvironment() { std::fesetenv(&saved_); }
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

 private:
  std::fenv_t saved_;
};

}  // namespace komorebi
