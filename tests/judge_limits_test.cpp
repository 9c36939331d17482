// The examination of limits: extrapolation, a sound method and a planted fault, errors and costs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/limit_fit.hpp"
#include "experiments/judge/limit_scenes.hpp"
#include "experiments/judge/trade.hpp"
#include "experiments/judge/trade_result.hpp"
#include "tests/planted_schemes.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

// ---- Extrapolation

std::vector<LimitPoint> points(const std::function<double(double)>& value) {
  std::vector<LimitPoint> all;
  for (const double h : {0.2, 0.1, 0.05, 0.0125}) all.push_back({h, value(h), 0.01, 10});
  return all;
}

TEST(LimitAtZero, FindsThePolynomialsConstantFromTheFinestSteps) {
  const auto limit = limit_at_zero(points([](double h) { return 3 + h - 7 * h * h; }));
  ASSERT_TRUE(limit);
  EXPECT_NEAR(limit->value, 3, 1e-12);
  EXPECT_NEAR(limit->model_error, 0, 1e-12);
  EXPECT_EQ(limit->points, 4u);
}

TEST(LimitAtZero, ErrorsAndFreedomFollowTheWeights) {
  const auto limit = limit_at_zero(points([](double) { return 0.0; }));
  ASSERT_TRUE(limit);
  // Lagrange's weights at 0 of the steps 1, 1/2, 1/8: 1/7, -2/3, 32/21.
  const double a = 1.0 / 7, b = -2.0 / 3, c = 32.0 / 21;
  const double squares = a * a + b * b + c * c;
  EXPECT_NEAR(limit->error, 0.01 * std::sqrt(squares), 1e-12);
  EXPECT_NEAR(limit->degrees_of_freedom,
              10 * squares * squares / (std::pow(a, 4) + std::pow(b, 4) + std::pow(c, 4)), 1e-9);
}

TEST(LimitAtZero, APowerTooManyIsSeenByTheCoarsestStep) {
  const auto limit = limit_at_zero(points([](double h) { return 3 + h + 50 * h * h * h; }));
  ASSERT_TRUE(limit);
  const double off = std::abs(limit->value - 3);
  EXPECT_GT(off, 1e-3);
  EXPECT_NEAR(limit->model_error, off, 1e-9);
  // So is, for its better part, a power that no polynomial has.
  const auto root = limit_at_zero(points([](double h) { return 3 + h * std::sqrt(h); }));
  ASSERT_TRUE(root);
  EXPECT_GT(root->model_error, 0.2 * std::abs(root->value - 3));
}

TEST(LimitAtZero, WantsThreeStepsAndUsesTheFourFinest) {
  auto some = points([](double h) { return 1 + h; });
  some.push_back({100, 1e6, 0.01});
  const auto limit = limit_at_zero(some);
  ASSERT_TRUE(limit);
  EXPECT_NEAR(limit->value, 1, 1e-12);
  some.resize(2);
  EXPECT_FALSE(limit_at_zero(some));
  some.push_back({0.3, std::nan(""), 0.01});
  EXPECT_FALSE(limit_at_zero(some));
  some.push_back(some.front());
  EXPECT_THROW(limit_at_zero(some), std::invalid_argument);
}

// ---- The examination

/// Records of the parts whose names begin so; the others hold runs that all failed.
Records records_of(const Candidate& candidate, const Conditions& conditions,
                   const std::string& begin) {
  Records records;
  for (const auto& part : limits.parts(candidate, conditions)) {
    const bool timing = part.name.ends_with(", cost");
    if (part.name.starts_with(begin)) {
      records[part.name] = part.run();
    } else if (timing) {
      records[part.name] = {{"seconds_per_time", std::vector<double>(8, 0.0)}};
    } else {
      records[part.name] = {{"runs", 1}, {"failed", 1}, {"observables", json::object()}};
    }
  }
  return records;
}

