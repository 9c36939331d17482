#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "experiments/judge/wide_system.hpp"
#include "experiments/statistics.hpp"
#include "model/configurations.hpp"
#include "model/initial.hpp"
#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

// Walls and gravity: partners of infinite mass that every method meets in its own pair updates.
namespace driftless::testing {
namespace {

constexpr double boltzmann = 0.5;
constexpr double step_size = 0.01;
constexpr std::uint64_t steps = 20;
constexpr double rounding = 1e-10;

/// A hot and a cold reservoir across x, adiabatic walls across z, where gravity pulls if there is
/// a potential; periodic along y.
Box walled_box(bool potential, double side = 3) {
  Box box{Vector::Constant(side)};
  const double repulsion = potential ? 20 : 0;
  const auto reservoir = [&](double temperature) {
    return Wall{.temperature = temperature,
                .repulsion = repulsion,
                .repulsion_range = 0.6,
                .friction = 5,
                .friction_range = 0.9,
                .conduction = 7,
                .heat_range = 0.8};
  };
  box.walls[0] = reservoir(1.6);
  box.walls[1] = reservoir(0.7);
  box.walls[4] = box.walls[5] = Wall{.repulsion = repulsion, .repulsion_range = 0.5};
  if (potential) box.gravity = Vector(0, 0, -0.4);
  return box;
}

struct Balance {
  double energy, momentum;
};

/// What fluid and surroundings together gain over some steps.
Balance balance(const Method& method, const Options& options, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  System system(Fluid(f), walled_box(terms.potential), small_state(f), Noise(7, 0));
  const double energy = system.total_energy();
  const Vector momentum = system.momentum();
  const auto integrator = method.make(options);
  run(*integrator, system, step_size, 1, steps + 1);
  const auto received = total(system.motion().surroundings);
  return {system.total_energy() + received.energy - energy,
          (system.momentum() + received.momentum - momentum).norm()};
}

bool claims_energy(const Method& method, bool potential) {
  const auto claim = potential ? method.energy_with_potential : method.energy_ideal;
  return claim == EnergyClaim::exact;
}

class Walls : public ::testing::TestWithParam<const Method*> {};

TEST_P(Walls, ReceiveWhatTheFluidGives) {
  const Method& method = *GetParam();
  for (const auto closure : method.closures) {
    for (const auto heat : all_heat_forms()) {
      for (const bool potential : {false, true}) {
        const Terms terms{closure, heat, potential};
        const auto found = balance(method, {}, terms);
        EXPECT_LT(found.momentum, rounding) << terms.name();
        if (claims_energy(method, potential)) {
          EXPECT_LT(std::abs(found.energy), rounding) << terms.name();
        }
      }
    }
  }
}

// Alone, so that nothing but the wall acts; moved along the velocity of whichever end of the step.
TEST_P(Walls, TurnRoundWhoReachesThem) {
  const Method& method = *GetParam();
  const auto f = small_fluid({method.closures[0], HeatForm::temperature, false}, boltzmann);
  Box box{Vector::Constant(6)};
  for (auto& wall : box.walls) wall = Wall{};
  State state;
  state.position = {Vector(5.905, 3, 3), Vector(3, 0.105, 1)};
  state.velocity = {Vector(1, 0, 0), Vector(0, -1, 0)};
  state.internal_energy = {1, 1};
  state.id = {0, 1};
  System system(Fluid(f), box, state, Noise(7, 0));
  const auto integrator = method.make({});
  run(*integrator, system, step_size, 1, steps + 1);
  for (std::size_t i = 0; i < 2; ++i) {
    const bool first = system.state().id[i] == 0;
    const Vector end = first ? Vector(5.895, 3, 3) : Vector(3, 0.095, 1);
    EXPECT_LT((system.state().position[i] - end).norm(), rounding);
    EXPECT_LT((system.state().velocity[i] - (first ? Vector(-1, 0, 0) : Vector(0, 1, 0))).norm(),
              rounding);
  }
  const auto& received = system.motion().surroundings;
  EXPECT_NEAR(received[1].momentum[0], 2 * f.mass, rounding);
  EXPECT_NEAR(received[2].momentum[1], -2 * f.mass, rounding);
}

TEST_P(Walls, GiveTheSameBitsForAnyNumberOfThreads) {
  const Method& method = *GetParam();
  const auto f = small_fluid({method.closures[0], HeatForm::temperature, true}, boltzmann);
  const Box box = walled_box(true, 8);
  State start = place(box, Layout::fluid, Placement::random, 700, 0, Noise(3, 0));
  draw_given_spread(Fluid(f), Layout::fluid, 0.6, 1.1, Noise(3, 0), start);
  std::vector<State> ends;
  for (const unsigned threads : {1U, 2U, 4U}) {
    System system(Fluid(f), box, start, Noise(5, 0));
    system.set_threads(threads);
    const auto integrator = method.make({});
    run(*integrator, system, 0.004, 1, 5);
    ends.push_back(system.state());
  }
  for (const auto& end : ends) {
    EXPECT_TRUE(judge::same_bits(end, ends[0]));
    for (std::size_t n = 0; n < surrounding_places; ++n) {
      EXPECT_EQ(end.surroundings[n].energy, ends[0].surroundings[n].energy);
      EXPECT_EQ(end.surroundings[n].momentum, ends[0].surroundings[n].momentum);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, Walls, ::testing::ValuesIn(methods()), test_name);

TEST(WalledBox, HasNoPairsAcrossItsWalls) {
  for (const double side : {3.0, 7.0}) {
    const Box box = walled_box(true, side);
    const auto f = small_fluid({FrictionClosure::noise, HeatForm::none, true}, boltzmann);
    State state = place(box, Layout::fluid, Placement::random, 300, 0, Noise(9, 0));
    state.internal_energy.assign(state.size(), 1.0);
    std::set<std::pair<std::uint32_t, std::uint32_t>> expected, found;
    for (std::uint32_t i = 0; i < state.size(); ++i) {
      for (std::uint32_t j = i + 1; j < state.size(); ++j) {
        Vector apart = state.position[i] - state.position[j];
        apart[1] -= side * std::round(apart[1] / side);
        if (apart.norm() < Fluid(f).range()) expected.insert({i, j});
      }
    }
    System system(Fluid(f), box, state, Noise(1, 0));
    system.for_each_pair([&](const System::Geometry& pair) {
      found.insert({system.state().id[pair.i], system.state().id[pair.j]});
    });
    EXPECT_EQ(found, expected);
    EXPECT_GT(found.size(), 100U);
  }
}

TEST(WalledBox, ReflectsWhoReachesTheWall) {
  Box box{Vector::Constant(4)};
  box.walls[2] = box.walls[3] = Wall{};
  State state;
  state.position = {Vector(1, 3.9, 1), Vector(3, 0.05, 3)};
  state.velocity = {Vector(0.5, 2, 0), Vector(0, -1, 1)};
  state.internal_energy = {1, 1};
  state.id = {0, 1};
  FluidParameters f;
  f.mass = 1.5;
  System system(Fluid(f), box, state, Noise(1, 0));
  system.move(0.1);
  EXPECT_TRUE(system.state().position[0].isApprox(Vector(1.05, 3.9, 1), 1e-14));
  EXPECT_EQ(system.state().velocity[0], Vector(0.5, -2, 0));
  EXPECT_TRUE(system.state().position[1].isApprox(Vector(3, 0.05, 3.1), 1e-14));
  EXPECT_EQ(system.state().velocity[1], Vector(0, 1, 1));
  EXPECT_EQ(system.motion().surroundings[3].momentum, Vector(0, 6, 0));
  EXPECT_EQ(system.motion().surroundings[2].momentum, Vector(0, -3, 0));
}

TEST(WalledBox, RefusesWhatMakesNoSense) {
  const auto f = small_fluid({}, boltzmann);
  const auto refused = [&](const Box& box) {
    EXPECT_THROW(System(Fluid(f), box, small_state(f), Noise(1, 0)), std::invalid_argument);
  };
  Box one_wall{Vector::Constant(3)};
  one_wall.walls[0] = Wall{};
  refused(one_wall);
  Box falling{Vector::Constant(3)};
  falling.gravity = Vector(0, 0, -1);
  refused(falling);
  Box wide = walled_box(true);
  wide.walls[0]->friction_range = 1.6;
  refused(wide);
  Box cold = walled_box(true);
  cold.walls[0]->temperature = -1;
  refused(cold);
  Box slanted = walled_box(true);
  slanted.gravity = Vector(0.1, 0, -1);
  refused(slanted);
}

/// <|grad Psi|^2>/(k T <lap Psi>) of a soft fluid between walls and in a field, by Monte Carlo,
/// with its error from independent chains; `pairs_alone` leaves the walls' part of the Laplacian
/// out.
std::pair<double, double> configurational_temperature(bool pairs_alone) {
  const auto f = small_fluid({FrictionClosure::noise, HeatForm::none, true}, boltzmann);
  const Fluid fluid(f);
  const Box box = walled_box(true);
  constexpr std::size_t chains = 24;
  Eigen::ArrayXd found(chains);
  for (std::size_t n = 0; n < chains; ++n) {
    const Noise noise(21, n);
    ConfigurationChain chain(fluid, box,
                             place(box, Layout::fluid, Placement::lattice, 50, 0, noise), noise);
    double forces = 0, laplacian = 0;
    for (int path = -60; path < 240; ++path) {
      chain.advance_canonical();
      if (path < 0) continue;
      const auto sums = configuration_sums(chain.system());
      forces += sums.squared_force;
      laplacian += sums.laplacian;
      if (!pairs_alone) continue;
      for (const auto& position : chain.system().state().position) {
        for (const int axis : {0, 2}) {
          const auto& wall = *box.walls[static_cast<std::size_t>(2 * axis)];
          const double x = std::min(position[axis], box.lengths[axis] - position[axis]);
          if (x < wall.repulsion_range) laplacian -= wall.repulsion / wall.repulsion_range;
        }
      }
    }
    found[static_cast<Eigen::Index>(n)] = forces / (boltzmann * f.temperature * laplacian);
  }
  const double mean = found.mean();
  return {mean, std::sqrt((found - mean).square().sum() / (chains * (chains - 1.0)))};
}

// Beyond 10 with 23 degrees of freedom less than once in 10^9 times.
TEST(WalledBox, HasTheConfigurationalTemperatureOfItsPotential) {
  const auto [value, error] = configurational_temperature(false);
  EXPECT_LT(std::abs(value - 1), 10 * error);
  EXPECT_LT(error, 0.01);
}

TEST(WalledBox, IsSeenToLackTheWallsPotential) {
  const auto [value, error] = configurational_temperature(true);
  EXPECT_GT(std::abs(value - 1), 10 * error);
}

/// Mean of 1/theta and of kinetic energy per degree, times the walls' temperature, of a fluid
/// between reservoirs, with their errors from independent runs.
struct Temperatures {
  double internal, internal_error, kinetic, kinetic_error;
};

Temperatures between_walls(double wall_temperature, double law_temperature) {
  FluidParameters f =
      small_fluid({FrictionClosure::noise, HeatForm::inverse_temperature, false}, boltzmann);
  Box box{Vector::Constant(2.2)};
  box.walls[0] = box.walls[1] = Wall{.temperature = wall_temperature,
                                     .friction = 20,
                                     .friction_range = 1.1,
                                     .conduction = 60,
                                     .heat_range = 1.1};
  constexpr std::size_t particles = 12, runs = 60;
  std::vector<double> internal, kinetic;
  for (std::size_t n = 0; n < runs; ++n) {
    const Noise noise(11, n);
    State start = place(box, Layout::fluid, Placement::random, particles, 0, noise);
    draw_given_spread(Fluid(f), Layout::fluid, std::sqrt(boltzmann * wall_temperature / f.mass),
                      wall_temperature, noise, start);
    System system(Fluid(f), box, start, noise);
    const auto integrator = find_method("metropolized-splitting")->make({});
    double inverse = 0, energy = 0;
    constexpr std::uint64_t settle = 800, measure = 2000;
    for (std::uint64_t step = 1; step <= settle + measure; ++step) {
      system.set_step(step);
      integrator->step(system, 0.02);
      if (step <= settle) continue;
      for (std::size_t i = 0; i < particles; ++i) {
        const auto& state = system.state();
        inverse += f.heat_capacity / state.internal_energy[i];
        energy += f.mass * std::pow(state.velocity[i][0], 2);
      }
    }
    internal.push_back(inverse * law_temperature / (particles * measure));
    kinetic.push_back(energy / (boltzmann * law_temperature * particles * measure));
  }
  const auto mean = [](const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  };
  const auto error = [&](const std::vector<double>& x) {
    double squares = 0;
    for (const double value : x) squares += std::pow(value - mean(x), 2);
    return std::sqrt(squares / static_cast<double>(x.size() * (x.size() - 1)));
  };
  return {mean(internal), error(internal), mean(kinetic), error(kinetic)};
}

// The canonical law at the walls' temperature: <1/theta> = 1/T and <m v_x^2> = k T, exactly. With
// 60 independent runs a Student variate is beyond 7.5 less than once in 10^9 times.
TEST(WalledFluid, TakesTheTemperatureOfTheWalls) {
  const auto found = between_walls(1.3, 1.3);
  EXPECT_LT(std::abs(found.internal - 1), 7.5 * found.internal_error);
  EXPECT_LT(std::abs(found.kinetic - 1), 7.5 * found.kinetic_error);
  EXPECT_LT(found.internal_error, 0.004);
  EXPECT_LT(found.kinetic_error, 0.01);
}

TEST(WalledFluid, IsSeenToTakeAnotherTemperature) {
  const auto found = between_walls(1.3, 1.4);
  EXPECT_GT(std::abs(found.internal - 1), 7.5 * found.internal_error);
}

}  // namespace
}  // namespace driftless::testing
