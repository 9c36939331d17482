#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/moving_frame.hpp"
#include "experiments/statistics.hpp"

/// The examination of Galilean invariance sees what a moving frame changes, how much it is and
/// whether it vanishes with the step.
namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr unsigned runs = 16;

/// A sound scheme after which every particle gains energy as its velocity squared, as friction
/// against the box would give it: u += 1e-4 dt^order v^2.
template <int order>
class FeelsTheFrame : public Integrator {
 public:
  void step(System& system, double dt) override {
    sound_->step(system, dt);
    const double gain = 1e-4 * std::pow(dt, order);
    system.update([&](std::size_t, Vector& v, double& u) { u += gain * v.squaredNorm(); });
  }

 private:
  std::unique_ptr<Integrator> sound_ = find_method("shardlow-s1")->make({});
};

template <int order>
Candidate planted() {
  static const std::string name = "feels-the-frame-" + std::to_string(order);
  if (!find_method(name)) {
    Method method = *find_method("shardlow-s1");
    method.name = name;
    method.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<FeelsTheFrame<order>>();
    };
    register_method(method);
  }
  return {{name, {}}};
}

/// Averages of 16 runs, alike in every frame but for what is theirs alone; in frames the kinetic
/// temperature is `kinetic` times as large.
json averages_of(double speed, double kinetic) {
  json record = {{"speed", speed}, {"time_step", 0.02}, {"runs", runs}, {"failed", 0}};
  for (unsigned run = 0; run < runs; ++run) {
    const double own = 0.01 * std::cos(speed + run), drifted = 1 + 0.1 * run;
    record["kinetic_temperature"].push_back(drifted * (speed > 0 ? kinetic : 1) + own);
    record["internal_temperature"].push_back(drifted + own);
    record["internal_energy_variance"].push_back(drifted + own);
  }
  return record;
}

/// All parts are run but for the long averages, which are given.
Conclusion examined(const Candidate& candidate, double kinetic = 1) {
  Records records;
  for (const auto& part : galilean.parts(candidate, {})) {
    const std::string beginning = "averages at ";
    if (part.name.rfind(beginning, 0) == 0) {
      records[part.name] = averages_of(std::stod(part.name.substr(beginning.size())), kinetic);
    } else {
      records[part.name] = part.run();
    }
  }
  return galilean.conclude(candidate, {}, records);
}

const Finding& finding(const Conclusion& conclusion, std::string_view subject) {
  return *std::find_if(conclusion.findings.begin(), conclusion.findings.end(),
                       [&](const Finding& one) { return one.subject == subject; });
}

TEST(GalileanExamined, OfASoundMethodHolds) {
  const auto conclusion = examined({{"shardlow-s2", {}}});
  ASSERT_EQ(conclusion.findings.size(), 15U);
  for (const auto& one : conclusion.findings) {
    EXPECT_EQ(one.verdict, Verdict::holds) << one.sentence;
    EXPECT_TRUE(one.claimed.value());
  }
}

/// Per unit time particles gain 1e-4 V^2 of (phi + k) T = 61, at 10 thermal velocities 1.6e-4; what
/// their own velocities add is less than half a thousandth of that in the mean.
TEST(GalileanExamined, AViolationHasItsRateAndDoesNotVanish) {
  const auto conclusion = examined(planted<1>());
  for (const char* speed : {"1 thermal velocity", "5 thermal velocities"}) {
    EXPECT_TRUE(finding(conclusion, "the same noise at " + std::string(speed)).contradicts_claim());
  }
  const auto& rate =
      finding(conclusion, "rate of change of the internal temperature at 10 thermal velocities");
  EXPECT_TRUE(rate.contradicts_claim());
  EXPECT_NEAR(rate.value.value(), 1e-2 / 60, 2e-5);
  EXPECT_NE(rate.sentence.find("does not vanish"), std::string::npos) << rate.sentence;
}

