// The command `simulate` as its users call it: files, messages, exit codes, and kills.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "tests/program_call.hpp"

namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using driftless::Outcome;

Outcome call(const std::string& arguments) {
  return driftless::call_program("simulate " + arguments);
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Simulate : public driftless::InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    scene_ = (folder_ / "scene.json").string();
    std::ofstream(scene_) << R"({"preset": "mackie-1999", "particles": 200})";
  }
  std::string usual(const std::string& more) const {
    return scene_ + " --method groot-warren:lambda=0.65 -q -t 1 --seed 4 " + more;
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }

  /// Starts the program, waits until it has written a checkpoint and sends it a signal; its exit
  /// status.
  int kill_after_a_checkpoint(const std::string& arguments, const fs::path& output, int signal,
                              const std::string& errors) const {
    const fs::path checkpoint = output / "checkpoint.cbor";
    std::error_code error;
    const auto before = fs::last_write_time(checkpoint, error);
    const pid_t child = fork();
    if (child == 0) {
      ::signal(SIGINT, SIG_DFL);  // whoever runs the tests may ignore it
      if (std::freopen(errors.c_str(), "w", stderr) == nullptr) _exit(126);
      std::istringstream words("simulate " + arguments);
      std::vector<std::string> given = {DRIFTLESS_PROGRAM};
      for (std::string word; words >> word;) given.push_back(word);
      std::vector<char*> pointers;
      for (auto& word : given) pointers.push_back(word.data());
      pointers.push_back(nullptr);
      execv(DRIFTLESS_PROGRAM, pointers.data());
      _exit(127);
    }
    while (fs::last_write_time(checkpoint, error) == before &&
           waitpid(child, nullptr, WNOHANG) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    kill(child, signal);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return status;
  }

  std::string scene_;
};

TEST_F(Simulate, WritesEverythingByDefault) {
  const auto done = call(usual("--time-step 0.01 --duration 2 -o " + in("output")));
  ASSERT_EQ(done.code, 0) << done.text;
  EXPECT_NE(done.text.find("200 steps of 0.01, to time 2"), std::string::npos) << done.text;
  const auto fields = json::parse(content(folder_ / "output/fields.json"));
  EXPECT_EQ(fields["format"], "driftless-fields/1");
  EXPECT_EQ(fields["bins"], json({8, 8, 8}));
  EXPECT_EQ(fields["samples"], 201);
  EXPECT_EQ(fields["quantities"]["internal_energy"]["errors"].size(), 512U);
  EXPECT_EQ(fields["run"]["method"]["options"]["lambda"], 0.65);
  const auto monitor = json::parse(content(folder_ / "output/monitor.json"));
  EXPECT_EQ(monitor["columns"]["total_energy"].size(), 201U);
  EXPECT_EQ(monitor["columns"]["time"].back(), 2.0);
  const auto run = json::parse(content(folder_ / "output/run.json"));
  EXPECT_EQ(run["run"]["steps"], 200);
  EXPECT_EQ(run["run"]["scene"]["particles"], 200);
  EXPECT_NE(run["provenance"].dump().find("driftless simulate"), std::string::npos);
  const std::string trajectory = content(folder_ / "output/trajectory.xyz");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 101 * 202);
}

TEST_F(Simulate, TakesPeriodsBinsAndFiles) {
  const auto done =
      call(usual("--time-step 0.01 --duration 2 --every 0.5 --sample-every 0.02 "
                 "--equilibrate 1 --bins 1,4,2 --fields " +
                 in("f") + " --monitor " + in("m") + " --trajectory " + in("t.xyz") +
                 " --checkpoint " + in("c") + " -o " + in("output")));
  ASSERT_EQ(done.code, 0) << done.text;
  const auto fields = json::parse(content(folder_ / "f"));
  EXPECT_EQ(fields["samples"], 51);
  EXPECT_EQ(fields["quantities"]["velocity_z"]["values"].size(), 8U);
  EXPECT_EQ(json::parse(content(folder_ / "m"))["columns"]["time"].size(), 101U);
  EXPECT_TRUE(fs::exists(folder_ / "c"));
  const std::string trajectory = content(folder_ / "t.xyz");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 5 * 202);
}

TEST_F(Simulate, ALaterEndGoesOnAndIsTheSameAsInOneGo) {
  const std::string periods = "--time-step 0.01 --every 0.1 --sample-every 0.02 ";
  ASSERT_EQ(call(usual(periods + "--duration 2 -o " + in("whole"))).code, 0);
  ASSERT_EQ(call(usual(periods + "--duration 0.7 -o " + in("parts"))).code, 0);
  const auto done = call(usual(periods + "--duration 2 -o " + in("parts")));
  ASSERT_EQ(done.code, 0) << done.text;
  for (const auto* name : {"fields.json", "monitor.json", "trajectory.xyz"}) {
    EXPECT_EQ(content(folder_ / "parts" / name), content(folder_ / "whole" / name)) << name;
  }
}

TEST_F(Simulate, GoesOnAfterAKillWithTheSameFiles) {
  const std::string run =
      "--time-step 0.001 --duration 1.5 --every 0.05 --sample-every 0.01 --checkpoint-every 0 "
      "--bins 2,1,2 ";
  ASSERT_EQ(call(usual(run + "-o " + in("whole"))).code, 0);
  const std::string killed = usual(run + "-o " + in("killed"));
  int status = kill_after_a_checkpoint(killed, folder_ / "killed", SIGKILL, in("errors"));
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "killed/fields.json"));
  status = kill_after_a_checkpoint(killed, folder_ / "killed", SIGTERM, in("errors"));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 143);
  ASSERT_EQ(call(killed).code, 0);
  for (const auto* name : {"fields.json", "monitor.json", "trajectory.xyz"}) {
    EXPECT_EQ(content(folder_ / "killed" / name), content(folder_ / "whole" / name)) << name;
  }
}

