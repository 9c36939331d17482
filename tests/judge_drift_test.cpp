#include <gtest/gtest.h>

#include <cmath>

#include "experiments/judge/drift_prediction.hpp"
#include "experiments/judge/examinations.hpp"
#include "tests/small_system.hpp"

/// The law of the energy drift: what is predicted, and what is concluded from records.
namespace driftless::judge {
namespace {

using nlohmann::json;
using testing::Terms;

System small_soft_system() {
  auto parameters = testing::small_fluid({FrictionClosure::noise, HeatForm::none, true}, 1);
  return {Fluid(parameters), testing::small_box(), testing::small_state(parameters), Noise(3, 0)};
}

/// (Psi'' v)_k by central differences of the forces along v.
std::vector<Vector> curvature_times(const System& system, const std::vector<Vector>& velocity) {
  const double reach = 1e-5;
  const auto forces_at = [&](double along) {
    State state = system.state();
    for (std::size_t i = 0; i < state.size(); ++i) {
      state.position[i] = system.box().wrap(state.position[i] + along * velocity[i]);
    }
    System moved(system.fluid(), system.box(), state, Noise(1, 0));
    return moved.conservative_force();
  };
  const auto ahead = forces_at(reach), behind = forces_at(-reach);
  std::vector<Vector> product;
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    product.push_back(-(ahead[i] - behind[i]) / (2 * reach));
  }
  return product;
}

TEST(JudgeDrift, PredictionIsTheAverageOverVelocitiesOfTheShadowWork) {
  System system = small_soft_system();
  const auto& fluid = system.fluid().parameters();
  // A linear function of v: its mean square over Maxwell's law is the sum over basis vectors.
  double sum = 0;
  for (std::size_t k = 0; k < system.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Vector> unit(system.size(), Vector::Zero());
      unit[k] = Vector::Unit(axis);
      const auto product = curvature_times(system, unit);
      system.for_each_pair([&](const System::Geometry& pair) {
        const double change = pair.e.dot(product[pair.i] - product[pair.j]) / (6 * fluid.mass);
        sum += fluid.friction * pair.w_friction * change * change / fluid.mass;
      });
    }
  }
  const auto predicted = predicted_drift(system);
  EXPECT_NEAR(predicted.kick_move_kick, sum / static_cast<double>(system.size()), 1e-4 * sum);
  EXPECT_DOUBLE_EQ(predicted.move_kick_move, predicted.kick_move_kick / 4);
}

/// Records as of runs that drift by `drift_of(heat capacity, friction, step)`, known to 2 %.
Records records_of(const Candidate& candidate, double (*drift_of)(double, double, double)) {
  Records records;
  for (const auto& part : drift.parts(candidate, {})) {
    double capacity = 0, friction = 0, step = 0;
    EXPECT_EQ(std::sscanf(part.name.c_str(), "phi/k %lf, friction %lf, step %lf", &capacity,
                          &friction, &step),
              3);
    const double value = drift_of(capacity, friction, step);
    const double error = 0.02 * std::abs(value), walk = 2 * value;
    records[part.name] = {{"failures", json::array()},
                          {"drift", value},
                          {"error", error},
                          {"walk", {walk, 0.95 * walk, 1.05 * walk}},
                          {"kick_move_kick", 100 * friction * std::pow(step, 4)},
                          {"move_kick_move", 25 * friction * std::pow(step, 4)}};
  }
  return records;
}

Verdict verdict_on(const std::string& subject, double (*drift_of)(double, double, double)) {
  const Candidate candidate{{"metropolized-splitting", {}}};
  const auto conclusion = drift.conclude(candidate, {}, records_of(candidate, drift_of));
  for (const auto& finding : conclusion.findings) {
    if (finding.subject.starts_with(subject)) return finding.verdict;
  }
  ADD_FAILURE() << "no finding of " << subject;
  return Verdict::not_applicable;
}

