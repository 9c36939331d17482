#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <limits>

#include "experiments/files.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/study.hpp"
#include "tests/json_schema.hpp"
#include "tests/scratch_folder.hpp"

/// The bench itself: parts that are kept, conclusions that are fit for a report.
namespace driftless::judge {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Folder = testing::ScratchFolder;

std::atomic<int> runs = 0;

std::vector<Part> three_parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> parts;
  for (int n = 0; n < 3; ++n) {
    parts.push_back(
        {"part " + std::to_string(n), 1.0 + n, [n, candidate, conditions] {
           ++runs;
           return json{{"number", n}, {"seed", conditions.seed}, {"method", candidate.choice.name}};
         }});
  }
  return parts;
}

Conclusion sum_of_parts(const Candidate& candidate, const Conditions&, const Records& records) {
  double sum = 0;
  for (const auto& [name, record] : records) {
    EXPECT_EQ(record["method"], candidate.choice.name);
    sum += record["number"].get<double>() + record["seed"].get<double>();
  }
  Finding finding;
  finding.subject = "sum";
  finding.verdict = Verdict::fails;
  finding.sentence = "The sum is there.";
  finding.claimed = true;
  finding.value = sum;
  finding.upper = std::numeric_limits<double>::infinity();
  return {{finding}};
}

const Examination counting = {"counting", "Counting", "What is the sum of the parts?", three_parts,
                              sum_of_parts};

json judged(const fs::path& folder, unsigned threads, std::uint64_t seed = 1) {
  return run_judgement(read_candidates({"shardlow-s1", "groot-warren:lambda=0.5"}), {&counting},
                       {folder, {Depth::quick, seed}, threads, "driftless judge", true});
}

json conclusion_of(const json& judgement, std::size_t method) {
  return judgement["methods"][method]["conclusions"]["counting"];
}

TEST(Judge, FinishedPartsAreNotRunAgain) {
  const Folder folder("judge-resume");
  runs = 0;
  const auto first = judged(folder.path(), 2);
  EXPECT_EQ(runs, 6);
  const auto again = judged(folder.path(), 1);
  EXPECT_EQ(runs, 6);
  EXPECT_EQ(first["methods"], again["methods"]);
  EXPECT_EQ(conclusion_of(first, 0)["findings"][0]["value"], 6.0);

  // A part that was cut off, or is of another seed, is run.
  const auto kept = *fs::directory_iterator(folder.path() / "parts");
  write_atomically(kept.path(), R"({"number": 1, "se)");
  EXPECT_EQ(judged(folder.path(), 2)["methods"], first["methods"]);
  EXPECT_EQ(runs, 7);
  EXPECT_EQ(conclusion_of(judged(folder.path(), 2, 2), 0)["findings"][0]["value"], 9.0);
  EXPECT_EQ(runs, 13);
}

TEST(Judge, WritesAReportOfEveryMethod) {
  const Folder folder("judge-report");
  const auto judgement = judged(folder.path(), 2);
  EXPECT_EQ(judgement["format"], "driftless-judgement/1");
  EXPECT_EQ(judgement["methods"][1]["name"], "groot-warren:lambda=0.5");
  EXPECT_EQ(judgement["methods"][1]["options"], (json{{"lambda", 0.5}}));
  const auto finding = conclusion_of(judgement, 1)["findings"][0];
  EXPECT_FALSE(finding.contains("upper")) << "not a number of JSON";

  const auto page = write_judgement(judgement, folder.path());
  EXPECT_TRUE(fs::exists(page));
  EXPECT_TRUE(fs::exists(folder.path() / "judgement.json"));
  const auto read = read_judgement(folder.path());
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, judgement);
  EXPECT_EQ(schema_errors(judgement_schema(), *read), std::vector<std::string>());
  auto wrong = *read;
  wrong["methods"][0]["conclusions"].front()["verdict"] = "perhaps";
  EXPECT_NE(schema_errors(judgement_schema(), wrong), std::vector<std::string>());
  EXPECT_FALSE(read_judgement(folder.path() / "parts"));
  write_atomically(folder.path() / "judgement.json", "{\"format\": \"another\"}");
  EXPECT_THROW(read_judgement(folder.path()), InputError);
  const auto summary = judgement_summary(judgement);
  EXPECT_NE(summary.find("| groot-warren:lambda=0.5 | fails |"), std::string::npos) << summary;
  EXPECT_NE(summary.find("The sum is there. (claimed otherwise)"), std::string::npos) << summary;
}

