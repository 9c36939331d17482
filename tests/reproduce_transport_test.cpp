// Experiments on transport: what they conclude from records, and a method that spoils transport.

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/reproduce/estimates.hpp"
#include "experiments/reproduce/experiments.hpp"
#include "experiments/transport/method_cells.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

const Conditions quick{Effort::quick, 1};

json estimate(double value, double error) {
  Estimate one;
  one.mean = value, one.error = error, one.degrees_of_freedom = 5;
  return to_json(one);
}

const Row* row_of(const Outcome& outcome, const std::string& quantity, const std::string& setting) {
  for (const auto& row : outcome.rows) {
    if (row.quantity == quantity && row.setting == setting) return &row;
  }
  return nullptr;
}

/// Records in which every method finds the same coefficients at every step.
Records sound_records() {
  Records records;
  unsigned number = 0;
  for (const auto& part : methods_transport.parts(quick)) {
    if (part.name.starts_with("sound")) {
      records[part.name] = estimate(0.745, 0.002);
      continue;
    }
    // Off by less than an error, this way and that.
    const double off = 1 + 0.004 * std::sin(++number);
    records[part.name] = {{"runs", 6},
                          {"failed", 0},
                          {"diffusion", estimate(2 * off, 0.02)},
                          {"viscosity", estimate(0.5 * off, 0.005)},
                          {"conductivity", estimate(40 * off, 0.4)},
                          {"sound speed", estimate(0.7 * off, 0.007)},
                          {"kinetic temperature", estimate(1.1, 0.005)}};
  }
  return records;
}

TEST(MethodsTransport, HasAPartForEveryMethodAndStep) {
  std::size_t expected = 2;
  for (const auto& scene :
       {transport::ideal_transport_scene(1), transport::soft_transport_scene(1)}) {
    for (const Method* method : methods()) {
      expected += refusal(*method, Fluid(scene.fluid)) ? 0 : scene.time_steps.size();
    }
  }
  EXPECT_EQ(methods_transport.parts(quick).size(), expected);
}

TEST(MethodsTransport, AgreementIsSaid) {
  const auto outcome = methods_transport.conclude(quick, sound_records());
  for (const auto& row : outcome.rows) {
    if (!row.setting.starts_with("soft fluid, ") || row.quantity == "sound speed") continue;
    if (row.setting.ends_with("limit of small steps")) continue;
    EXPECT_EQ(row.verdict, Verdict::agrees) << row.quantity << ", " << row.setting;
    EXPECT_NE(row.explanation.find("kinetic temperature"), std::string::npos);
  }
  EXPECT_EQ(outcome.pictures.size(), 8u);
}

TEST(MethodsTransport, ASpoiledCoefficientShowsWhereTheTemperatureIsKept) {
  auto records = sound_records();
  const std::string cell = "soft fluid, lowe-andersen, step 0.01";
  ASSERT_TRUE(records.contains(cell));
  records[cell]["diffusion"] = estimate(2.4, 0.02);
  const auto outcome = methods_transport.conclude(quick, records);
  const Row* spoiled = row_of(outcome, "diffusion", cell);
  ASSERT_TRUE(spoiled);
  EXPECT_EQ(spoiled->verdict, Verdict::differs);
  EXPECT_EQ(spoiled->explanation.substr(0, 3), "+20") << spoiled->explanation;
  // Nor does it move the reference of the others.
  EXPECT_EQ(row_of(outcome, "diffusion", "soft fluid, shardlow-s1, step 0.01")->verdict,
            Verdict::agrees);
  EXPECT_EQ(row_of(outcome, "viscosity", cell)->verdict, Verdict::agrees);
}

TEST(MethodsTransport, AConsistentMethodFarOffIsLeftOutOfTheReference) {
  auto records = sound_records();
  for (auto& [name, record] : records) {
    if (name.starts_with("soft fluid, peters")) record["viscosity"] = estimate(0.8, 0.002);
  }
  const auto outcome = methods_transport.conclude(quick, records);
  const Row* pooled = row_of(outcome, "viscosity", "soft fluid, limit of small steps");
  ASSERT_TRUE(pooled);
  EXPECT_NEAR(pooled->ours.value, 0.5, 0.01);
  EXPECT_NE(pooled->explanation.find("peters"), std::string::npos);
}

TEST(MethodsTransport, RunsThatBreakAreToldWithTheirCause) {
  auto records = sound_records();
  const std::string cell = "ideal fluid, averaged-drift, step 0.04";
  records[cell] = {{"runs", 6},
                   {"failed", 6},
                   {"cause", "negative internal energy"},
                   {"diffusion", json::object()}};
  const auto outcome = methods_transport.conclude(quick, records);
  const Row* broken = row_of(outcome, "diffusion", cell);
  ASSERT_TRUE(broken);
  EXPECT_EQ(broken->verdict, Verdict::not_resolved);
  EXPECT_EQ(broken->explanation, "6 of 6 runs failed: negative internal energy");
}

// ---- A cell of its own, small

transport::TransportScene small_scene() {
  auto scene = transport::ideal_transport_scene(1);
  scene.cube_side = 5;
  scene.particle_window = 24, scene.particle_windows = 1;
  scene.heat_window = 10, scene.heat_impositions = 2;
  scene.flow_length = 8, scene.flow_width = 4;
  scene.flow_window = 16, scene.flow_impositions = 2;
  scene.replicas = 8;
  return scene;
}

