#include "experiments/recommend.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "experiments/answers.hpp"
#include "experiments/result_file.hpp"
#include "experiments/study.hpp"
#include "tests/small_result.hpp"

namespace driftless {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Recommend : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("driftless-recommend-" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    cells_ = {{"cheap", 0.02, 1, 0.030},
              {"good", 0.02, 2, 0.002},
              {"good", 0.01, 4, 0.001},
              {"next", 0.01, 3, 0.003},
              {"broken", 0.02, 0.5, 0, 0.001, "unstable"}};
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const json& result, const std::string& name = "result.json") const {
    std::ofstream(folder_ / name) << result.dump();
    return (folder_ / name).string();
  }
  /// What is refused, in one line.
  static std::string refused(const Question& question) {
    try {
      return "not refused: " + recommend(question);
    } catch (const InputError& error) {
      return error.what();
    }
  }

  fs::path folder_;
  std::vector<SmallCell> cells_;
};

const std::string equilibrium_text = "temperatures and the variance of the internal energy";

TEST_F(Recommend, NamesTheCheapestTheNextWhatFailedAndWhatCouldBeSeen) {
  const auto file = write(small_result(cells_));
  EXPECT_EQ(recommend({{file}, "0.5%", "", "", ""}),
            "For scene, to have " + equilibrium_text +
                " within 0.5 %: good at step 0.02, 2 core-s per unit time, wrong by at most 0.43 % "
                "at 95 % confidence; the smallest error that this study can see is 0.23 %; 1 of 5 "
                "cells failed (unstable 1).\n");
  const auto wider = recommend({{file}, "0.01", "kinetic_temperature", "", ""});
  EXPECT_NE(wider.find("the kinetic temperature within 1 %: good at step 0.02"), std::string::npos);
  EXPECT_NE(wider.find("; next next at step 0.01, 1.5 times the cost"), std::string::npos);
}

TEST_F(Recommend, TakesPercentAndPlainNumbersAlike) {
  const auto file = write(small_result(cells_));
  const auto percent = recommend({{file}, "0.5%", "", "", ""});
  for (const char* same : {"0.005", "5e-3", "0.5 %", "0.50%"}) {
    EXPECT_EQ(recommend({{file}, same, "", "", ""}), percent) << same;
  }
}

TEST_F(Recommend, SaysAsMuchAsTheResultsOwnAnswers) {
  auto result = small_result(cells_, {"one", "two"});
  const auto file = write(result);
  add_answers(result);
  for (const auto& answer : result["answers"]) {
    const std::string sentence = answer["sentence"];
    const auto text = recommend({{file},
                                 answer["tolerance"].dump(),
                                 answer["observable"].get<std::string>(),
                                 "",
                                 answer["scene"].get<std::string>()});
    EXPECT_EQ(text.find(sentence.substr(0, sentence.size() - 1)), 0U) << text << sentence;
  }
}

