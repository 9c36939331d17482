// Methods from outside, in modules that the program and the tests load at run time.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace {

struct Outcome {
  int code;
  std::string text;  ///< standard output and error
};

Outcome call(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  while (const auto read = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, read);
  return {WEXITSTATUS(pclose(pipe)), text};
}

const std::string program = DRIFTLESS_PROGRAM;
const std::string sound = MODULES "/sound.so";

std::string environment(const std::string& modules) { return "DRIFTLESS_METHODS=" + modules + " "; }

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Modules, AreLoadedByOptionAndByEnvironment) {
  for (const auto& command :
       {program + " --methods " + sound + " methods", program + " methods --methods " + sound,
        environment(sound) + program + " methods",
        // The same one twice is the same as once; names may be empty.
        environment(":" + sound + "::" + sound) + program + " --methods " + sound + " methods"}) {
    SCOPED_TRACE(command);
    const auto outcome = call(command);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(count(outcome.text, "outside-first\n"), 1) << outcome.text;
    EXPECT_EQ(count(outcome.text, "outside-second\n"), 1) << outcome.text;
    EXPECT_LT(outcome.text.find("isoenergetic-verlet\n"), outcome.text.find("outside-first\n"));
  }
  EXPECT_FALSE(contains(call(program + " methods").text, "outside"));
}

TEST(Modules, NamesWithoutAFolderAreFilesHere) {
  const auto outcome = call("cd '" MODULES "' && " + program + " --methods sound.so methods");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

TEST(Modules, AreInTheSuites) {
  const auto listed = call(environment(sound) + INVARIANTS + " --gtest_list_tests").text;
  EXPECT_TRUE(contains(listed, "AreAsClaimed/outside_first")) << listed;
  EXPECT_FALSE(contains(call(INVARIANTS " --gtest_list_tests").text, "outside"));
}

/// Each faulty module, and what the one sentence about it must name.
struct Faulty {
  std::string module, complaint;
};

const std::vector<Faulty> faulty = {
    {MODULES "/missing.so", "missing.so cannot be loaded: cannot open"},
    {__FILE__, "modules_test.cpp cannot be loaded: invalid ELF header"},
    {MODULES "/nothing.so", "nothing.so registers no method"},
    {MODULES "/taken_name.so", "taken_name.so is refused: a method named averaged-drift exists"},
    {MODULES "/twice.so", "twice.so is refused: a method named outside-twice exists"},
};

TEST(Modules, ThatAreFaultyEndProgramAndTestsWithTwoInOneSentence) {
  for (const auto& [module, complaint] : faulty) {
    for (const auto& command :
         {program + " --methods " + module + " methods", environment(module) + program + " methods",
          environment(sound + ":" + module) + program + " methods",
          environment(module) + INVARIANTS + " --gtest_list_tests"}) {
      SCOPED_TRACE(command);
      const auto outcome = call(command);
      EXPECT_EQ(outcome.code, 2);
      EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
      EXPECT_TRUE(contains(outcome.text, complaint)) << outcome.text;
    }
  }
}

TEST(Modules, NeedNotBeSoundForThoseWhoWantNone) {
  EXPECT_EQ(call(environment(MODULES "/missing.so") + program + " --version").code, 0);
}

}  // namespace