double by_theory(double, double friction, double step) {
  return 100 * friction * std::pow(step, 4);
}
double of_second_order(double, double friction, double step) { return friction * step * step; }
double of_roots(double, double friction, double step) {
  return 100 * std::sqrt(friction) * std::pow(step, 4);
}
double downhill(double, double friction, double step) { return -by_theory(0, friction, step); }
double biased(double capacity, double friction, double step) {
  return friction * (100 * std::pow(step, 4) + 100 * std::pow(step, 3) / capacity);
}

TEST(JudgeDrift, DriftsByTheoryHoldAndOthersFail) {
  for (const char* subject :
       {"sign", "power of the step, phi/k = 60", "variance", "term of third order"}) {
    EXPECT_EQ(verdict_on(subject, by_theory), Verdict::holds) << subject;
  }
  EXPECT_EQ(verdict_on("power of the step, phi/k = 60", of_second_order), Verdict::fails);
  // The friction is not weak: no method is held to proportion.
  EXPECT_EQ(verdict_on("power of the friction", of_roots), Verdict::reported);
  EXPECT_EQ(verdict_on("sign", downhill), Verdict::fails);
  EXPECT_EQ(verdict_on("term of third order", biased), Verdict::fails);
}

TEST(JudgeDrift, APowerThatCouldBeTheNextOneIsNotResolved) {
  const Candidate candidate{{"metropolized-splitting", {}}};
  auto records = records_of(candidate, by_theory);
  const auto power = [&] { return drift.conclude(candidate, {}, records).findings[1]; };
  EXPECT_EQ(power().verdict, Verdict::holds);
  for (auto& [name, record] : records) record["error"] = 0.15 * record["drift"].get<double>();
  ASSERT_EQ(power().subject, "power of the step, phi/k = 60");
  EXPECT_GT(power().resolution.value_or(0), 1);
  EXPECT_EQ(power().verdict, Verdict::not_resolved);
}

// Where the usual steps break, the brief ones tell.
TEST(JudgeDrift, HeatingIsSeenAtSmallSteps) {
  const Candidate candidate{{"averaged-drift", {}}};
  Records records;
  for (const auto& part : drift.parts(candidate, {})) {
    records[part.name] = {{"failures", json::array({"energy ran away"})}};
    double step = 0;
    std::sscanf(part.name.c_str(), "phi/k 60, friction 4.5, step %lf", &step);
    if (step == 0 || step > 0.01) continue;
    records[part.name].update({{"drift", 200 * step},
                               {"error", 0.1 * step},
                               {"walk", {1, 0, 2}},
                               {"kick_move_kick", 1e-6},
                               {"move_kick_move", 1e-6}});
  }
  for (const auto& finding : drift.conclude(candidate, {}, records).findings) {
    if (finding.subject != "drift at small steps") continue;
    EXPECT_EQ(
        finding.sentence,
        "In brief runs at step 0.0025 the energy rises by 0.5 (0.5 to 0.5) kT per particle and "
        "unit of time, with the power 1.00 (1.00 to 1.00) of the step.");
    return;
  }
  ADD_FAILURE() << "no such finding";
}

TEST(JudgeDrift, WhereEveryRunBreaksThatIsSaid) {
  const Candidate candidate{{"averaged-drift", {}}};
  Records records;
  for (const auto& part : drift.parts(candidate, {})) {
    records[part.name] = {{"failures", {"energy ran away"}}};
  }
  const auto conclusion = drift.conclude(candidate, {}, records);
  EXPECT_EQ(overall(conclusion), Verdict::not_resolved);
  EXPECT_EQ(conclusion.findings.size(), records.size() + 1);
  EXPECT_NE(conclusion.findings.back().sentence.find("energy ran away"), std::string::npos);
}

TEST(JudgeDrift, MethodsThatKeepEnergyHaveNothingToMeasure) {
  const Candidate exact{{"isoenergetic-verlet", {}}};
  EXPECT_TRUE(drift.parts(exact, {}).empty());
  EXPECT_EQ(overall(drift.conclude(exact, {}, {})), Verdict::not_applicable);
}

}  // namespace
}  // namespace driftless::judge
