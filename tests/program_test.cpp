// The program as its users call it: exit codes, messages, files, and a kill in the middle.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/program_call.hpp"

namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using driftless::Outcome;

Outcome call(const std::string& arguments) { return driftless::call_program(arguments); }

class Program : public driftless::InFolder {
 protected:
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
};

TEST_F(Program, HelpAndVersionOfEverything) {
  for (const auto* arguments :
       {"--help", "--version", "run --help", "check --help", "report --help", "recommend --help",
        "methods --help", "scenes --help", "observables --help", "schema --help", "compare --help",
        "keep --help", "reproduce --help", "reproduce --list"}) {
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
  for (const auto* name : {"mackie-1999", "soft-fluid", "two-body", "groot-warren-1997"}) {
    EXPECT_NE(scenes.find(name), std::string::npos) << name;
  }
  // Also what a preset's own start has no use for.
  for (const auto* key : {"initial_velocities", "initial_velocity_spread", "initial_temperature"}) {
    EXPECT_NE(scenes.find(std::string("  ") + key), std::string::npos) << key;
  }
  EXPECT_NE(call("observables").text.find("internal_energy_variance"), std::string::npos);
  for (const auto* kind : {"study", "result", "comparison", "papers"}) {
    EXPECT_TRUE(json::parse(call(std::string("schema ") + kind).text).contains("$schema")) << kind;
  }
}

TEST_F(Program, WrongUseEndsWithTwo) {
  for (const auto* arguments :
       {"", "nonsense", "run", "schema", "schema nonsense", "run a b c",
        "run study.json --threads 0", "recommend", "recommend --budget 1", "compare one",
        "reproduce", "reproduce nonsense", "reproduce all --threads 0"}) {
    EXPECT_EQ(call(arguments).code, 2) << arguments;
  }
}

TEST_F(Program, AMistypedCommandLineIsAnsweredWithTheNearestName) {
  const std::pair<const char*, const char*> answers[] = {
      {"judgee", "there is no command \"judgee\"; did you mean \"judge\"?"},
      {"judge shardlow-s1 --dept full", "judge takes no \"--dept\"; did you mean \"--depth\"?"},
      {"check a.json b.json", "check takes no further \"b.json\""},
      {"", "name a command; driftless --help lists them"}};
  for (const auto& [arguments, answer] : answers) {
    const auto outcome = call(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.text, "driftless: " + std::string(answer) + "\n");
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

TEST_F(Program, AMethodThatCannotRunAnExperimentEndsWithTwoInOneSentenceAndWritesNothing) {
  const auto output = folder_ / "output";
  for (const auto& [method, words] :
       {std::pair("espanol", "cannot run mackie-1999-walls: espanol is built for"),
        std::pair("shardlow-s9", "did you mean \"shardlow-s"),
        std::pair("all", "is \"all\"; allowed is \"averaged-drift")}) {
    const auto outcome = call(std::string("reproduce mackie-1999-walls --quick --method ") +
                              method + " -o " + output.string());
    EXPECT_EQ(outcome.code, 2) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
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

TEST_F(Program, CheckWarnsOfWhatIsTooShortAndOfMethodsThatDoNotApply) {
  const auto study = write("short.json", R"({"format": "driftless-study/1",
      "scenes": [{"preset": "mackie-1999", "particles": 60, "friction_closure": "friction"},
                 {"preset": "mackie-1999", "particles": 60, "heat_form": "none"}],
      "methods": ["espanol", "marsh-coveney", "shardlow-s1"], "time_steps": [0.02],
      "duration": {"equilibrate": 10, "measure": 40, "sample_every": 0.1}})");
  const auto outcome = call("check " + study);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.text.find("warning: espanol and marsh-coveney do not apply to "),
            std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("internal energies relax in about 253, which takes equilibrate "
                              "1.26e+03 and measure 5.06e+03"),
            std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("a valid study of 2 scenes, 3 methods, 1 time step and 2 replicas"),
            std::string::npos)
      << outcome.text;
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 3) << outcome.text;
}

TEST_F(Program, AStudyInWhichNoMethodAppliesEndsWithTwo) {
  const auto study = write("none.json", R"({"format": "driftless-study/1",
      "scene": {"preset": "mackie-1999", "particles": 60, "friction_closure": "friction"},
      "methods": ["espanol"], "time_steps": [0.02],
      "duration": {"equilibrate": 10, "measure": 40, "sample_every": 0.1}})");
  const auto output = folder_ / "output";
  for (const auto& verb : {std::string("check "), "run -o " + output.string() + " "}) {
    const auto outcome = call(verb + study);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find("no method of the study applies to any of its scenes: espanol is"),
              std::string::npos)
        << outcome.text;
  }
  EXPECT_FALSE(fs::exists(output));
}

TEST_F(Program, RecommendReadsWhatRunWrote) {
  const auto output = (folder_ / "output").string();
  ASSERT_EQ(call("run -q " + good_study() + " -o " + output).code, 0);
  const auto outcome =
      call("recommend " + output + " --tolerance 50% --observable " + "internal_energy_variance");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(
      outcome.text.find("For mackie-1999, to have the internal energy variance within 50 %: "), 0U)
      << outcome.text;
  const auto bad = call("recommend " + output + " --tolerance much");
  EXPECT_EQ(bad.code, 2);
  EXPECT_EQ(std::count(bad.text.begin(), bad.text.end(), '\n'), 1) << bad.text;
}