TEST(GalileanExamined, AViolationThatVanishesIsSaidTo) {
  const auto& conclusion = examined(planted<2>());
  const auto& rate =
      finding(conclusion, "rate of change of the internal temperature at 10 thermal velocities");
  EXPECT_TRUE(rate.contradicts_claim());
  EXPECT_NE(rate.sentence.find("of order 1.0"), std::string::npos) << rate.sentence;
  EXPECT_EQ(rate.sentence.find("does not vanish"), std::string::npos) << rate.sentence;
}

TEST(GalileanExamined, LongAveragesFailBeyondFiveErrors) {
  const char* subject = "kinetic temperature at 5 thermal velocities, step 0.02";
  const Candidate sound{{"shardlow-s1", {}}};
  EXPECT_EQ(finding(examined(sound, 1.002), subject).verdict, Verdict::holds);
  EXPECT_EQ(finding(examined(sound, 1.04), subject).verdict, Verdict::fails);
}

/// A method that is refused nothing and whose runs break has findings, no exception.
class Breaking : public Integrator {
 public:
  void step(System&, double) override {
    throw StepFailure(FailureCause::negative_internal_energy, {});
  }
};

TEST(GalileanExamined, RunsThatBreakAreFindings) {
  Method method = *find_method("shardlow-s1");
  method.name = "breaks";
  method.make = [](const Options&) -> std::unique_ptr<Integrator> {
    return std::make_unique<Breaking>();
  };
  register_method(method);
  const auto conclusion = examined({{"breaks", {}}});
  const auto& short_path = finding(conclusion, "the same noise at 1 thermal velocity");
  EXPECT_EQ(short_path.verdict, Verdict::fails);
  EXPECT_NE(short_path.sentence.find("negative internal energy"), std::string::npos);
  const auto& rate =
      finding(conclusion, "rate of change of the internal temperature at 1 thermal velocity");
  EXPECT_EQ(rate.verdict, Verdict::not_resolved);
}

/// At the exact law of the isolated fluid; false alarms by Student's law: 1e-8.
TEST(FrameAverages, AreThoseOfTheExactLaw) {
  const auto& scene = prepared_once(small_fluid_scene(60, FrictionClosure::noise, false), 5, runs);
  const auto found = frame_averages({{"shardlow-s2", {}}}, scene, runs, 5, 0.02, 4);
  const double beyond = student_quantile(runs - 1, 0.5e-8);
  const auto check = [&](const char* key, double exact, double resolution) {
    double mean = 0, squares = 0;
    for (const auto& value : found[key]) mean += value.get<double>() / runs;
    for (const auto& value : found[key]) squares += std::pow(value.get<double>() - mean, 2);
    const double error = std::sqrt(squares / (runs * (runs - 1)));
    EXPECT_LT(std::abs(mean - exact), beyond * error) << key;
    EXPECT_LT(beyond * error, resolution * exact) << key;
  };
  const auto& law = scene.law().value();
  const double e = scene.island_energy();
  check("kinetic_temperature", law.kinetic_temperature(e), 0.1);
  check("internal_temperature", law.internal_temperature(e), 0.01);
  check("internal_energy_variance", law.internal_energy_variance(e), 0.4);
}

TEST(ZeroFinding, AsksForMoreErrorsWhereAnErrorIsPoorlyKnown) {
  EXPECT_EQ(zero_finding("", 6, 1, 100).verdict, Verdict::fails);
  EXPECT_EQ(zero_finding("", 6, 1, 100, 1000).verdict, Verdict::fails);
  EXPECT_EQ(zero_finding("", 6, 1, 100, 3).verdict, Verdict::not_resolved);
  EXPECT_EQ(zero_finding("", 6, 1, 1000, 3).verdict, Verdict::holds);
  EXPECT_NEAR(zero_finding("", 0, 1, 1).resolution.value(), 5, 1e-9);
  EXPECT_NEAR(zero_finding("", 0, 1, 1, 10).upper.value(), 2.228, 1e-3);
}

}  // namespace
}  // namespace driftless::judge