Finding finding(const Conclusion& conclusion, const std::string& subject) {
  const auto found = std::find_if(conclusion.findings.begin(), conclusion.findings.end(),
                                  [&](const Finding& one) { return one.subject == subject; });
  if (found != conclusion.findings.end()) return *found;
  ADD_FAILURE() << "no finding about " << subject;
  return {};
}

const std::string pairs_20 =
    "isolated pairs, friction closure, inverse-temperature form of conduction, phi/k = 20";
const std::string fluid_100 = "ideal fluid, noise closure, with conduction, phi/k = 100";

// Euler-Maruyama for frozen pairs, with and without the noise-induced friction: without, the
// temperature ratio is off by k/2 phi = 2.5 %, many times what can be seen.
template <bool right>
Candidate planted() {
  static const std::string name = right ? "limits-right" : "limits-without-induced-friction";
  if (!find_method(name)) {
    Method method;
    method.name = name;
    method.closures = {FrictionClosure::friction};
    method.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<two_body::Scheme>(two_body::with_friction([](auto& law) {
        if (!right) law.induced = 0;
      }));
    };
    register_method(method);
  }
  return {{name, {}}};
}

// All that holds would fail with a probability of 6e-7 by chance, were its error exactly known.
TEST(Limits, ASoundSchemeHoldsInIsolatedPairs) {
  const auto candidate = planted<true>();
  const auto conclusion = limits.conclude(candidate, {}, records_of(candidate, {}, pairs_20));
  for (const auto& observable : limit_observables(Family::pairs)) {
    const auto found = finding(conclusion, observable.words + ", " + pairs_20);
    EXPECT_EQ(found.verdict, Verdict::holds) << found.sentence;
    EXPECT_EQ(found.claimed, true);
  }
  // What could not be run is not resolved, what is refused has no meaning.
  const auto unseen = finding(
      conclusion, "every observable, ideal fluid, friction closure, with conduction, phi/k = 100");
  EXPECT_EQ(unseen.verdict, Verdict::not_resolved);
  EXPECT_NE(unseen.sentence.find("1 of 1 runs failed"), std::string::npos) << unseen.sentence;
  EXPECT_EQ(finding(conclusion, "noise closure").verdict, Verdict::not_applicable);
}

TEST(Limits, AForgottenNoiseInducedFrictionFails) {
  const auto candidate = planted<false>();
  const auto conclusion = limits.conclude(candidate, {}, records_of(candidate, {}, pairs_20));
  const auto found = finding(conclusion, "the kinetic temperature, " + pairs_20);
  EXPECT_EQ(found.verdict, Verdict::fails) << found.sentence;
  EXPECT_TRUE(found.contradicts_claim());
  ASSERT_TRUE(found.value);
  EXPECT_NEAR(*found.value, 0.025, 0.01);
  EXPECT_EQ(overall(conclusion), Verdict::fails);
}

TEST(Limits, PartsAreFunctionsOfTheirNames) {
  const auto candidate = Candidate{{"shardlow-s1", {}}};
  const auto part_of = [&](const std::string& name) {
    const auto all = limits.parts(candidate, {});
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Part& part) { return part.name == name; });
    return found == all.end() ? Part{} : *found;
  };
  const auto coarse = part_of(fluid_100 + ", step 0.8, block 1");
  ASSERT_TRUE(coarse.run);
  const auto record = coarse.run();
  EXPECT_EQ(record, part_of(coarse.name).run());
  for (const auto& observable : limit_observables(Family::conducting)) {
    EXPECT_TRUE(record["observables"].contains(observable.name)) << observable.name;
  }
  EXPECT_GT(coarse.cost, 0);
}

// ---- Error against cost

