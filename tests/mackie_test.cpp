#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/binned_law.hpp"
#include "experiments/reproduce/mackie_roll.hpp"
#include "experiments/scene_keys.hpp"

/// The boxes of Mackie, Bonet Avalos, Navas (1999): starts, walls, pressures and rolls beside what
/// is known exactly.
namespace driftless::reproduce {
namespace {

constexpr double boltzmann = 0.5;
/// A Student variate with 15 degrees of freedom is further out less than once in 10^8 times.
constexpr double certain = 12;
constexpr std::size_t replicas = 16;

struct Measured {
  double mean, error;
};

Measured measured(const std::vector<double>& values) {
  const Eigen::Map<const Eigen::ArrayXd> x(values.data(), static_cast<Eigen::Index>(values.size()));
  const auto n = static_cast<double>(values.size());
  return {x.mean(), std::sqrt((x - x.mean()).square().sum() / (n * (n - 1)))};
}

TEST(MackieWall, LayerIsTheIntegralOfItsBoltzmannFactor) {
  for (const WallRepulsion wall : {WallRepulsion{3.4, 0.5}, {30, 0.25}, {0.01, 1.24}}) {
    const double thermal = boltzmann * mackie_temperature;
    double excluded = 0, potential = 0;
    constexpr int cells = 20000;
    for (int n = 0; n < cells; ++n) {
      const double x = (n + 0.5) / cells;
      const double psi = 0.5 * wall.strength * wall.range * (1 - x) * (1 - x);
      excluded += (1 - std::exp(-psi / thermal)) * wall.range / cells;
      potential += psi * std::exp(-psi / thermal) * wall.range / cells;
    }
    const auto layer = wall_layer(wall, boltzmann, mackie_temperature);
    EXPECT_NEAR(layer.excluded, excluded, 1e-7);
    EXPECT_NEAR(layer.potential, potential, 1e-7);
  }
  EXPECT_EQ(wall_layer({0, 1}, boltzmann, mackie_temperature).excluded, 0);
}

TEST(MackieStart, HasTheMeanEnergyAndKeepsOffTheWalls) {
  const auto fluid = mackie_parameters(mackie_liquid);
  const Box box = mackie_cube(3000, Wall{}, 1);
  const auto state = mackie_in_law(fluid, box, 3000, 1.1, 0.3, Noise(1, 0));
  System system(Fluid(fluid), box, state, Noise(1, 0));
  // N (phi + 5k/2) T, but for the momentum of the centre of mass, which is 0.
  const double expected = (3000 * (50 + 1.25) - 0.75) * 1.1;
  EXPECT_NEAR(system.total_energy(), expected, 1e-9 * expected);
  double lowest = 1e9, lowest_free = 1e9;
  for (const auto& position : state.position) {
    lowest = std::min(lowest, position[2]);
    lowest_free = std::min(lowest_free, position[0]);
  }
  EXPECT_GE(lowest, 0.3);
  EXPECT_LT(lowest, 0.4);
  EXPECT_LT(lowest_free, 0.1);
}

/// Chi^2 of energies in equally likely bins, over k T of a temperature; 59 degrees of freedom.
double chi_squared(double temperature) {
  constexpr std::size_t particles = 20000, bins = 60;
  const auto fluid = mackie_parameters(mackie_liquid);
  const auto state =
      mackie_in_law(fluid, mackie_cube(particles, Wall{}), particles, 1.1, 0, Noise(2, 0));
  const auto law = BinnedLaw::gamma(1 / mackie_liquid.B + 1, bins);
  std::vector<double> counts(bins, 0);
  for (const double u : state.internal_energy) ++counts[law.bin(u / (boltzmann * temperature))];
  double sum = 0;
  for (const double count : counts) {
    sum += std::pow(count - double(particles) / bins, 2) / (double(particles) / bins);
  }
  return sum;
}

// Beyond 145 less than once in 10^8 times.
TEST(MackieStart, EnergiesAreInTheGammaLaw) {
  EXPECT_LT(chi_squared(1.1), 145);
  EXPECT_GT(chi_squared(1.1 * 1.01), 145) << "a temperature off by one per cent is seen";
}

/// P* from the momentum that the walls receive, and from the density in the middle, over many runs.
struct Pressures {
  Measured wall, bulk;
};

Pressures pressures(const WallRepulsion& repulsion) {
  constexpr std::size_t particles = 216;
  constexpr double step = 0.02, settle = 5, duration = 45, margin = 1.5;
  const auto fluid = mackie_parameters({0.05, 2, 1.24});
  const Box box = mackie_cube(particles, mackie_reservoir(fluid, 1.1, repulsion));
  const double side = box.lengths[0];
  const double inset = wall_layer(repulsion, boltzmann, 1.1).excluded;
  std::vector<double> wall, bulk;
  for (std::size_t n = 0; n < replicas; ++n) {
    const Noise noise(3, n);
    System system(Fluid(fluid), box, mackie_in_law(fluid, box, particles, 1.1, inset, noise),
                  noise);
    BoxSeries series(step, margin);
    run_box(system, {"shardlow-s1", {}}, step, duration, {{"series", &series, 10, 0}}, {});
    const auto record = series.to_json();
    const auto pushed = column_from(record, "pushed", settle);
    wall.push_back((pushed[pushed.size() - 1] - pushed[0]) /
                   ((duration - settle) * 6 * side * side * boltzmann));
    bulk.push_back(1.1 * column_from(record, "bulk", settle).mean() /
                   std::pow(side - 2 * margin, 3));
  }
  return {measured(wall), measured(bulk)};
}

TEST(MackiePressure, OfHardWallsIsThatOfTheIdealGas) {
  const auto found = pressures({0, 1});
  EXPECT_LT(std::abs(found.wall.mean - 1.1), certain * found.wall.error);
  EXPECT_LT(found.wall.error, 0.01);
  EXPECT_LT(std::abs(found.bulk.mean - 1.1), certain * found.bulk.error);
}

TEST(MackiePressure, OfRepulsiveWallsIsThatOfTheDensityInTheMiddle) {
  constexpr WallRepulsion repulsion = mackie_repulsion;
  const auto found = pressures(repulsion);
  const double excluded = wall_layer(repulsion, boltzmann, 1.1).excluded;
  // A wall's area counts up to its edges, where the other walls let no particle come.
  const double expected = 1.1 * 6 / (6 - 2 * excluded);
  const double in_the_middle = 1.1 * 216 / std::pow(6 - 2 * excluded, 3);
  EXPECT_LT(std::abs(found.wall.mean - expected), certain * found.wall.error);
  EXPECT_LT(std::abs(found.bulk.mean - in_the_middle), certain * found.bulk.error);
  EXPECT_GT(found.wall.mean - 1.1, certain * found.wall.error)
      << "that it is not the ideal gas's of the mean density is seen";
}

TEST(MackieBooks, BalanceAtEveryStepOfAnExactMethod) {
  const auto fluid = mackie_parameters(mackie_liquid);
  const Box box = mackie_cube(100, mackie_reservoir(fluid, 1.1, {0, 1}));
  const auto worst = [&](const char* method) {
    System system(Fluid(fluid), box, mackie_at_rest(fluid, box, 100, 1, 0, Noise(4, 0)),
                  Noise(4, 0));
    BoxSeries series(0.01);
    run_box(system, {method, {}}, 0.01, 2, {{"series", &series, 1, 0}}, {});
    const auto record = series.to_json();
    Eigen::VectorXd sum = column_from(record, "kinetic") + column_from(record, "internal");
    const Eigen::VectorXd stored = sum;
    for (const char* heat : {"heat_0", "heat_1", "heat_2", "heat_3", "heat_4", "heat_5"}) {
      sum += column_from(record, heat);
    }
    EXPECT_GT(stored[stored.size() - 1] - stored[0], 1) << "the walls have warmed it";
    return (sum.array() - sum[0]).abs().maxCoeff();
  };
  EXPECT_LT(worst("avalos-mackie-midpoint"), 1e-8);
  EXPECT_GT(worst("avalos-mackie-explicit"), 1e-4) << "one that is not exact is seen";
}

/// Particles on a lattice in a section with a given velocity everywhere.
template <class Velocity>
double flow_of(Velocity&& velocity) {
  constexpr double side = 12, depth = 5;
  Box box{Vector(side, depth, side)};
  box.walls[0] = box.walls[1] = box.walls[4] = box.walls[5] = Wall{};
  State state;
  for (int x = 0; x < 48; ++x) {
    for (int z = 0; z < 48; ++z) {
      state.position.emplace_back((x + 0.5) * side / 48, 2, (z + 0.5) * side / 48);
      state.velocity.push_back(velocity(state.position.back() / side * std::numbers::pi));
      state.internal_energy.push_back(1);
      state.id.push_back(static_cast<std::uint32_t>(state.id.size()));
    }
  }
  const System system(Fluid(mackie_parameters(mackie_gas)), box, state, Noise(1, 0));
  return roll_flow(system) * side * depth * side / (48 * 48);  // over the density
}

TEST(MackieRoll, FlowIsTheAmplitudeOfTheStreamFunction) {
  constexpr double amplitude = 0.7, wave = std::numbers::pi / 12;
  const auto roll = [&](double sign) {
    return [=](const Vector& at) {
      const double a = sign * amplitude * wave;
      return Vector(a * std::sin(at[0]) * std::cos(at[2]), 0.3,
                    -a * std::cos(at[0]) * std::sin(at[2]));
    };
  };
  EXPECT_NEAR(flow_of(roll(1)), amplitude, 1e-9);
  EXPECT_NEAR(flow_of(roll(-1)), -amplitude, 1e-9);
  const auto two_rolls = [](const Vector& at) {
    return Vector(std::sin(2 * at[0]) * std::cos(at[2]), 0,
                  -2 * std::cos(2 * at[0]) * std::sin(at[2]));
  };
  EXPECT_NEAR(flow_of(two_rolls), 0, 1e-9);
}

/// A preset's fluid, but for the temperature that a start needs.
FluidParameters fluid_of(const Scene& scene) {
  auto fluid = scene.fluid;
  fluid.temperature = FluidParameters{}.temperature;
  return fluid;
}

TEST(MackiePresets, AreTheScenesOfTheExperiments) {
  const Scene box = find_preset("mackie-1999-box")->scene;
  EXPECT_EQ(fluid_of(box), mackie_parameters(mackie_liquid));
  const Box cube =
      mackie_cube(30000, mackie_reservoir(box.fluid, mackie_temperature, mackie_repulsion));
  EXPECT_EQ(scene_box(box).walls, cube.walls);
  EXPECT_LT((scene_box(box).lengths - cube.lengths).norm(), 1e-12);
  EXPECT_EQ(box.fluid.temperature, mackie_temperature);

  const Scene roll = find_preset("mackie-1999-roll")->scene;
  EXPECT_EQ(fluid_of(roll), mackie_parameters(mackie_gas));
  EXPECT_EQ(roll.particles, roll_particles);
  EXPECT_LT((scene_box(roll).lengths - Vector::Constant(roll_side())).norm(), 1e-12);
  EXPECT_EQ(roll.walls[0], mackie_reservoir(roll.fluid, hot, {}));
  EXPECT_EQ(roll.walls[1], mackie_reservoir(roll.fluid, cold, {}));
  EXPECT_EQ(roll.walls[4], Wall{});
  EXPECT_EQ(roll.walls[5], Wall{});
  EXPECT_FALSE(roll.walls[2] || roll.walls[3]);
  EXPECT_EQ(roll.gravity, Vector(0, 0, -gravity));
}

TEST(MackieRoll, RunsAlikeOnAnyThreadsAndInPieces) {
  const RollRun run{{"shardlow-s1", {}}, 0.1, 13000, 0.01, 1, 3, 1.8};
  const auto once = run_roll(run, 5, {1, {}});
  EXPECT_EQ(run_roll(run, 5, {2, {}}), once);
  EXPECT_NE(run_roll(run, 6, {1, {}}), once);
  EXPECT_EQ(once["series"]["time"].size(), 4U);
  EXPECT_EQ(once["fields"]["samples"], 3);
  // A hot and a cold wall around a fluid between the two.
  EXPECT_LT(once["series"]["hot"].back(), 0);
  EXPECT_GT(once["series"]["cold"].back(), 0);
}

}  // namespace
}  // namespace driftless::reproduce