TEST_F(Recommend, OfABudgetNamesTheMostAccurate) {
  const auto file = write(small_result(cells_));
  const auto text = recommend({{file}, "", "", "3.5", ""});
  EXPECT_NE(text.find("good at step 0.02, 2 core-s per unit time, wrong by at most 0.43 %"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("; next next at step 0.01, by at most 0.53 %"), std::string::npos) << text;
  EXPECT_NE(recommend({{file}, "0.1%", "", "3.5", ""}).find("so not shown to be within 0.1 %"),
            std::string::npos);
  EXPECT_NE(recommend({{file}, "", "", "0.1", ""}).find("no method and step of this study costs"),
            std::string::npos);
}

TEST_F(Recommend, GivesEveryScenesSentenceAndTheFileOfSeveral) {
  const auto one = write(small_result(cells_, {"first", "second"}));
  const auto two = write(small_result(cells_, {"third"}), "other.json");
  const auto text = recommend({{one, two}, "1%", "", "", ""});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_EQ(text.find(one + ": For first, "), 0U);
  EXPECT_NE(text.find("\n" + two + ": For third, "), std::string::npos);
  EXPECT_EQ(recommend({{folder_.string()}, "1%", "", "", "second"}).find("For second, "), 0U);
}

TEST_F(Recommend, AsksJudgementsToo) {
  const auto point = [](const char* method, double step, double cost, double upper) {
    return json{{"method", method},   {"time_step", step}, {"cost", cost},
                {"error", upper / 2}, {"lower", 0},        {"upper", upper}};
  };
  const auto method = [](const char* name) {
    return json{{"name", name}, {"conclusions", {{"limits", {{"findings", json::array()}}}}}};
  };
  json judgement = {{"format", "driftless-judgement/1"},
                    {"examinations", json::array()},
                    {"methods", {method("one"), method("two")}},
                    {"trade",
                     {{{"scene", "fluid, phi/k = 5"},
                       {"observable", "kinetic_temperature"},
                       {"points", {point("one", 0.1, 1, 0.004), point("two", 0.1, 2, 0.003)}}}}}};
  const auto file = write(judgement, "judgement.json");
  EXPECT_EQ(
      recommend({{file}, "1%", "kinetic_temperature", "", ""}),
      "For fluid, phi/k = 5, to have the kinetic temperature within 1 %: one at step 0.1, 1 "
      "core-s per unit time, wrong by at most 0.4 % at 95 % confidence; next two at step 0.1, "
      "2 times the cost; the smallest error that this study can see is 0.15 %.\n");
  EXPECT_EQ(recommend({{folder_.string()}, "1%", "kinetic_temperature", "", ""}),
            recommend({{file}, "1%", "kinetic_temperature", "", ""}));
  judgement["trade"] = json::array();
  write(judgement, "judgement.json");
  EXPECT_EQ(refused({{file}, "1%", "", "", ""}),
            file +
                ": its judgement has no trade of error against cost; allowed is one with the "
                "examination limits");
}

TEST_F(Recommend, SaysWhatIsNotResolved) {
  auto result = small_result(cells_);
  for (auto& cell : result["cells"]) {
    if (cell["method"] == "good") {
      cell["observables"]["internal_temperature"]["status"] = "not_resolved";
    }
  }
  const auto text = recommend({{write(result)}, "1%", "", "", ""});
  EXPECT_NE(text.find("next at step 0.01"), std::string::npos) << text;
  EXPECT_NE(text.find("; 2 of 5 cells do not resolve it;"), std::string::npos) << text;
}

TEST_F(Recommend, RefusesInOneSentence) {
  const auto file = write(small_result(cells_));
  EXPECT_EQ(refused({{file}, "", "", "", ""}),
            "recommend needs --tolerance, such as 0.5%, or --budget");
  for (const char* bad : {"0", "-1%", "half", "%", "1e999", "0.5%%", "nan", "0,5%", " 1", "5"}) {
    EXPECT_EQ(refused({{file}, bad, "", "", ""}).find("--tolerance: is \""), 0U) << bad;
  }
  EXPECT_EQ(refused({{file}, "", "", "cheap", ""}).find("--budget: is \"cheap\""), 0U);
  EXPECT_EQ(refused({{file}, "1%", "kinetic_temperatur", "", ""}),
            "--observable: is \"kinetic_temperatur\", which is none; did you mean "
            "\"kinetic_temperature\"?");
  EXPECT_NE(refused({{file}, "1%", "", "", "scen"}).find("did you mean \"scene\"?"),
            std::string::npos);
  EXPECT_NE(refused({{(folder_ / "missing.json").string()}, "1%", "", "", ""}).find("missing.json"),
            std::string::npos);
}

TEST_F(Recommend, RefusesWhatIsNoWholeResult) {
  auto result = small_result(cells_);
  result["cells"][0].erase("status");
  EXPECT_NE(refused({{write(result)}, "1%", "", "", ""}).find("is not a whole result"),
            std::string::npos);
  for (const char* text : {"[]", "{\"format\": 1}", "{\"format\": \"driftless-study/1\"}"}) {
    EXPECT_NE(refused({{write(json::parse(text))}, "1%", "", "", ""}).find("is not a result"),
              std::string::npos)
        << text;
  }
}

TEST_F(Recommend, SaysWhatAnUnfinishedStudyIsMissing) {
  fs::create_directories(folder_ / "cells");
  std::ofstream(folder_ / "cells" / "a.json") << "{}";
  Plan plan{"program", "driftless run s.json", {{"first", "a.json"}, {"second", "b.json"}}, false};
  write_plan(plan, folder_);
  write(small_result(cells_));  // of an earlier study
  EXPECT_EQ(refused({{folder_.string()}, "1%", "", "", ""}),
            folder_.string() +
                ": the study there is not finished: 1 of 2 cells, the first of them second is "
                "missing; `driftless run s.json` goes on");
  plan.finished = true;
  write_plan(plan, folder_);
  EXPECT_EQ(recommend({{folder_.string()}, "1%", "", "", ""}).find("For scene"), 0U);
}

}  // namespace
}  // namespace driftless