json method_with(const std::string& name, std::vector<std::array<double, 4>> rows) {
  Table table = empty_trade_table();
  for (const auto& [cost, error, lower, upper] : rows) {
    table.rows.push_back({std::string("a"), std::string("b"), 0.1, cost, error, lower, upper});
  }
  Conclusion conclusion;
  conclusion.tables.push_back(table);
  return {{"name", name}, {"conclusions", {{"limits", to_json(conclusion)}}}};
}

TEST(Trade, TheFrontIsOfAllMethodsByTheirUpperBounds) {
  const json judgement = {{"methods",
                           {method_with("one", {{1, 0.3, 0.2, 0.4}, {4, 0.1, 0.05, 0.15}}),
                            method_with("two", {{2, 0.1, 0, 0.2}, {3, 0.5, 0.4, 0.6}})}}};
  const auto trade = trade_front(judgement);
  ASSERT_EQ(trade.size(), 1u);
  EXPECT_EQ(trade[0]["scene"], "a");
  EXPECT_EQ(trade[0]["observable"], "b");
  std::vector<std::string> seen;
  for (const auto& point : trade[0]["points"]) {
    seen.push_back(point["method"].get<std::string>() + (point["on_front"] ? " front" : "") +
                   (point["dominated"] ? " dominated" : ""));
  }
  EXPECT_EQ(seen,
            (std::vector<std::string>{"one front", "two front", "two dominated", "one front"}));
}

// As a result the same points are cells, whose bounds hold for all of them at once.
TEST(Trade, IsAnsweredFromLikeAResult) {
  json judgement = {{"methods",
                     {method_with("sure", {{1, 0.3, 0.2, 0.4}, {4, 0.1, 0.05, 0.15}}),
                      method_with("wrong", {{2, 0.1, 0, 0.2}, {3, 0.5, 0.4, 0.6}}),
                      method_with("other", {{9, 0.1, 0, 0.2}})}}};
  judgement["trade"] = trade_front(judgement);
  const auto find = [&](std::size_t method, const char* verdict, bool claimed, const char* scene) {
    judgement["methods"][method]["conclusions"]["limits"]["findings"] = {
        {{"subject", std::string("the b, ") + scene}, {"verdict", verdict}, {"claimed", claimed}}};
  };
  find(0, "fails", false, "another");
  find(1, "fails", true, "a");
  find(2, "not_resolved", false, "a");
  const json result = trade_as_result(judgement);
  EXPECT_EQ(result["scenes"], (json{{{"name", "a"}}}));
  // Both steps of a method of the test are 0.1: one cell.
  ASSERT_EQ(result["cells"].size(), 3U);
  const auto& cells = result["cells"];
  EXPECT_EQ(cells[0]["method"], "sure");
  EXPECT_EQ(cells[0]["consistent"], true);
  EXPECT_EQ(cells[1]["consistent"], false);
  EXPECT_EQ(cells[2]["consistent"], false);
  EXPECT_EQ(cells[2]["cost"]["core_seconds_per_time"], 9);
  // One of five cells may fail with 1 %.
  const double widening = 2.3263479 / 1.9599640;
  const auto& deviation = cells[2]["observables"]["b"]["deviation"];
  EXPECT_NEAR(deviation["bound"].get<double>(), 0.1 + widening * 0.1, 1e-6);
  EXPECT_NEAR(deviation["resolution"].get<double>(), widening * 0.1, 1e-6);
}

TEST(Trade, OfADistanceIsBoundedByItsSquare) {
  json judgement = {{"methods", {method_with("one", {{1, 0.3, 0.2, 0.5}})}}};
  judgement["trade"] = trade_front(judgement);
  judgement["trade"][0]["observable"] = "momentum_distance";
  // One cell alone: its bound is the end of its interval.
  const json result = trade_as_result(judgement);
  const auto& deviation = result["cells"][0]["observables"]["momentum_distance"]["deviation"];
  EXPECT_NEAR(deviation["bound"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(deviation["resolution"].get<double>(), 0.4, 1e-12);
}

}  // namespace
}  // namespace driftless::judge
