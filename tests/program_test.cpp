// The program as its users call it: exit codes, messages, files, and a kill in the middle.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Outcome {
  int code;
  std::string text;  ///< standard output and error
};

Outcome call(const std::string& arguments) {
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

class Program : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("driftless-program-" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  std::string good_study(double measure = 4) const {
    return write("good.json", R"({"format": "driftless-study/1", "name": "good",
      "scene": {"preset": "mackie-1999", "particles": 60},
      "methods": ["averaged-drift", "shardlow-s1"], "time_steps": [0.01, 0.02],
      "duration": {"equilibrate": 1, "measure": )" +
                                  std::to_string(measure) + R"(, "sample_every": 0.1},
      "replicas": 2, "seed": 3})");
  }

  fs::path folder_;
};

TEST_F(Program, HelpAndVersionOfEverything) {
  for (const auto* arguments :
       {"--help", "--version", "run --help", "check --help", "report --help", "methods --help",
        "scenes --help", "observables --help", "schema --help"}) {
    const auto outcome = call(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_FALSE(outcome.text.empty()) << arguments;
  }
}

TEST_F(Program, ListsMethodsScenesObservablesAndSchemas) {
  const auto methods = call("methods").text;
  for (const auto* name :
       {"averaged-drift", "avalos-mackie-implicit", "avalos-mackie-midpoint", "espanol",
        "marsh-coveney", "shardlow-s1", "shardlow-s2", "isoenergetic-verlet"}) {
    EXPECT_NE(methods.find(std::string(name) + "\n"), std::string::npos) << name;
  }
  const auto scenes = call("scenes").text;
  for (const auto* name : {"mackie-1999", "soft-fluid", "two-body"}) {
    EXPECT_NE(scenes.find(name), std::string::npos) << name;
  }
  EXPECT_NE(call("observables").text.find("internal_energy_variance"), std::string::npos);
  for (const auto* kind : {"study", "result"}) {
    EXPECT_TRUE(json::parse(call(std::string("schema ") + kind).text).contains("$schema")) << kind;
  }
}

TEST_F(Program, WrongUseEndsWithTwo) {
  for (const auto* arguments : {"", "nonsense", "run", "schema", "schema nonsense", "run a b c",
                                "run study.json --threads 0"}) {
    EXPECT_EQ(call(arguments).code, 2) << arguments;
  }
}

TEST_F(Program, ABadStudyEndsWithTwoInOneSentenceAndWritesNothing) {
  std::ifstream good(good_study());
  std::string text{std::istreambuf_iterator<char>(good), {}};
  text.replace(text.find("\"particles\""), 11, "\"particels\"");
  const auto study = write("bad.json", text);
  const auto output = folder_ / "output";
  for (const auto& verb : {std::string("check "), "run -o " + output.string() + " "}) {
    const auto outcome = call(verb + study);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find("bad.json"), std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find("particels"), std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find("particles"), std::string::npos) << outcome.text;
  }
  EXPECT_FALSE(fs::exists(output));
}

TEST_F(Program, AMissingStudyOrResultEndsWithTwo) {
  for (const std::string verb : {"check ", "run ", "report "}) {
    const auto outcome = call(verb + (folder_ / "missing.json").string());
    EXPECT_EQ(outcome.code, 2) << verb;
    EXPECT_NE(outcome.text.find("missing.json"), std::string::npos) << outcome.text;
  }
  EXPECT_EQ(call("report " + good_study()).code, 2) << "a study is no result";
}

TEST_F(Program, AnUnwritableOutputEndsWithTwo) {
  const auto file = write("file", "in the way");
  const auto outcome = call("run -q " + good_study() + " -o " + file + "/below");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.text.find("file/below"), std::string::npos) << outcome.text;
}

TEST_F(Program, RunWritesResultSummaryAndPage) {
  const auto output = (folder_ / "output").string();
  const auto outcome = call("run " + good_study() + " -o " + output);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("[4/4"), std::string::npos) << "plain lines off a terminal";
  EXPECT_EQ(outcome.text.find('\r'), std::string::npos);
  for (const auto* name : {"result.json", "summary.md", "index.html"}) {
    EXPECT_GT(fs::file_size(fs::path(output) / name), 100U) << name;
  }
  const auto again = call("report " + output);
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.text.find("averaged-drift"), std::string::npos);
}

TEST_F(Program, AKilledRunLosesNothingThatWasFinished) {
  const auto study = good_study(40);
  const auto whole = folder_ / "whole", killed = folder_ / "killed";
  ASSERT_EQ(call("run -q " + study + " -o " + whole.string()).code, 0);

  const pid_t child = fork();
  if (child == 0) {
    execl(DRIFTLESS_PROGRAM, DRIFTLESS_PROGRAM, "run", "-q", "-t", "1", study.c_str(), "-o",
          killed.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  const auto finished = [&] {
    std::size_t count = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(killed / "cells", error)) {
      count += entry.path().extension() == ".json" ? 1U : 0U;
    }
    return count;
  };
  while (finished() < 1 && waitpid(child, nullptr, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const auto kept = finished();
  ASSERT_GE(kept, 1U);
  EXPECT_FALSE(fs::exists(killed / "result.json"));

  const auto resumed = call("run " + study + " -o " + killed.string());
  ASSERT_EQ(resumed.code, 0) << resumed.text;
  EXPECT_NE(resumed.text.find(std::to_string(kept) + " of 4 cells are finished already"),
            std::string::npos)
      << resumed.text;
  const auto cells = [](const fs::path& folder) {
    std::ifstream file(folder / "result.json");
    auto result = json::parse(file);
    for (auto& cell : result["cells"]) cell.erase("cost");
    return result["cells"].dump();
  };
  EXPECT_EQ(cells(killed), cells(whole));
}

}  // namespace
