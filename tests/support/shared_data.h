#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace komorebi::testing {

/// Where the real meshes, maps and scenes lie: $KOMOREBI_SHARED, or `shared` beside the project.
inline std::filesystem::path shared_folder() {
  if (const char* folder = std::getenv("KOMOREBI_SHARED")) return folder;
  const std::filesystem::path source = __FILE__;  // <project>/tests/support/shared_data.h
  return source.parent_path().parent_path().parent_path().parent_path() / "shared";
}

}  // namespace komorebi::testing

/// Declares `variable`, the path of a shared file; skips the test by name when it is not there.
#define KOMOREBI_SHARED_FILE(variable, relative)                                           \
  const std::string variable = (komorebi::testing::shared_folder() / (relative)).string(); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "not there: " << variable
