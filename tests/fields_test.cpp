#include "experiments/fields.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "experiments/monitor.hpp"
#include "tests/small_system.hpp"

// Averages on a grid against states made by hand, and their error bars against series whose errors
// are known.
namespace driftless::testing {
namespace {

using nlohmann::json;

FluidParameters unit_fluid() {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.mass = 2;
  f.heat_capacity = 10;
  f.repulsion = 0;
  f.friction = 1;
  return f;
}

struct Particle {
  Vector position, velocity;
  double internal_energy;
};

State state_of(const std::vector<Particle>& particles) {
  State state;
  for (const auto& particle : particles) {
    state.id.push_back(static_cast<std::uint32_t>(state.id.size()));
    state.position.push_back(particle.position);
    state.velocity.push_back(particle.velocity);
    state.internal_energy.push_back(particle.internal_energy);
  }
  return state;
}

System system_of(const std::vector<Particle>& particles,
                 const FluidParameters& fluid = unit_fluid()) {
  return System(Fluid(fluid), Box{Vector(4, 6, 8)}, state_of(particles), Noise(1, 0));
}

std::vector<double> values_of(const std::vector<Fields::Quantity>& quantities,
                              const std::string& name) {
  for (const auto& quantity : quantities) {
    if (quantity.name == name) return quantity.values;
  }
  ADD_FAILURE() << name;
  return {};
}

std::vector<double> values(const Fields& fields, const std::string& name) {
  return values_of(fields.quantities(), name);
}

/// Three particles in the bin x < 2, two beyond, none of them at the same place in y and z.
std::vector<Particle> five() {
  return {{{0.5, 1, 1}, {1, 0, 0}, 10},
          {{1.5, 5, 2}, {3, 0, 3}, 20},
          {{0.1, 3, 7}, {2, 3, 0}, 40},
          {{2.5, 2, 4}, {-1, 5, 0}, 10},
          {{3.9, 4, 4}, {-1, 7, 0}, 30}};
}

TEST(Fields, OfAStateMadeByHand) {
  System system = system_of(five());
  Fields fields(system, {2, 1, 1});
  fields.sample(system, 0);
  const double volume = 4.0 * 6 * 8 / 2;
  EXPECT_EQ(values(fields, "number_density"), (std::vector<double>{3 / volume, 2 / volume}));
  EXPECT_EQ(values(fields, "velocity_x"), (std::vector<double>{2, -1}));
  EXPECT_EQ(values(fields, "velocity_y"), (std::vector<double>{1, 6}));
  EXPECT_EQ(values(fields, "velocity_z"), (std::vector<double>{1, 0}));
  // Squares about (2, 1, 1): 1 + 1 + 1, 1 + 1 + 4, 4 + 1; about (-1, 6, 0): 1 and 1.
  const double first = 2.0 * (3 + 6 + 5) / (3 * 0.5 * 2), second = 2.0 * (1 + 1) / (3 * 0.5 * 1);
  EXPECT_NEAR(values(fields, "kinetic_temperature")[0], first, 1e-14 * first);
  EXPECT_NEAR(values(fields, "kinetic_temperature")[1], second, 1e-14 * second);
  EXPECT_NEAR(values(fields, "internal_temperature")[0], 3 / (1 + 0.5 + 0.25), 1e-14);
  EXPECT_NEAR(values(fields, "internal_temperature")[1], 2 / (1 + 1.0 / 3), 1e-14);
  EXPECT_NEAR(values(fields, "internal_energy")[0], 70.0 / 3, 1e-13);
  EXPECT_EQ(values(fields, "internal_energy")[1], 20);
}

/// The first two particles of five() are of a second species.
System system_of_two_species() {
  auto fluid = unit_fluid();
  fluid.further_species = {{.mass = 6, .heat_capacity = 5}};
  State state = state_of(five());
  state.species = {1, 1, 0, 0, 0};
  return System(Fluid(fluid), Box{Vector(4, 6, 8)}, state, Noise(1, 0));
}

TEST(Fields, OfTwoSpeciesMoveWithTheirCentreOfMass) {
  System system = system_of_two_species();
  Fields fields(system, {2, 1, 1});
  fields.sample(system, 0);
  const Vector mean = (6 * Vector(1, 0, 0) + 6 * Vector(3, 0, 3) + 2 * Vector(2, 3, 0)) / 14;
  EXPECT_NEAR(values(fields, "velocity_y")[0], mean[1], 1e-15);
  EXPECT_NEAR(values(fields, "velocity_z")[0], mean[2], 1e-15);
  const double energy = 6 * (Vector(1, 0, 0) - mean).squaredNorm() +
                        6 * (Vector(3, 0, 3) - mean).squaredNorm() +
                        2 * (Vector(2, 3, 0) - mean).squaredNorm();
  EXPECT_NEAR(values(fields, "kinetic_temperature")[0], energy / (3 * 0.5 * 2), 1e-13);
  // Temperatures 10/5, 20/5 and 40/10.
  EXPECT_NEAR(values(fields, "internal_temperature")[0], 3 / (0.5 + 0.25 + 0.25), 1e-14);
}

TEST(Fields, OfEachSpeciesAreItsOwn) {
  System system = system_of_two_species();
  Fields fields(system, {2, 1, 1});
  fields.sample(system, 0);
  ASSERT_EQ(fields.species(), 2U);
  const auto of = [&](std::size_t species, const char* name) {
    return values_of(fields.quantities(species), name);
  };
  const double volume = 4.0 * 6 * 8 / 2;
  EXPECT_EQ(of(0, "number_density"), (std::vector<double>{1 / volume, 2 / volume}));
  EXPECT_EQ(of(1, "number_density"), (std::vector<double>{2 / volume, 0}));
  EXPECT_EQ(of(0, "velocity_x"), (std::vector<double>{2, -1}));
  EXPECT_EQ(of(1, "velocity_x")[0], 2);
  EXPECT_TRUE(std::isnan(of(1, "velocity_x")[1]));
  // Two of mass 6 with (-1, 0, -1.5) and its opposite about their mean; one particle has none.
  EXPECT_NEAR(of(1, "kinetic_temperature")[0], 6 * 2 * (1 + 2.25) / (3 * 0.5), 1e-13);
  EXPECT_TRUE(std::isnan(of(0, "kinetic_temperature")[0]));
  EXPECT_NEAR(of(1, "internal_temperature")[0], 2 / (0.5 + 0.25), 1e-14);
  EXPECT_NEAR(of(0, "internal_temperature")[0], 4, 1e-14);
  EXPECT_EQ(of(1, "internal_energy")[0], 15);
  const auto written = fields.to_json();
  ASSERT_EQ(written["species"].size(), 2U);
  EXPECT_EQ(written["species"][1]["internal_energy"]["values"][0], 15.0);
  EXPECT_FALSE(Fields(system_of(five()), {1, 1, 1}).to_json().contains("species"));
}

TEST(Fields, BinsAreCountedAlongXFirst) {
  System system = system_of({{{1, 1, 7}, {0, 0, 0}, 1}, {{3, 5, 1}, {0, 0, 0}, 1}});
  Fields fields(system, {2, 3, 4});
  fields.sample(system, 0);
  const auto density = values(fields, "number_density");
  ASSERT_EQ(density.size(), 24U);
  for (std::size_t bin = 0; bin < density.size(); ++bin) {
    const bool occupied = bin == (3 * 3 + 0) * 2 + 0 || bin == (0 * 3 + 2) * 2 + 1;
    EXPECT_EQ(density[bin], occupied ? 24.0 / (4 * 6 * 8) : 0) << bin;
  }
}

TEST(Fields, WithoutParticlesAreUnknownAndNullInJson) {
  System system = system_of({{{1, 1, 1}, {0, 0, 0}, 1}});
  Fields fields(system, {2, 1, 1});
  for (int n = 0; n < 4; ++n) fields.sample(system, 0);
  const json written = fields.to_json();
  EXPECT_EQ(written["bins"], json({2, 1, 1}));
  EXPECT_EQ(written["samples"], 4);
  EXPECT_EQ(written["axes"][2], json({{"axis", "z"}, {"from", 0}, {"to", 8.0}, {"bins", 1}}));
  const json& quantities = written["quantities"];
  EXPECT_EQ(quantities["number_density"]["values"][1], 0.0);
  EXPECT_EQ(quantities["velocity_x"]["values"], json({0.0, nullptr}));
  EXPECT_EQ(quantities["velocity_x"]["errors"], json({0.0, nullptr}));
  // One particle alone has no velocity about the mean.
  EXPECT_EQ(quantities["kinetic_temperature"]["values"], json({nullptr, nullptr}));
}

TEST(Fields, OfAnIsothermalFluidHaveNoInternalQuantities) {
  auto f = unit_fluid();
  f.isothermal = true;
  System system = system_of(five(), f);
  Fields fields(system, {1, 1, 1});
  fields.sample(system, 0);
  const json quantities = fields.to_json()["quantities"];
  EXPECT_TRUE(quantities.contains("kinetic_temperature"));
  EXPECT_FALSE(quantities.contains("internal_temperature"));
  EXPECT_FALSE(quantities.contains("internal_energy"));
}

TEST(Fields, RefuseBinsThatAreNoneOrTooMany) {
  System system = system_of(five());
  EXPECT_THROW(Fields(system, {0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(Fields(system, {1000, 101, 1}), std::invalid_argument);
  EXPECT_NO_THROW(Fields(system, {1000, 100, 1}));
}

/// Maxwell's velocities of temperature 1.5 in a flow that differs from bin to bin, with a mean of
/// three particles a bin.
struct FlowingGas {
  std::vector<Vector> flow = {{5, 0, 1}, {-3, 2, 0}};
  std::mt19937_64 engine{11};

  System system(double temperature) {
    std::normal_distribution<double> normal(0, std::sqrt(0.5 * temperature / 2));
    std::uniform_real_distribution<double> place(0, 1);
    std::vector<Particle> particles;
    for (int i = 0; i < 6; ++i) {
      const Vector where(4 * place(engine), 6 * place(engine), 8 * place(engine));
      const Vector thermal(normal(engine), normal(engine), normal(engine));
      particles.push_back({where, flow[where[0] < 2 ? 0 : 1] + thermal, 10});
    }
    return system_of(particles);
  }
};

// Per bin and sample (n - 1) * 3 squares of normal numbers: their mean over 4000 samples has a
// relative standard deviation of sqrt(2/(3 * sum(n - 1))), sum(n - 1) being above 7000 (expected:
// 2.02 * 4000); 6 of these are exceeded with a probability of 2e-9.
bool is_temperature(double value, double expected) {
  return std::abs(value / expected - 1) < 6 * std::sqrt(2.0 / (3 * 7000));
}

TEST(Fields, TheKineticTemperatureIsUnbiasedInAFlowWithFewParticles) {
  FlowingGas gas;
  System first = gas.system(1.5);
  Fields fields(first, {2, 1, 1});
  // The plain way of two that are wrong: about no mean, and about the mean but over n.
  std::vector<double> about_nothing(2, 0), about_mean(2, 0), particles(2, 0);
  for (int n = 0; n < 4000; ++n) {
    System system = gas.system(1.5);
    fields.sample(system, 0);
    for (std::size_t bin = 0; bin < 2; ++bin) {
      std::vector<Vector> here;
      for (std::size_t i = 0; i < system.size(); ++i) {
        if ((system.state().position[i][0] < 2) == (bin == 0)) {
          here.push_back(system.state().velocity[i]);
        }
      }
      Vector mean = Vector::Zero();
      for (const auto& v : here) mean += v / static_cast<double>(here.size());
      for (const auto& v : here) {
        about_nothing[bin] += 2 * v.squaredNorm();
        about_mean[bin] += 2 * (v - mean).squaredNorm();
        particles[bin] += 1;
      }
    }
  }
  for (std::size_t bin = 0; bin < 2; ++bin) {
    EXPECT_TRUE(is_temperature(values(fields, "kinetic_temperature")[bin], 1.5));
    EXPECT_FALSE(is_temperature(about_nothing[bin] / (3 * 0.5 * particles[bin]), 1.5));
    EXPECT_FALSE(is_temperature(about_mean[bin] / (3 * 0.5 * particles[bin]), 1.5));
    // Six standard deviations of a mean velocity over at least 11000 particles' velocities.
    const double bound = 6 * std::sqrt(0.5 * 1.5 / 2 / 11000);
    EXPECT_NEAR(values(fields, "velocity_x")[bin], gas.flow[bin][0], bound);
  }
}

// Internal energies of a common autoregressive series, whose mean has a known error: how often
// 1.96 errors hold the true mean.
double coverage(int runs, int samples, double correlation, double factor) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  System system = system_of(five());
  State state = system.state();
  int covered = 0;
  for (int run = 0; run < runs; ++run) {
    Fields fields(system, {1, 1, 1});
    double x = normal(engine);
    for (int n = 0; n < samples; ++n) {
      x = correlation * x + std::sqrt(1 - correlation * correlation) * normal(engine);
      state.internal_energy.assign(state.size(), 50 + x);
      system.set_state(state);
      fields.sample(system, 0);
    }
    const auto all = fields.quantities();
    const auto& energy = all.back();
    if (std::abs(energy.values[0] - 50) < 1.96 * factor * energy.errors[0]) ++covered;
  }
  return static_cast<double>(covered) / runs;
}

// 600 runs cover 95 % but for 0.9 % (standard deviation): below 90 % with a probability of 1e-8.
// Errors of independent samples would be too small by sqrt((1 + c)/(1 - c)) = 4.4 for c = 0.9.
TEST(Fields, ErrorsCountCorrelationInTime) {
  EXPECT_GT(coverage(600, 1000, 0.9, 1), 0.9);
  EXPECT_LT(coverage(600, 1000, 0.9, 1 / 4.4), 0.9);
}

TEST(Fields, ErrorsOfIndependentSamplesAreNotTooLarge) {
  EXPECT_GT(coverage(600, 100, 0, 1), 0.9);
  // Half the error covers 67 %: above 80 % with a probability below 1e-11.
  EXPECT_LT(coverage(600, 100, 0, 0.5), 0.8);
}

TEST(Fields, BlocksAreJoinedWithoutALoss) {
  System system = system_of(five());
  State state = system.state();
  Fields fields(system, {1, 1, 1});
  double sum = 0;
  for (int n = 0; n < 1001; ++n) {
    const double u = 10 + n % 7;
    sum += u;
    state.internal_energy.assign(state.size(), u);
    system.set_state(state);
    fields.sample(system, 0);
    const auto all = fields.quantities();
    ASSERT_NEAR(all.back().values[0], sum / (n + 1), 1e-12 * sum / (n + 1));
  }
  EXPECT_LE(fields.save()["blocks"].size(), 32U);
  EXPECT_GE(fields.save()["blocks"].size(), 16U);
}

TEST(Monitor, OfAStateMadeByHand) {
  System system = system_of(five());
  Monitor monitor(system, 0.25, 12);
  monitor.sample(system, 8);
  const json columns = monitor.to_json()["columns"];
  EXPECT_EQ(columns["time"], json({2.0}));
  const double kinetic = 1 + 18 + 13 + 26 + 50;
  EXPECT_EQ(columns["kinetic_energy"], json({kinetic}));
  EXPECT_EQ(columns["internal_energy"], json({110.0}));
  EXPECT_EQ(columns["potential_energy"], json({0.0}));
  EXPECT_EQ(columns["total_energy"], json({kinetic + 110}));
  EXPECT_EQ(columns["momentum_x"], json({8.0}));
  EXPECT_EQ(columns["momentum_y"], json({30.0}));
  EXPECT_EQ(columns["momentum_z"], json({6.0}));
  const double of_centre = (64 + 900 + 36) / (2.0 * 10);
  EXPECT_NEAR(columns["kinetic_temperature"][0].get<double>(),
              2 * (kinetic - of_centre) / (12 * 0.5), 1e-12);
  EXPECT_NEAR(columns["internal_temperature"][0].get<double>(), 5 / (1 + 0.5 + 0.25 + 1 + 1.0 / 3),
              1e-13);
}

TEST(Monitor, OfTwoSpecies) {
  System system = system_of_two_species();
  Monitor monitor(system, 1, 12);
  monitor.sample(system, 0);
  const json columns = monitor.to_json()["columns"];
  const double kinetic = 3 + 54 + 13 + 26 + 50;
  EXPECT_EQ(columns["kinetic_energy"], json({kinetic}));
  const Vector momentum(24, 30, 18);
  EXPECT_EQ(columns["momentum_x"], json({momentum[0]}));
  const double about_centre = kinetic - momentum.squaredNorm() / (2 * 18);
  EXPECT_NEAR(columns["kinetic_temperature"][0].get<double>(), 2 * about_centre / (12 * 0.5),
              1e-12);
  EXPECT_NEAR(columns["internal_temperature"][0].get<double>(),
              5 / (0.5 + 0.25 + 0.25 + 1 + 1.0 / 3), 1e-13);
}

TEST(Monitor, ShowsWhatWallsReceive) {
  Box box{Vector(4, 6, 8)};
  box.walls[2] = Wall{.temperature = 3.0, .friction = 1};
  box.walls[3] = Wall{};
  State state = state_of(five());
  state.surroundings[2] = {Vector(0, -7, 0), 5};
  state.surroundings[3] = {Vector(0, 9, 0), 0};
  state.surroundings[driver_place] = {Vector::Zero(), -2};
  System system(Fluid(unit_fluid()), box, state, Noise(1, 0));
  Monitor monitor(system, 1, 12);
  monitor.sample(system, 0);
  const json columns = monitor.to_json()["columns"];
  EXPECT_EQ(columns["surroundings_energy"], json({3.0}));
  EXPECT_EQ(columns["lower_y_wall_energy"], json({5.0}));
  EXPECT_EQ(columns["lower_y_wall_momentum"], json({-7.0}));
  EXPECT_EQ(columns["upper_y_wall_energy"], json({0.0}));
  EXPECT_EQ(columns["upper_y_wall_momentum"], json({9.0}));
  EXPECT_FALSE(columns.contains("lower_x_wall_energy"));
}

TEST(Monitor, IsThinnedToRowsEquallyFarApart) {
  System system = system_of(five());
  Monitor monitor(system, 1, 12);
  const std::uint64_t samples = 3 * Monitor::most_rows;
  for (std::uint64_t step = 0; step < samples; ++step) monitor.sample(system, step);
  const auto& times = monitor.columns().front().values;
  EXPECT_LE(times.size(), Monitor::most_rows + 1);
  EXPECT_GE(times.size(), Monitor::most_rows / 2);
  for (std::size_t i = 0; i < times.size(); ++i) {
    ASSERT_EQ(times[i], static_cast<double>(i) * times[1]);
  }
  EXPECT_GE(times.back() + times[1], static_cast<double>(samples));
}

/// Whether samples 0 to 9999 give the same when an observer is taken up from what it saved after
/// some of them.
template <class Make>
void expect_the_same_after_a_restart(const Make& make, System& system) {
  auto whole = make();
  for (std::uint64_t step = 0; step < 10'000; ++step) whole.sample(system, step);
  for (const std::uint64_t stop : {1, 31, 33, 5000, 9999}) {
    auto before = make(), after = make();
    for (std::uint64_t step = 0; step < stop; ++step) before.sample(system, step);
    after.load(json::from_cbor(json::to_cbor(before.save())));
    for (std::uint64_t step = stop; step < 10'000; ++step) after.sample(system, step);
    EXPECT_EQ(after.save(), whole.save()) << stop;
    EXPECT_EQ(after.to_json(), whole.to_json()) << stop;
  }
}

TEST(Fields, GoOnFromWhatTheySaved) {
  System system = system_of(five());
  expect_the_same_after_a_restart([&] { return Fields(system, {2, 1, 2}); }, system);
  System two = system_of_two_species();
  expect_the_same_after_a_restart([&] { return Fields(two, {2, 1, 1}); }, two);
}

TEST(Monitor, GoesOnFromWhatItSaved) {
  System system = system_of(five());
  expect_the_same_after_a_restart([&] { return Monitor(system, 1, 12); }, system);
}

}  // namespace
}  // namespace driftless::testing
