#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "experiments/files.hpp"
#include "experiments/reproduce/papers.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/study.hpp"
#include "tests/json_schema.hpp"
#include "tests/scratch_folder.hpp"

/// The papers' experiments as such: parts that are kept, verdicts, reports.
namespace driftless::reproduce {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Folder = testing::ScratchFolder;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::atomic<int> runs = 0, running = 0;
std::atomic<bool> fails = false, was_alone = true;
std::atomic<unsigned> wide_threads = 0;

/// Three narrow parts and a wide one, whose checkpoint holds what an earlier run has left.
std::vector<Part> four_parts(const Conditions& conditions) {
  std::vector<Part> parts;
  for (int n = 0; n < 3; ++n) {
    parts.push_back(
        {"part " + std::to_string(n), 1.0 + n, false, [n, conditions](const Workplace& workplace) {
           ++running, ++runs;
           EXPECT_EQ(workplace.threads, 1U);
           if (fails && n > 0) throw InputError("part of number " + std::to_string(n));
           --running;
           return json{{"number", n + conditions.seed / 3.0}};
         }});
  }
  parts.push_back({"wide", 100, true, [](const Workplace& workplace) {
                     ++runs;
                     wide_threads = workplace.threads;
                     was_alone = was_alone && running == 0;
                     EXPECT_EQ(workplace.checkpoint.extension(), ".checkpoint");
                     write_atomically(workplace.checkpoint, "half of it");
                     return json{{"number", 0.1}};
                   }});
  return parts;
}

Outcome sum_of_parts(const Conditions&, const Records& records) {
  double sum = 0;
  for (const auto& [name, record] : records) sum += record["number"].get<double>();
  Row row{"sum", "by hand", "kT", Interval{3, 3, 3}, "three", {sum, sum - 1, sum + 1}, {}, "|"};
  row.verdict = compare(row.ours, *row.paper, 1);
  Row analytic{"by a formula", "", "1", {}, "", {2, 2, 2}, Verdict::agrees};
  analytic.theory = Interval{2, 2, 2};
  analytic.theory_text = "eq. 5";
  Row unknown{"what is not known", "", "1", {}, "", {not_a_number, 0, HUGE_VAL}};
  Field field{{"x"}, {"z"}, 0, 2, 0, 1, 2, 1, "T", {1, not_a_number}, {}, {1, 2}, {0, 0}};
  judge::Chart chart{"c", {"t"}, {"T"}, {{"ours", {{0, 1, {}, {}}, {1, not_a_number, {}, {}}}}}};
  return {{row, unknown, analytic},
          {{"a field", "", {}, field}, {"a chart", "words", chart, {}}},
          {"a remark"}};
}

const Experiment summing{"summing",          "A Fig. 1", "Summing",
                         "What is the sum?", four_parts, sum_of_parts};
const Experiment other{"other",
                       "B",
                       "Another",
                       "And this?",
                       [](const Conditions&) {
                         return std::vector<Part>{{"only", 1, false, [](const Workplace&) {
                                                     return json{{"number", 1}};
                                                   }}};
                       },
                       sum_of_parts};

json reproduced_under(const Conditions& conditions, const fs::path& folder, unsigned threads) {
  ReproduceOptions options;
  options.directory = folder;
  options.conditions = conditions;
  options.threads = threads;
  options.command = "driftless reproduce";
  options.quiet = true;
  return run_experiments({&summing, &other}, options);
}

json reproduced(const fs::path& folder, unsigned threads, std::uint64_t seed = 1) {
  Conditions conditions;
  conditions.seed = seed;
  return reproduced_under(conditions, folder, threads);
}

json reproduced_with(const fs::path& folder, const MethodChoice& method) {
  Conditions conditions;
  conditions.method = method;
  return reproduced_under(conditions, folder, 2);
}

class Reproduce : public ::testing::Test {
 protected:
  Reproduce() : folder_("reproduce") {
    runs = running = 0;
    fails = false;
    was_alone = true;
  }
  const Folder folder_;
};

TEST_F(Reproduce, FinishedPartsAreNotRunAgain) {
  const auto first = reproduced(folder_.path(), 2)["experiments"];
  EXPECT_EQ(runs, 4);
  EXPECT_NEAR(first[0]["rows"][0]["ours"]["value"].get<double>(), 4.1, 1e-12);
  EXPECT_EQ(reproduced(folder_.path(), 1)["experiments"], first);
  EXPECT_EQ(runs, 4);

  // A part that was cut off, or is of another seed, is run.
  write_atomically((*fs::directory_iterator(folder_.path() / "parts")).path(), R"({"numb)");
  EXPECT_EQ(reproduced(folder_.path(), 2)["experiments"], first);
  EXPECT_LE(runs, 5);
  EXPECT_NE(reproduced(folder_.path(), 2, 2)["experiments"], first);
  EXPECT_GE(runs, 8);
}

TEST_F(Reproduce, SameNumbersForAnyThreads) {
  const auto one = reproduced(folder_.path() / "one", 1)["experiments"];
  EXPECT_EQ(wide_threads, 1U);
  const auto two = reproduced(folder_.path() / "two", 2)["experiments"];
  EXPECT_EQ(wide_threads, 2U);
  EXPECT_EQ(one, two);
  EXPECT_TRUE(was_alone) << "a wide part runs when all narrow ones have ended";
}

TEST_F(Reproduce, PartsOfAnotherMethodAreRunAndKeptBesideThePapers) {
  const auto of_paper = reproduced(folder_.path(), 2)["experiments"];
  EXPECT_FALSE(of_paper[0].contains("method"));
  for (const MethodChoice& method :
       {MethodChoice{"groot-warren", {}}, MethodChoice{"groot-warren", {{"lambda", 0.5}}}}) {
    runs = 0;
    const auto papers = reproduced_with(folder_.path(), method);
    EXPECT_EQ(runs, 4);
    const auto& one = papers["experiments"][0];
    EXPECT_EQ(one["method"], to_string(method));
    EXPECT_EQ(one["rows"], of_paper[0]["rows"]) << "these parts do not depend on it";
    EXPECT_TRUE(one["remarks"][0].get<std::string>().starts_with(to_string(method) + " runs here"));
    EXPECT_EQ(reproduced_with(folder_.path(), method)["experiments"], papers["experiments"]);
    EXPECT_EQ(runs, 4);
    EXPECT_EQ(schema_errors(papers_schema(), papers), std::vector<std::string>());
    const auto summary = papers_summary(papers);
    EXPECT_NE(summary.find("| summing, with " + to_string(method) + " | A Fig. 1 |"),
              std::string::npos)
        << summary;
    EXPECT_NE(summary.find("## A Fig. 1: Summing, with " + to_string(method) + "\n"),
              std::string::npos)
        << summary;
  }
  runs = 0;
  EXPECT_EQ(reproduced(folder_.path(), 2)["experiments"], of_paper);
  EXPECT_EQ(runs, 0);
}

TEST_F(Reproduce, NoCheckpointOutlivesItsPart) {
  reproduced(folder_.path(), 1);
  std::size_t kept = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "parts")) {
    EXPECT_EQ(entry.path().extension(), ".json") << entry.path();
    ++kept;
  }
  EXPECT_EQ(kept, 5U);
}