TEST_F(Program, CompareEndsWithWhatItFound) {
  const auto before = (folder_ / "before").string(), after = (folder_ / "after").string();
  ASSERT_EQ(call("run -q " + good_study() + " -o " + before).code, 0);
  ASSERT_EQ(call("run -q --seed 99 " + good_study() + " -o " + after).code, 0);
  const auto kept = (folder_ / "kept.json").string(), record = (folder_ / "record.json").string();
  ASSERT_EQ(call("keep " + before + " " + kept).code, 0);
  EXPECT_EQ(call("compare --gate --wanted-effect 0 " + kept + " " + after).code, 2) << "blind";
  const auto same =
      call("compare --gate --wanted-effect 1 --json " + record + " " + kept + " " + after);
  EXPECT_EQ(same.code, 0) << same.text;
  EXPECT_NE(same.text.find("NEW is the same as BASE, at a family level of 1e-05"),
            std::string::npos)
      << same.text;
  std::ifstream file(record);
  EXPECT_EQ(json::parse(file)["verdict"], "same");
  std::ifstream text(kept);
  json changed = json::parse(text);
  for (auto& cell : changed["cells"]) {
    auto& entry = cell["observables"]["kinetic_temperature"];
    entry["mean"] = 2 * entry["mean"].get<double>();
    entry["error"] = 1e-6;
    entry.erase("degrees_of_freedom");
  }
  const auto sure = write("sure.json", changed.dump());
  for (auto& cell : changed["cells"]) {
    auto& entry = cell["observables"]["kinetic_temperature"];
    entry["mean"] = 2 * entry["mean"].get<double>();
  }
  const auto worse = write("worse.json", changed.dump());
  EXPECT_EQ(call("compare --gate " + sure + " " + worse).code, 1);
  EXPECT_EQ(call("compare " + sure + " " + worse).code, 0) << "no gate";
  changed["cells"].erase(0);
  const auto fewer = call("compare --gate " + kept + " " + write("fewer.json", changed.dump()));
  EXPECT_EQ(fewer.code, 2);
  EXPECT_NE(fewer.text.find("NEW lacks 1 of the 4 cells of BASE"), std::string::npos) << fewer.text;
  EXPECT_EQ(call("compare " + kept + " " + good_study()).code, 2) << "a study is no result";
}

TEST_F(Program, AnInterruptedRunSaysWhatIsFinishedAndHowItGoesOn) {
  const auto study = good_study(4000);
  const auto output = folder_ / "output", errors = folder_ / "errors";
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    fs::remove(output / "plan.json");
    const pid_t child = fork();
    if (child == 0) {
      ::signal(SIGINT, SIG_DFL);  // whoever runs the tests may ignore it
      if (std::freopen(errors.c_str(), "w", stderr) == nullptr) _exit(126);
      execl(DRIFTLESS_PROGRAM, DRIFTLESS_PROGRAM, "run", "-q", study.c_str(), "-o", output.c_str(),
            static_cast<char*>(nullptr));
      _exit(127);
    }
    // The plan is written when the cells begin.
    while (!fs::exists(output / "plan.json") && waitpid(child, nullptr, WNOHANG) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    kill(child, signal);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), code);
    std::ifstream file(errors);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NE(text.find("driftless: interrupted; "), std::string::npos) << text;
    EXPECT_NE(text.find("the same command goes on: driftless run " + study), std::string::npos);
    const auto report = call("report " + output.string());
    EXPECT_EQ(report.code, 2);
    EXPECT_NE(report.text.find("the study there is not finished: 4 of 4 cells, the first of them "
                               "mackie-1999, averaged-drift, step 0.01"),
              std::string::npos)
        << report.text;
  }
}

TEST_F(Program, CellsOfAnotherBuildOrStudyAreNamedNotTaken) {
  const auto output = folder_ / "output";
  ASSERT_EQ(call("run -q " + good_study() + " -o " + output.string()).code, 0);
  const auto changed = call("run " + good_study(5) + " -o " + output.string());
  EXPECT_NE(changed.text.find("4 finished cells in " + output.string() +
                              " are not used: they are of another study\n"),
            std::string::npos)
      << changed.text;
  const auto again = call("run " + good_study(5) + " -o " + output.string());
  EXPECT_EQ(again.text.find("not used"), std::string::npos) << "told once";
  // What a folder looks like to a program that was built anew: all names of its cells are others.
  std::ifstream file(output / "plan.json");
  auto plan = json::parse(file);
  plan["program"] = "another";
  for (auto& cell : plan["cells"]) {
    const std::string name = cell["file"], other = "0" + name;
    fs::rename(output / "cells" / name, output / "cells" / other);
    cell["file"] = other;
  }
  std::ofstream(output / "plan.json") << plan.dump();
  const auto rebuilt = call("run " + good_study(5) + " -o " + output.string());
  EXPECT_NE(rebuilt.text.find("4 finished cells in " + output.string() +
                              " are not used: they are of another build of the program\n"),
            std::string::npos)
      << rebuilt.text;
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
