#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace driftless {

struct Outcome {
  int code;
  std::string text;  ///< standard output and error
};

/// Calls the program as a user's shell would.
inline Outcome call_program(const std::string& arguments) {
  const std::string command = std::string(DRIFTLESS_PROGRAM) + " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  Outcome outcome{-1, ""};
  std::array<char, 4096> buffer;
  while (const auto read = fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.text.append(buffer.data(), read);
  }
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

/// An empty folder for every test.
class InFolder : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("driftless-") + test->test_suite_name() + "-" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

}  // namespace driftless