TEST_F(Reproduce, AFailureIsReportedAndTheOthersGoOn) {
  fails = true;
  const auto papers = reproduced(folder_.path(), 2);
  EXPECT_EQ(papers["experiments"][0]["failure"], "part 1: part of number 1");
  EXPECT_TRUE(papers["experiments"][0]["rows"].empty());
  EXPECT_FALSE(papers["experiments"][1].contains("failure"));
  EXPECT_EQ(papers["experiments"][1]["rows"].size(), 3U);
  EXPECT_NE(papers_summary(papers).find("Failed: part 1: part of number 1"), std::string::npos);

  // What did not fail is kept.
  fails = false;
  runs = 0;
  EXPECT_FALSE(reproduced(folder_.path(), 2)["experiments"][0].contains("failure"));
  EXPECT_EQ(runs, 2);
}

TEST(Papers, KeepTheExperimentsOfAnEarlierReportThatAreNotRunAgain) {
  const auto& all = experiments();
  ASSERT_GE(all.size(), 3U);
  const auto record = [](const Experiment* experiment, const char* command) {
    return json{{"name", experiment->name}, {"command", command}};
  };
  const json earlier = {
      {"experiments", {record(all[1], "first"), record(all[2], "first"), {{"name", "long gone"}}}}};
  const json later = {{"experiments", {record(all[2], "second"), record(all[0], "second")}}};
  const json both = united(earlier, later)["experiments"];
  EXPECT_EQ(both,
            json({record(all[0], "second"), record(all[1], "first"), record(all[2], "second")}));
  EXPECT_EQ(united(std::nullopt, later), later);
}