/// A sound method whose time runs at half of the speed: it keeps every average at equilibrium.
class HalfSpeed : public Integrator {
 public:
  void step(System& system, double dt) override { inner_->step(system, 0.5 * dt); }

 private:
  std::unique_ptr<Integrator> inner_ = find_method("metropolized-splitting")->make({});
};

TEST(MethodCells, AMethodThatKeepsTemperatureAndSpoilsTransportIsSeen) {
  Method slow;
  slow.name = "transport-half-speed";
  slow.closures = {FrictionClosure::noise, FrictionClosure::friction};
  slow.make = [](const Options&) -> std::unique_ptr<Integrator> {
    return std::make_unique<HalfSpeed>();
  };
  register_method(slow);
  const auto scene = small_scene();
  const auto right = transport::measure_method(scene, {"metropolized-splitting", {}}, 0.08, 3);
  const auto wrong = transport::measure_method(scene, {"transport-half-speed", {}}, 0.08, 3);
  EXPECT_EQ(right["failed"], 0);
  const auto fast = read_estimate(right["diffusion"]), spoiled = read_estimate(wrong["diffusion"]);
  ASSERT_TRUE(fast && spoiled);
  // Student's law of seven degrees of freedom each: 7 of these errors are 8 of the plain ones.
  EXPECT_GT(fast->mean - spoiled->mean, 7 * std::hypot(fast->error, spoiled->error));
  const auto one = read_estimate(right["kinetic temperature"]);
  const auto other = read_estimate(wrong["kinetic temperature"]);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->mean / scene.fluid.temperature, 1, 0.05);
  EXPECT_NEAR(other->mean / scene.fluid.temperature, 1, 0.05);
}

TEST(MethodCells, AFailureIsCountedWithItsCause) {
  auto scene = small_scene();
  scene.replicas = 2;
  // Euler's conduction is far beyond its stability.
  const auto record = transport::measure_method(scene, {"averaged-drift", {}}, 2, 3);
  EXPECT_EQ(record["failed"], 2);
  EXPECT_FALSE(record["cause"].get<std::string>().empty());
  EXPECT_FALSE(read_estimate(record["diffusion"]));
}

// ---- The experiments of Avalos and Mackie

TEST(AvalosMackieConductivity, SaysHalfAndFollows) {
  Records records;
  const double theory = 2 * std::acos(-1.0) / 315 * 200;
  records["wave, n = 8, X = 200"] = estimate(0.5 * theory, 0.02);
  records["wave, n = 100, X = 200"] = estimate(0.5 * theory, 0.02);
  const auto outcome = avalos_mackie_1999_conductivity.conclude(quick, records);
  const std::string quantity = "conductivity over the theory of long waves, 2 pi X/315";
  EXPECT_EQ(row_of(outcome, quantity, "n = 8, X = 200, wavelength 10")->verdict, Verdict::agrees);
  EXPECT_EQ(row_of(outcome, quantity, "n = 100, X = 200, wavelength 10")->verdict,
            Verdict::differs);
}

TEST(AvalosMackieViscosity, FindsTheWavelengthOfAValue) {
  Records records;
  for (const double wavelength : {4, 5, 6, 10, 20}) {
    records["r* = 1.24, wavelength " + std::to_string(static_cast<int>(wavelength))] =
        estimate(0.0726 * wavelength, 0.001);
  }
  const auto outcome = avalos_mackie_1999_viscosity.conclude(quick, records);
  const Row* row = row_of(outcome, "wavelength at which the viscosity is the paper's", "n = 8");
  ASSERT_TRUE(row);
  EXPECT_NEAR(row->ours.value, 5, 1e-6);
  EXPECT_LT(row->ours.low, 5);
  EXPECT_GT(row->ours.high, 5);
}

// ---- Coefficients with a law

TEST(CoefficientLaws, SayWhetherAViscosityFollowsItsLaw) {
  Records records;
  for (const auto& part : coefficient_laws.parts(quick)) {
    const bool is_wrong = part.name == "viscosity, law T*^2, T* = 1.4";
    records[part.name] = estimate(is_wrong ? 1.2 : 1, 0.01);
  }
  const auto outcome = coefficient_laws.conclude(quick, records);
  ASSERT_EQ(outcome.rows.size(), 8U);
  const std::string viscosity = "viscosity over that of a constant coefficient of the law's value";
  EXPECT_EQ(row_of(outcome, viscosity, "law T*^2 = 1.960 at T* = 1.4")->verdict, Verdict::differs);
  EXPECT_EQ(row_of(outcome, viscosity, "law T*^2 = 0.490 at T* = 0.7")->verdict, Verdict::agrees);
}

TEST(AvalosMackie, PartsCanBeRun) {
  for (const auto& part : avalos_mackie_1999_viscosity.parts(quick)) {
    if (part.name != "r* = 1.24, wavelength 4") continue;
    const auto record = part.run({});
    const auto found = read_estimate(record);
    ASSERT_TRUE(found);
    // The paper's 0.363 is that of a box of about 5.
    EXPECT_GT(found->mean, 0.2);
    EXPECT_LT(found->mean, 0.45);
    EXPECT_EQ(record, part.run({}));
  }
}

}  // namespace
}  // namespace driftless::reproduce