/// A judgement of one examination, whose findings say who made it.
json made_by(const std::string& examination, const std::string& depth, const std::string& method) {
  return {{"depth", depth},
          {"examinations", {{{"name", examination}, {"depth", depth}, {"command", depth}}}},
          {"methods",
           {{{"name", method},
             {"conclusions", {{examination, {{"verdict", depth}, {"tables", json::array()}}}}}}}}};
}

TEST(Judge, ExaminationsMadeEarlierStay) {
  const auto earlier = made_by("stability", "full", "peters");
  const auto both = united(earlier, made_by("galilean", "quick", "peters"));
  EXPECT_EQ(both["depth"], "full and quick");
  EXPECT_EQ(both["examinations"].size(), 2U);
  const auto& conclusions = both["methods"][0]["conclusions"];
  EXPECT_EQ(conclusions["stability"]["verdict"], "full");
  EXPECT_EQ(conclusions["galilean"]["verdict"], "quick");

  const auto again = united(both, made_by("stability", "quick", "peters"));
  EXPECT_EQ(again["depth"], "quick");
  EXPECT_EQ(again["methods"][0]["conclusions"]["stability"]["verdict"], "quick");
  EXPECT_EQ(again["examinations"].size(), 2U);

  const auto other = made_by("galilean", "quick", "trotter");
  EXPECT_EQ(united(earlier, other), other) << "of another method";
}

TEST(Judge, MistakesOnTheCommandLineAreNamed) {
  const auto complaint = [](const std::string& text) -> std::string {
    try {
      read_candidates({text});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(complaint("shardlow-s3").find("did you mean \"shardlow-s1\"?"), std::string::npos);
  EXPECT_NE(complaint("groot-warren:lambda").find("NAME:option=value"), std::string::npos);
  EXPECT_NE(complaint("groot-warren:lamda=0.5").find("did you mean \"lambda\"?"),
            std::string::npos);
  EXPECT_NE(complaint("groot-warren:lambda=much").find("number"), std::string::npos);
  EXPECT_EQ(read_candidates({"all"}).size(), methods().size());
  EXPECT_THROW(read_examinations({"no such thing"}), InputError);
}

TEST(Judge, AZeroIsFoundAsSharplyAsItIsKnown) {
  EXPECT_EQ(zero_finding("", 0.04, 0.01, 0.1).verdict, Verdict::holds);
  EXPECT_EQ(zero_finding("", 0.06, 0.01, 0.1).verdict, Verdict::fails);
  EXPECT_EQ(zero_finding("", -0.06, 0.01, 0.1).verdict, Verdict::fails);
  EXPECT_EQ(zero_finding("", 0.04, 0.03, 0.1).verdict, Verdict::not_resolved);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(zero_finding("", 0.04, infinity, 0.1).verdict, Verdict::not_resolved);
  EXPECT_DOUBLE_EQ(*zero_finding("", 0.04, 0.01, 0.1).resolution, 0.05);
}

TEST(Judge, TheWorstFindingIsTheVerdict) {
  const auto of = [](std::vector<Verdict> verdicts) {
    Conclusion conclusion;
    for (const auto verdict : verdicts) conclusion.findings.push_back({"", verdict, ""});
    return overall(conclusion);
  };
  EXPECT_EQ(of({Verdict::holds, Verdict::fails, Verdict::not_resolved}), Verdict::fails);
  EXPECT_EQ(of({Verdict::holds, Verdict::not_resolved}), Verdict::not_resolved);
  EXPECT_EQ(of({Verdict::reported, Verdict::holds}), Verdict::holds);
  EXPECT_EQ(of({}), Verdict::not_applicable);
}

}  // namespace
}  // namespace driftless::judge