TEST_F(Simulate, AnInterruptIsOneSentence) {
  const std::string run =
      usual("--time-step 0.0001 --duration 1000 --checkpoint-every 0 -o ") + in("output");
  const int status = kill_after_a_checkpoint(run, folder_ / "output", SIGINT, in("errors"));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string text = content(folder_ / "errors");
  EXPECT_EQ(text.find("driftless: interrupted after step "), 0U) << text;
  EXPECT_NE(text.find("; the same command run again goes on from the checkpoint after step "),
            std::string::npos)
      << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

TEST_F(Simulate, AFailureNamesTheStepAndIsExitCodeOne) {
  const auto done = call(usual("--time-step 20 --duration 20000 -o " + in("output")));
  EXPECT_EQ(done.code, 1);
  EXPECT_EQ(done.text.find("driftless: "), 0U) << done.text;
  EXPECT_NE(done.text.find(" in step "), std::string::npos) << done.text;
}

TEST_F(Simulate, SaysHowFarTheEnergyHasMoved) {
  const auto text = [&](const std::string& arguments, const std::string& output) {
    return call(arguments + " -q -t 1 -o " + in(output)).text;
  };
  const auto kept = text(scene_ + " --method shardlow-s1 --time-step 0.01 --duration 0.1", "kept");
  EXPECT_NE(kept.find("since the start: "), std::string::npos) << kept;
  EXPECT_EQ(kept.find("is needed"), std::string::npos) << kept;
  const auto lost =
      text("soft-fluid --method avalos-mackie-explicit --time-step 0.08 --duration 8", "lost");
  EXPECT_NE(lost.find("%; a smaller step, or a method that keeps it, is needed"), std::string::npos)
      << lost;
  const auto bath =
      text("groot-warren-1997 --method groot-warren --time-step 0.01 --duration 0.1", "bath");
  EXPECT_EQ(bath.find("since the start"), std::string::npos) << bath;
}

TEST_F(Simulate, FaultsAreOneSentenceAndWriteNothing) {
  const std::string output = " -o " + in("output");
  const std::string rest = " --method trotter --time-step 0.01 --duration 2" + output;
  const std::string times = scene_ + " --method trotter" + output;
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"soft-fluit" + rest,
       "SCENE: is \"soft-fluit\", neither a preset nor a file; did you mean \"soft-fluid\"?"},
      {scene_ + " --method trotte --time-step 0.01 --duration 2" + output,
       "did you mean \"trotter\"?"},
      {scene_ + " --method trotter:no=1 --time-step 0.01 --duration 2" + output, "no"},
      {scene_ + " --method all --time-step 0.01 --duration 2" + output,
       "--method: is \"all\"; allowed is \"averaged-drift\""},
      {"groot-warren-1997 --method metropolized-splitting --time-step 0.01 --duration 2" + output,
       "is \"metropolized-splitting\", which cannot run this scene: "},
      {times + " --time-step -1 --duration 2", "--time-step: is -1"},
      {times + " --time-step 0.03 --duration 2",
       "--duration: is 2, no whole number of time steps of 0.03; allowed is for example 2.01"},
      {times + " --time-step 1e-12 --duration 2e3", "allowed is at most 1e12 of them"},
      {scene_ + rest + " --every 0.015", "--every: is 0.015, no whole number of time steps"},
      {scene_ + rest + " --sample-every 0", "--sample-every: is 0"},
      {scene_ + rest + " --equilibrate 2", "--equilibrate: is 2; allowed is a number >= 0 and < 2"},
      {scene_ + rest + " --bins 0,1,1", "--bins: is 0,1,1; allowed is X,Y,Z"},
      {scene_ + rest + " --bins 100,100,100", "with a product of at most 100000"},
      {scene_ + rest + " --fields " + in("no/f"), "in a folder that does not exist"},
      {scene_ + rest + " --fields " + in("f") + " --monitor " + in("f"),
       "which another output is written to"},
      {scene_ + rest + " --fields " + folder_.string(), "a folder; allowed is a file"},
      {scene_ + rest + " --checkpoint " + scene_, "is no checkpoint that this program can read"},
      {"two-body" + rest + " --fields " + in("f"), "isolated pairs, which have no fields"},
  };
  for (const auto& [arguments, message] : faults) {
    const auto fault = call(arguments);
    EXPECT_EQ(fault.code, 2) << arguments;
    EXPECT_NE(fault.text.find(message), std::string::npos) << fault.text;
    EXPECT_EQ(std::count(fault.text.begin(), fault.text.end(), '\n'), 1) << fault.text;
    EXPECT_FALSE(fs::exists(folder_ / "output")) << arguments;
  }
}

TEST_F(Simulate, RunsPairsAndIsothermalFluids) {
  const auto pairs =
      call("two-body --method shardlow-s1 --time-step 0.01 --duration 0.1 -q -o " + in("pairs"));
  EXPECT_EQ(pairs.code, 0) << pairs.text;
  EXPECT_FALSE(fs::exists(folder_ / "pairs/fields.json"));
  std::ofstream(scene_) << R"({"preset": "mackie-1999", "particles": 100,
    "isothermal": true, "initial_state": "canonical"})";
  const auto bath =
      call(scene_ + " --method shardlow-s1 --time-step 0.01 --duration 0.1 -q -o " + in("bath"));
  EXPECT_EQ(bath.code, 0) << bath.text;
  const auto monitor = json::parse(content(folder_ / "bath/monitor.json"));
  EXPECT_FALSE(monitor["columns"].contains("internal_energy"));
}

}  // namespace