TEST(Papers, KeepAnExperimentUnderSeveralMethods) {
  const auto record = [](const Experiment* experiment, const char* method, const char* command) {
    json one = {{"name", experiment->name}, {"command", command}};
    if (*method != 0) one["method"] = method;
    return one;
  };
  const auto* const first = experiments()[0];
  const auto* const second = experiments()[1];
  const json earlier = {{"experiments",
                         {record(first, "peters", "old"), record(first, "", "old"),
                          record(second, "shardlow-s1", "old")}}};
  const json later = {
      {"experiments", {record(first, "peters", "new"), record(first, "groot-warren", "new")}}};
  EXPECT_EQ(united(earlier, later)["experiments"],
            json({record(first, "", "old"), record(first, "groot-warren", "new"),
                  record(first, "peters", "new"), record(second, "shardlow-s1", "old")}));
}

TEST_F(Reproduce, WritesAReportThatCanBeReadAgain) {
  const auto papers = reproduced(folder_.path(), 2);
  const auto page = write_papers(papers, folder_.path());
  EXPECT_TRUE(fs::exists(page));
  const auto read = read_papers(folder_.path());
  ASSERT_TRUE(read);
  EXPECT_EQ(read_papers(folder_.path() / "papers.json"), read);
  EXPECT_EQ(schema_errors(papers_schema(), *read), std::vector<std::string>());
  auto wrong = *read;
  wrong["experiments"][0]["rows"][0]["verdict"] = "perhaps";
  EXPECT_NE(schema_errors(papers_schema(), wrong), std::vector<std::string>());

  const auto& experiment = (*read)["experiments"][0];
  EXPECT_EQ(experiment["rows"][1]["ours"], (json{{"low", 0.0}})) << "what is not finite is no JSON";
  EXPECT_EQ(experiment["pictures"][0]["field"]["values"], (json{1.0, nullptr}));
  EXPECT_EQ(experiment["pictures"][1]["chart"]["series"][0]["points"].size(), 1U);

  EXPECT_FALSE(read_papers(folder_.path() / "parts"));
  write_atomically(folder_.path() / "papers.json", "{\"format\": \"another\"}");
  EXPECT_THROW(read_papers(folder_.path()), InputError);
}

TEST_F(Reproduce, TheSummaryHasEveryRow) {
  const auto summary = papers_summary(reproduced(folder_.path(), 2));
  EXPECT_NE(summary.find("| summing | A Fig. 1 | 1 | 1 | 0 | 1 |"), std::string::npos) << summary;
  EXPECT_NE(summary.find("| sum, kT | by hand | 3: three | - | 4.1 (3.1 to 5.1) | differs | \\| |"),
            std::string::npos)
      << summary;
  EXPECT_NE(summary.find("| what is not known |  | - | - | - | ours alone |  |"),
            std::string::npos);
  EXPECT_NE(summary.find("| by a formula |  | - | 2: eq. 5 | 2 | agrees |  |"), std::string::npos);
}

TEST_F(Reproduce, AFolderThatCannotBeWrittenIsNamed) {
  fs::create_directories(folder_.path());
  write_atomically(folder_.path() / "file", "");
  EXPECT_THROW(reproduced(folder_.path() / "file", 1), InputError);
  EXPECT_EQ(runs, 0);
}

TEST(ReproduceVerdict, IntervalsThatMeetAgreeIfOursIsNarrow) {
  const Interval paper{10, 9.9, 10.1};
  EXPECT_EQ(compare({10.05, 10, 10.1}, paper, 0.01), Verdict::agrees);
  EXPECT_EQ(compare({10.2, 10.1, 10.3}, paper, 0.02), Verdict::agrees) << "they touch";
  EXPECT_EQ(compare({10.3, 10.11, 10.5}, paper, 0.01), Verdict::differs);
  EXPECT_EQ(compare({9.7, 9.5, 9.89}, paper, 0.01), Verdict::differs);
  EXPECT_EQ(compare({10, 9.8, 10.2}, paper, 0.01), Verdict::not_resolved);
  EXPECT_EQ(compare({10, 9.99, 10.2}, paper, 0.01), Verdict::not_resolved) << "to one side";
  EXPECT_EQ(compare({20, 15, 25}, paper, 0.01), Verdict::differs) << "wide, but far away";
  EXPECT_EQ(compare({-10, -10, -10}, {-10, -10, -10}, 0.01), Verdict::agrees);
  EXPECT_EQ(compare({0.005, -0.004, 0.014}, {0, 0, 0}, 0.01), Verdict::agrees) << "absolute";
  EXPECT_EQ(compare({10, not_a_number, 10}, paper, 0.01), Verdict::not_resolved);
  EXPECT_EQ(compare({10, -HUGE_VAL, HUGE_VAL}, paper, 0.01), Verdict::not_resolved);
}

