#include "experiments/answers.hpp"

#include <gtest/gtest.h>

#include "experiments/answer_words.hpp"
#include "tests/small_result.hpp"

namespace driftless {
namespace {

TEST(Answers, NameTheCheapestThatPassesTheNextMethodAndACheaperOneOfAnotherLimit) {
  auto result = small_result({{"a", 0.01, 4, 0.001},
                              {"a", 0.02, 2, 0.004},
                              {"a", 0.04, 1, 0.030},
                              {"b", 0.01, 3, 0.002},
                              {"c", 0.02, 1.5, 0.001, 0.001, "ok", false},
                              {"d", 0.02, 0.5, 0.001, 0.001, "unstable"}});
  add_answers(result);
  const Choice choice = cheapest_within(result, "scene", equilibrium_observable, 0.01);
  ASSERT_EQ(choice.ranked.size(), 2U);
  EXPECT_EQ(choice.ranked[0].method, "a");
  EXPECT_EQ(choice.ranked[0].time_step, 0.02);
  EXPECT_EQ(choice.ranked[1].method, "b");
  EXPECT_EQ(choice.better_inconsistent->method, "c");
  EXPECT_EQ(choice.cells_compared, 5);
  const auto text = tolerance_sentence(choice, 0.01);
  EXPECT_EQ(
      text,
      "For scene, to have temperatures and the variance of the internal energy within 1 %: a "
      "at step 0.02, 2 core-s per unit time, wrong by at most 0.64 % at 95 % confidence; next "
      "b at step 0.01, 1.5 times the cost; c at step 0.02 passes for 1.5, but its limit is not "
      "the model.");
  int found = 0;
  for (const auto& answer : result["answers"]) {
    if (answer["observable"] != "equilibrium" || answer["tolerance"] != 0.01) continue;
    ++found;
    EXPECT_EQ(answer["sentence"], text);
    EXPECT_EQ(answer["time_step"], 0.02);
    EXPECT_EQ(answer["level"], 0.95);
    EXPECT_EQ(answer["cells_compared"], 5);
    EXPECT_EQ(answer["cheaper_inconsistent"]["method"], "c");
  }
  EXPECT_EQ(found, 1);
  EXPECT_EQ(result["answers"].size(), 4 * answer_tolerances().size());
}

TEST(Answers, WithoutOneTheySayWhatCouldBeSeen) {
  auto result = small_result({{"a", 0.01, 4, 0.1}});
  add_answers(result);
  EXPECT_EQ(tolerance_sentence(cheapest_within(result, "scene", "kinetic_temperature", 0.02), 0.02),
            "For scene, to have the kinetic temperature within 2 %: no method and step of this "
            "study is shown to be; the smallest error that this study can see is 0.2 %.");
  EXPECT_EQ(
      tolerance_sentence(cheapest_within(result, "scene", "pressure", 0.02), 0.02),
      "For scene, to have the pressure within 2 %: it has no exact value there to compare with.");
}

TEST(Answers, WithinABudgetAreTheMostAccurate) {
  auto result = small_result({{"a", 0.01, 4, 0.001}, {"a", 0.02, 2, 0.004}, {"b", 0.01, 3, 0.02}});
  add_answers(result);
  const auto choice = most_accurate_within(result, "scene", equilibrium_observable, 3);
  ASSERT_EQ(choice.ranked.size(), 2U);
  EXPECT_EQ(choice.ranked[0].time_step, 0.02);
  EXPECT_EQ(
      budget_clause(choice, 3, 0.005),
      "For scene, to have temperatures and the variance of the internal energy as accurate as "
      "3 core-s per unit time allow: a at step 0.02, 2 core-s per unit time, wrong by at most "
      "0.62 % at 95 % confidence, so not shown to be within 0.5 %; next b at step 0.01, by at "
      "most 2.3 %");
  EXPECT_TRUE(most_accurate_within(result, "scene", equilibrium_observable, 1).ranked.empty());
}

TEST(Words, RoundBoundsUpAndWriteNoPowersOfTenInPercents) {
  EXPECT_EQ(bound_text("kinetic_temperature", 0.03301), "3.4 %");
  EXPECT_EQ(bound_text("kinetic_temperature", 0.02), "2 %");
  EXPECT_EQ(percent(2.7), "270 %");
  EXPECT_EQ(percent(0.996), "100 %");
  EXPECT_EQ(bound_text("energy_drift", 0.0012), "0.0012 kT/time");
}

}  // namespace
}  // namespace driftless
