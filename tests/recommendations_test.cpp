// How often a recommendation is false: studies whose truth is known, put to the rule of answers.
// Every statistical statement has a false-alarm rate of at most 1e-8; the seeds are fixed.

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <optional>
#include <random>

#include "experiments/answers.hpp"
#include "experiments/deviations.hpp"
#include "experiments/statistics.hpp"
#include "tests/small_result.hpp"

namespace driftless {
namespace {

using nlohmann::json;

const std::string observable = "kinetic_temperature";

/// True if so many happen with at most the false-alarm rate when each has `probability`.
bool too_many(int count, int trials, double probability) {
  const boost::math::binomial law(trials, probability);
  return count > 0 && boost::math::cdf(boost::math::complement(law, count - 1)) < 1e-8;
}

enum class Rule {
  as_it_is,
  single_errors,     ///< errors are not pooled
  choice_forgotten,  ///< errors are pooled, but each bound is the cell's own interval's end
  own_intervals,     ///< neither: the end of each cell's own 95 % interval, as it was once
};

/// Every method at every step but one is just beyond the tolerance; the right one costs most.
struct Family {
  int methods = 6, steps = 4;
  double tolerance = 8;     ///< in true standard errors of a cell
  double widened = 1;       ///< true error of every sixth cell, in those of the others
  bool same_noise = false;  ///< methods repeat each other's noise
};

struct Noise {
  double value;    ///< of the mean, in its true standard error
  Estimate found;  ///< its error in the same unit
};

/// Four replicas of 20 autocorrelation times each.
Noise draw_noise(std::mt19937_64& random) {
  constexpr int samples = 100, replicas = 4;
  constexpr double time = 5, rho = (2 * time - 1) / (2 * time + 1);
  std::normal_distribution<double> normal;
  std::vector<Eigen::VectorXd> runs(replicas, Eigen::VectorXd(samples));
  for (auto& run : runs) {
    double value = normal(random);
    for (double& sample : run) {
      sample = value;
      value = rho * value + std::sqrt(1 - rho * rho) * normal(random);
    }
  }
  const double true_error = std::sqrt(2 * time / (samples * replicas));
  Estimate found = estimate_mean(runs);
  found.error /= true_error;
  return {found.mean / true_error, found};
}

/// Drawing takes the time: each cell takes one of these.
const std::vector<Noise>& drawn_noise() {
  static const std::vector<Noise> all = [] {
    std::mt19937_64 random(7);
    std::vector<Noise> drawn;
    for (int n = 0; n < 12000; ++n) drawn.push_back(draw_noise(random));
    return drawn;
  }();
  return all;
}

constexpr double right_cost = 2;

json make_study(const Family& family, Rule rule, std::mt19937_64& random) {
  json result = {{"scenes", {{{"name", "scene"}}}}, {"cells", json::array()}};
  const int cells = family.methods * family.steps;
  std::vector<const Noise*> of_step(static_cast<std::size_t>(family.steps));
  for (int n = 0; n < cells; ++n) {
    const int step = n % family.steps;
    const bool is_right = n + 1 == cells;
    auto& noise = of_step[static_cast<std::size_t>(step)];
    if (noise == nullptr || !family.same_noise) {
      noise = &drawn_noise()[random() % drawn_noise().size()];
    }
    const double wider = n % 6 == 0 ? family.widened : 1;
    const double off = is_right ? 0 : 1.0001 * family.tolerance;
    json entry = small_observable(off + wider * noise->value, wider * noise->found.error);
    entry["degrees_of_freedom"] = noise->found.degrees_of_freedom;
    entry["replicas_disagree"] = rule == Rule::single_errors || noise->found.replicas_disagree;
    json cell = small_cell("scene", {"m" + std::to_string(n / family.steps), 0.01 * (step + 1),
                                     is_right ? right_cost : 1 + 0.01 * n});
    cell["observables"] = {{observable, entry}};
    result["cells"].push_back(cell);
  }
  return result;
}

/// Gives every cell a bound by a rule.
void add_bounds(json& result, Rule rule) {
  add_deviations(result);
  for (auto& cell : result["cells"]) {
    auto& entry = cell["observables"][observable];
    auto& deviation = entry["deviation"];
    if (rule == Rule::choice_forgotten) deviation["bound"] = deviation["upper"];
    if (rule == Rule::own_intervals) {
      deviation["bound"] =
          deviation["value"].get<double>() + interval_quantile * entry["error"].get<double>();
    }
  }
}

struct Verdicts {
  int wrong = 0, right = 0;  ///< studies that recommended a wrong, the right cell
};

Verdicts judge(const Family& family, Rule rule, int trials) {
  std::mt19937_64 random(2024);
  Verdicts verdicts;
  for (int trial = 0; trial < trials; ++trial) {
    json result = make_study(family, rule, random);
    add_bounds(result, rule);
    const auto choice = cheapest_within(result, "scene", observable, family.tolerance);
    if (choice.ranked.empty()) continue;
    ++(choice.ranked[0].cost == right_cost ? verdicts.right : verdicts.wrong);
  }
  return verdicts;
}

constexpr int studies = 1500;

TEST(Recommendations, AreFalseInNoMoreThanAStudyInTwenty) {
  const auto verdicts = judge({}, Rule::as_it_is, studies);
  EXPECT_FALSE(too_many(verdicts.wrong, studies, 0.05)) << verdicts.wrong;
  // And not by never saying anything: the right cell is found in nine studies of ten.
  EXPECT_FALSE(too_many(studies - verdicts.right, studies, 0.1)) << verdicts.right;
}

TEST(Recommendations, AreNotFalserWhereSomeCellsAreNoisierThanTheOthers) {
  Family family;
  family.widened = 2;
  const auto verdicts = judge(family, Rule::as_it_is, studies);
  EXPECT_FALSE(too_many(verdicts.wrong, studies, 0.05)) << verdicts.wrong;
}

TEST(Recommendations, AreNotFalserWhereMethodsSeeTheSameNoise) {
  Family family;
  family.same_noise = true;
  const auto verdicts = judge(family, Rule::as_it_is, studies);
  EXPECT_FALSE(too_many(verdicts.wrong, studies, 0.05)) << verdicts.wrong;
}

TEST(Recommendations, AreNotFalserInAStudyOfTwoMethodsAndTwoSteps) {
  Family family;
  family.methods = family.steps = 2;
  const auto verdicts = judge(family, Rule::as_it_is, studies);
  EXPECT_FALSE(too_many(verdicts.wrong, studies, 0.05)) << verdicts.wrong;
}

TEST(Recommendations, ByRulesThatForgetTheChoiceAreCaught) {
  for (const Rule rule : {Rule::own_intervals, Rule::choice_forgotten}) {
    const auto verdicts = judge({}, rule, studies);
    EXPECT_TRUE(too_many(verdicts.wrong, studies, 0.05)) << verdicts.wrong;
  }
}

TEST(Recommendations, ArePossibleWherePooledErrorsAreKnownBetterThanSingleOnes) {
  // At 5 true errors: shared among 24 cells, an error that is known by itself reaches too far.
  Family family;
  family.tolerance = 5;
  const auto pooled = judge(family, Rule::as_it_is, studies);
  EXPECT_FALSE(too_many(pooled.wrong, studies, 0.05)) << pooled.wrong;
  EXPECT_FALSE(too_many(studies - pooled.right, studies, 0.3)) << pooled.right;
  const auto single = judge(family, Rule::single_errors, studies);
  EXPECT_TRUE(too_many(studies - single.right, studies, 0.3)) << single.right;
}

}  // namespace
}  // namespace driftless
