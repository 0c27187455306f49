#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "bvh/kernel.h"
#include "bvh/traverse.h"

namespace komorebi {
namespace {

TEST(InstructionSets, CanBeForcedAndGivenBack) {
  const std::vector<std::string> names = built_instruction_sets();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.back(), "SCALAR");
  const std::string before = active_instruction_set();
  EXPECT_NE(std::find(names.begin(), names.end(), before), names.end());
  for (const std::string& name : names) {
    force_instruction_set(name);
    EXPECT_EQ(active_instruction_set(), name);
  }
  force_instruction_set("");
  EXPECT_EQ(active_instruction_set(), before);
}

TEST(InstructionSets, AnUnknownOneIsRefusedByName) {
  const std::string before = active_instruction_set();
  try {
    force_instruction_set("MMX");
    FAIL() << "MMX was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("MMX"), std::string::npos);
  }
  EXPECT_EQ(active_instruction_set(), before);
}

TEST(InstructionSets, TheEnvironmentsIsCheckedByName) {
  ASSERT_EQ(setenv("KOMOREBI_ISA", "MMX", 1), 0);
  try {
    check_instruction_set();
    ADD_FAILURE() << "MMX was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("KOMOREBI_ISA"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("\"MMX\""), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("SCALAR"), std::string::npos);
  }
  for (const std::string& name : built_instruction_sets()) {
    setenv("KOMOREBI_ISA", name.c_str(), 1);
    EXPECT_NO_THROW(check_instruction_set()) << name;
  }
  setenv("KOMOREBI_ISA", "", 1);
  EXPECT_NO_THROW(check_instruction_set());
  unsetenv("KOMOREBI_ISA");
  EXPECT_NO_THROW(check_instruction_set());
}

TEST(InstructionSets, ThisMachineRunsMoreThanTheBaseline) {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "a machine without AVX2";
  const std::vector<std::string> names = built_instruction_sets();
  EXPECT_NE(std::find(names.begin(), names.end(), "AVX2"), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "SSE4"), names.end());
  EXPECT_FALSE(machine_has("NEON"));
#else
  GTEST_SKIP() << "not an x86-64 machine";
#endif
}

}  // namespace
}  // namespace komorebi