TEST(ReproduceList, NamesAreFoundAndMistakesCorrected) {
  const auto all = read_experiments({"all"});
  EXPECT_EQ(all.size(), experiments().size());
  ASSERT_FALSE(all.empty());
  const std::string name(all.back()->name);
  EXPECT_EQ(read_experiments({name, "all", name}).size(), all.size()) << "each once";
  EXPECT_EQ(read_experiments({name, "all"}).front(), all.back()) << "in the order asked for";
  try {
    read_experiments({name + "x"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"" + name + "\"?"), std::string::npos)
        << error.what();
  }
}

std::string refusal_of(const MethodChoice& method, const std::vector<std::string>& names) {
  try {
    std::vector<std::string> left_out;
    experiments_run_by(method, names, left_out);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReproduceMethod, WhatItCannotRunIsRefusedWithTheReasonOrLeftOutOfAll) {
  EXPECT_EQ(refusal_of({"espanol", {}}, {"mackie-1999-walls"}),
            "--method: espanol cannot run mackie-1999-walls: espanol is built for the friction "
            "closure noise, this scene has the closure friction");
  EXPECT_NE(refusal_of({"isoenergetic-verlet", {}}, {"all", "marsh-coveney-1998-species"})
                .find("isothermal"),
            std::string::npos)
      << "one that is named is not left out";
  EXPECT_NE(refusal_of({"peters", {}}, {"methods-transport"}).find("without --method"),
            std::string::npos);
  EXPECT_EQ(refusal_of({"peters", {}}, {"mackie-1999-walls"}), "");

  std::vector<std::string> left_out;
  const auto suited = experiments_run_by({"isoenergetic-verlet", {}}, {"all"}, left_out);
  EXPECT_FALSE(suited.empty());
  EXPECT_EQ(suited.size() + left_out.size(), experiments().size());
  for (const auto* one : suited) {
    EXPECT_TRUE(one->name.starts_with("soleymani") || one->name == "marsh-coveney-1998-entropy")
        << one->name;
  }
}

TEST(ReproduceMethod, EachMethodIsRunOnceAndTheChosenOneFirst) {
  const MethodChoice published{"isoenergetic-verlet", {}}, contrast{"shardlow-s1", {}};
  const auto names = [&](const std::optional<MethodChoice>& method) {
    std::vector<std::string> all;
    const Conditions conditions{Effort::quick, 1, method};
    for (const auto& one : conditions.methods_or(published, {contrast})) {
      all.push_back(to_string(one));
    }
    return all;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names({}), (Names{"isoenergetic-verlet", "shardlow-s1"}));
  EXPECT_EQ(names(MethodChoice{"peters", {}}), (Names{"peters", "shardlow-s1"}));
  EXPECT_EQ(names(contrast), Names{"shardlow-s1"});
  const MethodChoice same_again{"shardlow-s1", {{"as_published", false}}};
  EXPECT_EQ(names(same_again), Names{"shardlow-s1:as_published=false"});
  const MethodChoice different{"shardlow-s1", {{"as_published", true}}};
  EXPECT_EQ(names(different), (Names{"shardlow-s1:as_published=true", "shardlow-s1"}));
}

/// Part names of an experiment under its paper's method and under others, each once.
void expect_sound_parts(const Experiment& experiment, const Conditions& conditions) {
  std::set<std::string> names;
  for (const auto& part : experiment.parts(conditions)) {
    EXPECT_TRUE(names.insert(part.name).second) << experiment.name << ": " << part.name;
    EXPECT_GT(part.cost, 0) << experiment.name << ": " << part.name;
  }
  EXPECT_FALSE(names.empty()) << experiment.name;
}

TEST(ReproduceList, EveryExperimentIsFitForAReport) {
  std::set<std::string_view> names;
  for (const auto* experiment : experiments()) {
    EXPECT_TRUE(names.insert(experiment->name).second) << experiment->name;
    EXPECT_EQ(experiment->name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"),
              std::string_view::npos)
        << experiment->name;
    for (const auto effort : {Effort::quick, Effort::full}) {
      expect_sound_parts(*experiment, {effort, 1});
      for (const auto* method : methods()) {
        const MethodChoice choice{std::string(method->name), {}};
        if (experiment->unsuited && experiment->unsuited(choice)) continue;
        expect_sound_parts(*experiment, {effort, 1, choice});
      }
    }
  }
}

}  // namespace
}  // namespace driftless::reproduce
