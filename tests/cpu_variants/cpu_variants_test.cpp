// The builds of the library differ by rounding alone, and the loader chooses the best of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// A build of the library: Highway's name of its instructions, and its file.
struct Variant {
  std::string instructions, library;
};

/// Those that this processor can run, the best one last.
std::vector<Variant> variants() {
  const std::string folder = LIBRARY_FOLDER;
  const std::string file = "/libdriftless.so";
  std::vector<Variant> all = {{"SSE4", folder + file}};
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (v3) all.push_back({"AVX2", folder + "/glibc-hwcaps/x86-64-v3" + file});
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  if (v3 && v4) all.push_back({"AVX3", folder + "/glibc-hwcaps/x86-64-v4" + file});
  return all;
}

struct Outcome {
  std::string instructions;
  std::vector<double> values;  ///< 7 a particle
};

/// What final_state prints, with the library of a file; of the loader's choice if it is empty.
Outcome outcome(const std::string& library, const std::string& arguments) {
  const std::string forced = library.empty() ? "" : "LD_PRELOAD='" + library + "' ";
  FILE* pipe = popen((forced + "'" FINAL_STATE "' " + arguments + " 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  while (const auto read = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, read);
  EXPECT_EQ(pclose(pipe), 0) << text;
  std::istringstream lines(text);
  Outcome outcome;
  std::getline(lines, outcome.instructions);
  for (double value = 0; lines >> value;) outcome.values.push_back(value);
  return outcome;
}

double largest_difference(const Outcome& a, const Outcome& b) {
  if (a.values.size() != b.values.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t n = 0; n < a.values.size(); ++n) {
    largest = std::max(largest, std::abs(a.values[n] - b.values[n]));
  }
  return largest;
}

constexpr double tolerance = 1e-9;

TEST(CpuVariants, TheLoaderChoosesTheBestThatTheProcessorHas) {
  EXPECT_EQ(outcome("", "averaged-drift").instructions, variants().back().instructions);
}

TEST(CpuVariants, AgreeToRounding) {
  for (const std::string method : {"averaged-drift", "shardlow-s1"}) {
    const Outcome expected = outcome("", method);
    ASSERT_EQ(expected.values.size(), 500U * 7U);
    for (const auto& variant : variants()) {
      SCOPED_TRACE(method + " with " + variant.library);
      const Outcome found = outcome(variant.library, method);
      EXPECT_EQ(found.instructions, variant.instructions);
      EXPECT_LT(largest_difference(found, expected), tolerance);
    }
  }
}

TEST(CpuVariants, AreComparedSharply) {
  const Outcome expected = outcome("", "averaged-drift");
  EXPECT_GT(largest_difference(outcome("", "averaged-drift 2"), expected), 1e-3) << "another seed";
  EXPECT_GT(largest_difference(outcome("", "shardlow-s1"), expected), 1e-6) << "another method";
  const auto all = variants();
  if (all.size() == 1) return;
  const auto worst = outcome(all.front().library, "averaged-drift");
  EXPECT_NE(worst.instructions, expected.instructions);
}

}  // namespace
