#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "experiments/flux/border_flux.hpp"
#include "integrators/flows.hpp"
#include "integrators/reference.hpp"
#include "integrators/shardlow.hpp"
#include "model/configurations.hpp"
#include "model/initial.hpp"
#include "tests/small_system.hpp"

// A repulsion that follows the temperatures: internal energies eps = chi u, and the force of theta.
namespace driftless::testing {
namespace {

constexpr double boltzmann = 0.8;

FluidParameters thermal_fluid(double k, HeatForm heat = HeatForm::inverse_temperature) {
  auto f = small_fluid({FrictionClosure::noise, heat, true}, k);
  f.repulsion = 8;
  f.thermal_repulsion = 20;
  return f;
}

/// Two species of unlike heat capacities, and a repulsion of their own.
FluidParameters two_species(FluidParameters f) {
  f.further_species = {{.mass = 2, .heat_capacity = 7}};
  f.pairs = {{.a = 0, .b = 1, .repulsion = 12}};
  return f;
}

State start_of(const FluidParameters& f, std::uint64_t seed = 1) {
  State state = small_state(f, seed);
  if (f.further_species.empty()) return state;
  for (const auto id : state.id) state.species.push_back(id % 3 == 0);
  return state;
}

System system_of(const FluidParameters& f, State state) {
  return {Fluid(f), small_box(), std::move(state), Noise(3, 0)};
}

// ---- The same by hand, from the definitions. ---------------------------------------------------

double heat_capacity_of(const FluidParameters& f, const State& s, std::size_t i) {
  return s.species_of(i) == 0 ? f.heat_capacity : f.further_species[0].heat_capacity;
}

/// visit(i, j, r) of all pairs in range of the repulsion.
void for_pairs(const FluidParameters& f, const State& s,
               const std::function<void(std::size_t, std::size_t, double)>& visit) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      const double r = small_box().minimum_image(s.position[i] - s.position[j]).norm();
      if (r < f.repulsion_range) visit(i, j, r);
    }
  }
}

double shape(const FluidParameters& f, double r) {
  const double x = 1 - r / f.repulsion_range;
  return f.repulsion_range / 2 * x * x;
}

/// chi, from u = eps/chi.
std::vector<double> factors(const FluidParameters& f, const State& s) {
  std::vector<double> chi(s.size(), 1);
  for_pairs(f, s, [&](std::size_t i, std::size_t j, double r) {
    for (const auto n : {i, j}) {
      chi[n] += f.thermal_repulsion / (heat_capacity_of(f, s, n) * f.temperature) * shape(f, r) / 2;
    }
  });
  return chi;
}

/// sum of a_ij (r_c/2)(1 - r/r_c)^2 with a_ij = a + a_1 (theta_i + theta_j)/(2 T).
double potential(const FluidParameters& f, const State& s, const std::vector<double>& theta) {
  double sum = 0;
  for_pairs(f, s, [&](std::size_t i, std::size_t j, double r) {
    const bool mixed = s.species_of(i) != s.species_of(j);
    const double a = mixed ? *f.pairs[0].repulsion : f.repulsion;
    sum += (a + f.thermal_repulsion * (theta[i] + theta[j]) / (2 * f.temperature)) * shape(f, r);
  });
  return sum;
}

std::vector<double> temperatures(const FluidParameters& f, const State& s) {
  auto theta = factors(f, s);
  for (std::size_t i = 0; i < s.size(); ++i) {
    theta[i] = s.internal_energy[i] / (heat_capacity_of(f, s, i) * theta[i]);
  }
  return theta;
}

// ---- Energy and force --------------------------------------------------------------------------

const std::vector<FluidParameters>& fluids() {
  static const std::vector<FluidParameters> all = [] {
    auto without = thermal_fluid(boltzmann);
    without.repulsion = 0;
    return std::vector{thermal_fluid(boltzmann), without, two_species(thermal_fluid(boltzmann))};
  }();
  return all;
}

TEST(ThermalRepulsion, HasTheEnergyOfItsPotentialAndOfTheEnergiesThatEntropyKnows) {
  for (const auto& f : fluids()) {
    const State s = start_of(f);
    System system = system_of(f, s);
    const auto chi = factors(f, s), theta = temperatures(f, s);
    double expected = system.kinetic_energy() + potential(f, s, theta);
    for (std::size_t i = 0; i < s.size(); ++i) {
      EXPECT_NEAR(system.energy_factors()[i], chi[i], 1e-12);
      expected += s.internal_energy[i] / chi[i];
    }
    EXPECT_NEAR(system.total_energy(), expected, 1e-10 * expected);
    EXPECT_GT(*std::max_element(chi.begin(), chi.end()), 1.03);
  }
}

TEST(ThermalRepulsion, PushesAgainstTheGradientOfItsPotentialAtTheEnergiesThatEntropyKnows) {
  constexpr double h = 1e-5;
  for (const auto& f : fluids()) {
    State s = start_of(f);
    System system = system_of(f, s);
    const auto theta = temperatures(f, s);  // which u alone decides
    const auto force = system.conservative_force();
    double squares = 0, laplacian = 0, virial = 0;
    const double here = potential(f, s, theta);
    for (std::size_t i = 0; i < s.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double x = s.position[i][axis];
        s.position[i][axis] = x + h;
        const double above = potential(f, s, theta);
        s.position[i][axis] = x - h;
        const double below = potential(f, s, theta);
        s.position[i][axis] = x;
        EXPECT_NEAR(force[i][axis], (below - above) / (2 * h), 1e-6);
        laplacian += (above + below - 2 * here) / (h * h);
      }
      squares += force[i].squaredNorm();
    }
    for_pairs(f, s, [&](std::size_t i, std::size_t j, double r) {
      const bool mixed = s.species_of(i) != s.species_of(j);
      const double a = (mixed ? *f.pairs[0].repulsion : f.repulsion) +
                       f.thermal_repulsion * (theta[i] + theta[j]) / (2 * f.temperature);
      virial += r * a * (1 - r / f.repulsion_range);
    });
    const auto sums = configuration_sums(system);
    EXPECT_NEAR(sums.virial, virial, 1e-10 * virial);
    EXPECT_NEAR(sums.squared_force, squares, 1e-10 * squares);
    EXPECT_NEAR(sums.laplacian, laplacian, 1e-3 * std::abs(laplacian));
  }
}

TEST(ThermalRepulsion, FollowsEnergiesThatChangeWherePositionsDoNot) {
  const auto f = thermal_fluid(boltzmann);
  System system = system_of(f, start_of(f));
  const auto before = system.conservative_force();
  system.update([](std::size_t, Vector&, double& energy) { energy *= 1.5; });
  State warmer = system.state();
  const auto& after = system.conservative_force();
  System afresh = system_of(f, std::move(warmer));
  const auto& expected = afresh.conservative_force();
  double change = 0;
  for (std::size_t i = 0; i < system.size(); ++i) {
    EXPECT_EQ(after[i], expected[i]);
    change = std::max(change, (after[i] - before[i]).norm());
  }
  EXPECT_GT(change, 0.5);
}

// ---- Motion without friction -------------------------------------------------------------------

/// What may be wrong in a move: internal energies left as they are.
enum class Fault { none, energies_stay };

/// Change of energy, the mean of its size, and the largest of u, over a unit of time of velocity
/// Verlet.
struct Kept {
  double energy = 0, u = 0;
};

void add_verlet(System system, double step_size, Fault fault, Kept& kept) {
  const double energy = system.total_energy();
  const auto u_of = [&](std::size_t i) {
    return system.state().internal_energy[i] / system.energy_factors()[i];
  };
  std::vector<double> u(system.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = u_of(i);
  const auto steps = std::lround(1 / step_size);
  for (long n = 0; n < steps; ++n) {
    system.kick(step_size / 2);
    const auto energies = system.state().internal_energy;
    system.move(step_size);
    if (fault == Fault::energies_stay) {
      system.update([&](std::size_t i, Vector&, double& e) { e = energies[i]; });
    }
    system.kick(step_size / 2);
    kept.energy += std::abs(system.total_energy() - energy) / static_cast<double>(steps);
    for (std::size_t i = 0; i < u.size(); ++i) {
      kept.u = std::max(kept.u, std::abs(u_of(i) / u[i] - 1));
    }
  }
}

/// Over several starts: where a pair comes into range between two steps there is an error of the
/// same order, and of either sign.
Kept verlet_keeps(const FluidParameters& f, double step_size, Fault fault) {
  Kept kept;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    add_verlet(system_of(f, start_of(f, seed)), step_size, fault, kept);
  }
  return kept;
}

TEST(ThermalRepulsion, KeepsEnergyToSecondOrderAndWhatEntropyKnowsToRounding) {
  for (const auto& f : fluids()) {
    const Kept coarse = verlet_keeps(f, 0.004, Fault::none),
               fine = verlet_keeps(f, 0.001, Fault::none);
    EXPECT_LT(fine.energy, 1e-3);
    EXPECT_NEAR(std::log2(coarse.energy / fine.energy) / 2, 2, 0.25);
    EXPECT_LT(fine.u, 1e-11);
  }
}

TEST(ThermalRepulsion, IsSeenToNeedEnergiesThatFollowTheMoves) {
  const auto f = thermal_fluid(boltzmann);
  EXPECT_GT(verlet_keeps(f, 0.001, Fault::energies_stay).energy,
            100 * verlet_keeps(f, 0.001, Fault::none).energy);
}

// ---- Exchanges and methods ---------------------------------------------------------------------

std::vector<std::pair<const Method*, Options>> methods_that_run() {
  std::vector<std::pair<const Method*, Options>> all;
  for (const Method* method : methods()) {
    if (!refusal(*method, Fluid(thermal_fluid(boltzmann)))) all.push_back({method, {}});
  }
  return all;
}

TEST(ThermalRepulsion, LeavesExchangesTheEnergyThatTheyKeep) {
  const auto f = two_species(thermal_fluid(boltzmann, HeatForm::temperature));
  System system = system_of(f, start_of(f));
  const double energy = system.total_energy();
  const double internal = system.internal_energy();
  for (std::uint64_t step = 1; step <= 50; ++step) {
    system.set_step(step);
    shardlow_sweep(system, 0.01, SweepOrder::forward, 0, {});
  }
  EXPECT_NEAR(system.total_energy(), energy, 1e-12 * energy);
  EXPECT_GT(std::abs(system.internal_energy() - internal), 1);
}

TEST(ThermalRepulsion, IsRunByTheMethodsThatKickAndMoveAndRefusedByTheOthers) {
  std::vector<std::string> names;
  for (const auto& [method, options] : methods_that_run()) names.emplace_back(method->name);
  for (const char* name :
       {"shardlow-s1", "shardlow-s2", "shardlow-aboba", "peters", "lowe-andersen",
        "metropolized-splitting", "splitting-energy-reinjection"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
  for (const char* name : {"isoenergetic-verlet", "velocity-verlet", "groot-warren", "trotter",
                           "avalos-mackie-implicit", "avalos-mackie-midpoint", "espanol"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 0) << name;
  }
  const Fluid fluid(thermal_fluid(boltzmann));
  EXPECT_EQ(refusal(*find_method("velocity-verlet"), fluid),
            "velocity-verlet is built for a repulsion that depends on distances alone, that of "
            "this scene follows the temperatures");
  const auto& reinjection = *find_method("splitting-energy-reinjection");
  const auto refused = refusal(reinjection, fluid, {{"reinject_potential", true}});
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->find("splitting-energy-reinjection with these options is built for"), 0U);
}

TEST(ThermalRepulsion, OfReferenceSolutionsIsThatOfTheEquations) {
  for (const auto& fluctuating : fluids()) {
    auto f = fluctuating;
    f.boltzmann = 0;
    const State s = start_of(f);
    const double energy = system_of(f, s).total_energy();
    const State end = reference_solution(Fluid(f), small_box(), s, false, 0.4);
    EXPECT_NEAR(system_of(f, end).total_energy(), energy, 1e-9 * energy);
    // Two solvers with nothing in common.
    const State other =
        reference_solution(Fluid(f), small_box(), s, false, 0.4, {}, ReferenceSolver::runge_kutta);
    EXPECT_LT(distance(small_box(), end, other).largest(), 1e-7);
    EXPECT_GT(distance(small_box(), end, s).internal_energy, 0.2);
  }
}

TEST(ThermalRepulsion, LeavesEveryMethodThatRunsItItsLimitWithoutNoise) {
  for (const auto& fluctuating : fluids()) {
    auto f = fluctuating;
    f.boltzmann = 0;
    const State s = start_of(f);
    const State end = reference_solution(Fluid(f), small_box(), s, false, 0.2);
    for (const auto& [method, options] : methods_that_run()) {
      if (!method->consistent) continue;
      SCOPED_TRACE(method->name);
      const auto error = [&, m = method](double step_size) {
        const auto steps = static_cast<std::uint64_t>(std::llround(0.2 / step_size));
        return distance(small_box(), run(*m, f, s, step_size, steps), end).largest();
      };
      const double coarse = error(1e-3), fine = error(2.5e-4);
      EXPECT_LT(fine, 0.02);
      EXPECT_GT(std::log2(coarse / fine) / 2, 0.85);
    }
  }
}

// ---- Equilibrium -------------------------------------------------------------------------------

TEST(ThermalRepulsion, GivesPositionsTheWeightWhoseForceItIsInTheMean) {
  constexpr double h = 1e-5;
  for (const auto& f : fluids()) {
    State s = start_of(f);
    System system = system_of(f, s);
    const double thermal = f.boltzmann * f.temperature;
    const auto mean = [&](std::size_t i) { return heat_capacity_of(f, s, i) / f.boltzmann + 1; };
    system.update([&](std::size_t i, Vector&, double& energy) { energy = mean(i) * thermal; });
    const auto force = system.conservative_force();
    const auto log_weight = [&] {
      const auto chi = factors(f, s);
      double sum = -potential(f, s, std::vector<double>(s.size(), 0.0)) / thermal;
      for (std::size_t i = 0; i < s.size(); ++i) sum -= mean(i) * std::log(chi[i]);
      return sum;
    };
    for (std::size_t i = 0; i < 6; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double x = s.position[i][axis];
        s.position[i][axis] = x + h;
        const double above = log_weight();
        s.position[i][axis] = x - h;
        const double below = log_weight();
        s.position[i][axis] = x;
        EXPECT_NEAR(force[i][axis], thermal * (above - below) / (2 * h), 1e-6);
      }
    }
  }
}

/// Means over independent runs, and their errors.
struct Means {
  Eigen::ArrayXXd runs;  ///< runs x quantities
  double mean(Eigen::Index n) const { return runs.col(n).mean(); }
  double error(Eigen::Index n) const {
    const auto count = static_cast<double>(runs.rows());
    return std::sqrt((runs.col(n) - mean(n)).square().sum() / (count * (count - 1)));
  }
};

constexpr Eigen::Index runs = 32;
constexpr std::size_t particles = 40;
const Box equilibrium_box{Vector::Constant(2.3)};

FluidParameters equilibrium_fluid() {
  auto f = thermal_fluid(boltzmann);
  f.conduction = 30;
  f.friction = 10;
  return f;
}

double equilibrium_energy(const FluidParameters& f) {
  const auto law = microcanonical_law(Fluid(f), Layout::fluid, particles);
  return law.energy_at(f.temperature) + 2.0 * particles;
}

/// Psi_0 and the virial of positions drawn from their weight, energies from the Dirichlet law.
Means by_chains(const FluidParameters& f, std::vector<State>& ends) {
  const Fluid fluid(f);
  const double energy = equilibrium_energy(f);
  const auto law = microcanonical_law(fluid, Layout::fluid, particles);
  Means found{Eigen::ArrayXXd::Zero(runs, 2)};
  for (Eigen::Index n = 0; n < runs; ++n) {
    const Noise noise(31, static_cast<std::uint64_t>(n));
    ConfigurationChain chain(
        fluid, equilibrium_box,
        place(equilibrium_box, Layout::fluid, Placement::lattice, particles, 0, noise), noise);
    constexpr int paths = 200;
    for (int path = -40; path < paths; ++path) {
      chain.advance_microcanonical(energy, law.total_shape());
      if (path < 0) continue;
      Noise numbers(32, static_cast<std::uint64_t>(n));
      numbers.set_step(static_cast<std::uint64_t>(path));
      State state = chain.system().state();
      const double rest = energy - chain.system().potential_energy();
      draw_microcanonical(fluid, Layout::fluid, rest, numbers, state);
      chain.system().set_motion(state);
      const auto sums = configuration_sums(chain.system());
      found.runs(n, 0) += sums.potential / paths;
      found.runs(n, 1) += sums.virial / paths;
      if (path + 1 == paths) ends.push_back(state);
    }
  }
  return found;
}

/// A sweep of conduction and friction in which pairs see theta in the place of the temperature.
void sweep_of_bare_temperatures(System& system, double step_size) {
  const auto factors = system.energy_factors();
  const auto before = system.state().internal_energy;
  system.update([&](std::size_t i, Vector&, double& energy) { energy /= factors[i]; });
  shardlow_sweep(system, step_size, SweepOrder::forward, 0, {});
  system.update([&](std::size_t i, Vector&, double& energy) {
    energy = before[i] + energy - before[i] / factors[i];
  });
}

enum class Temperatures { right, bare };

/// 0: <k (d/2 - 1)/K> - <1/T_i>; 1: 1 less what the Dirichlet law has of the spread of energies;
/// 2: <(d/2 - 1)|F|^2/K> - <lap Psi>; 3 and 4: Psi_0 and the virial; 5: <lap Psi>.
Means by_dynamics(const FluidParameters& f, const std::vector<State>& starts,
                  Temperatures temperatures) {
  constexpr double step_size = 0.004, n = particles;
  constexpr double exponent = 1.5 * (n - 1) - 1;
  const auto method = find_method("metropolized-splitting")->make({});
  Means found{Eigen::ArrayXXd::Zero(runs, 6)};
  for (Eigen::Index run = 0; run < runs; ++run) {
    System system(Fluid(f), equilibrium_box, starts[static_cast<std::size_t>(run)],
                  Noise(33, static_cast<std::uint64_t>(run)));
    constexpr std::uint64_t steps = 2000, every = 20;
    for (std::uint64_t step = 1; step <= steps; ++step) {
      system.set_step(step);
      if (temperatures == Temperatures::right) {
        method->step(system, step_size);
      } else {
        velocity_verlet(system, step_size);
        sweep_of_bare_temperatures(system, step_size);
      }
      if (step % every != 0 || step <= steps / 5) continue;
      const double kinetic = system.kinetic_energy(), mean = system.internal_energy() / n;
      double inverse = 0, spread = 0;
      for (const double energy : system.state().internal_energy) {
        inverse += f.heat_capacity / energy / n;
        spread -= (energy - mean) * f.heat_capacity / (energy * f.boltzmann * (n - 1));
      }
      const auto sums = configuration_sums(system);
      Eigen::Array<double, 1, 6> now;
      now << f.boltzmann * exponent / kinetic - inverse, spread - 1,
          exponent * sums.squared_force / kinetic - sums.laplacian, sums.potential, sums.virial,
          sums.laplacian;
      found.runs.row(run) += now / (0.8 * steps / every);
    }
  }
  return found;
}

// 32 runs: beyond 9 standard errors, with 31 degrees of freedom, less than once in 10^9 times. What
// the steps' own error, O(dt^2), leaves is allowed for beside.
constexpr double bound = 9;

TEST(ThermalRepulsion, EquilibratesToTheLawThatIsDerived) {
  const auto f = equilibrium_fluid();
  std::vector<State> starts;
  const Means chains = by_chains(f, starts);
  const Means found = by_dynamics(f, starts, Temperatures::right);
  const double temperature = f.temperature;
  EXPECT_LT(std::abs(found.mean(0)), bound * found.error(0));
  EXPECT_LT(bound * found.error(0), 0.08 / temperature);
  EXPECT_LT(std::abs(found.mean(1)), bound * found.error(1));
  EXPECT_LT(bound * found.error(1), 0.2);
  EXPECT_LT(std::abs(found.mean(2)), bound * found.error(2));
  EXPECT_LT(bound * found.error(2), 0.15 * found.mean(5));
  for (const Eigen::Index n : {0, 1}) {
    const double error = std::hypot(chains.error(n), found.error(3 + n));
    EXPECT_LT(std::abs(found.mean(3 + n) - chains.mean(n)), bound * error) << n;
    EXPECT_LT(error, 0.01 * chains.mean(n)) << n;
  }
}

TEST(ThermalRepulsion, IsSeenToNeedTheTemperatureThatHeatKnows) {
  const auto f = equilibrium_fluid();
  std::vector<State> starts;
  by_chains(f, starts);
  const Means found = by_dynamics(f, starts, Temperatures::bare);
  EXPECT_GT(std::abs(found.mean(0)), bound * found.error(0));
}

// ---- Surroundings and refusals -----------------------------------------------------------------

TEST(ThermalRepulsion, LeavesWallsAndSurroundingsTheirAccounts) {
  auto f = thermal_fluid(boltzmann);
  Box box{Vector::Constant(3)};
  box.walls[4] = box.walls[5] = Wall{
      .temperature = 1.3, .repulsion = 30, .repulsion_range = 0.6, .friction = 4, .conduction = 5};
  State s = small_state(f);
  for (auto& position : s.position) position[2] = 0.3 + 0.8 * position[2];
  System system(Fluid(f), box, s, Noise(5, 0));
  const double energy = system.energy_with_surroundings();
  const auto method = find_method("shardlow-s1")->make({});
  run(*method, system, 0.0005, 1, 801);
  const double received = total(system.state().surroundings).energy;
  EXPECT_LT(std::abs(system.energy_with_surroundings() - energy), 0.02 * std::abs(received));
  EXPECT_GT(std::abs(received), 1);
}

TEST(ThermalRepulsion, IsTheSameForAnyNumberOfThreads) {
  const auto f = two_species(thermal_fluid(boltzmann));
  const auto after = [&](unsigned threads) {
    System system = system_of(f, start_of(f));
    system.set_threads(threads);
    const auto method = find_method("shardlow-s1")->make({});
    run(*method, system, 0.005, 1, 21);
    return system.state();
  };
  EXPECT_TRUE(same_bits(after(1), after(3)));
}

/// The gains of pairs on both sides of a border cancel but for what crosses it.
TEST(ThermalRepulsion, WorksAcrossABorderAsItsParticlesGain) {
  auto f = thermal_fluid(0);
  f.friction = 0;
  f.conduction = 0;
  f.heat_form = HeatForm::none;
  System system = system_of(f, start_of(f));
  const Slab region{0, 1.5};
  const double rate = flux::pair_rates(system, 2, region).work_of_repulsion;
  // The gain of the particles outside, by a short path: kinetic and internal energies and, of the
  // distance's part of the repulsion, potential shares.
  const auto outside = [&](System& at) {
    double sum = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (region.contains(system.state().position[i][2])) continue;
      sum += 0.5 * f.mass * at.state().velocity[i].squaredNorm() + at.state().internal_energy[i] +
             at.potential_shares()[i];
    }
    return sum;
  };
  constexpr double h = 1e-5;
  System forth = system, back = system;
  velocity_verlet(forth, h);
  velocity_verlet(back, -h);
  EXPECT_NEAR(rate, (outside(forth) - outside(back)) / (2 * h), 1e-5 * std::abs(rate));
  EXPECT_GT(std::abs(rate), 0.5);
}

std::string complaint_about(const FluidParameters& f) {
  try {
    (void)Fluid(f);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ThermalRepulsion, IsRefusedWhereItMakesNoSense) {
  auto f = thermal_fluid(1);
  f.thermal_repulsion = -1;
  EXPECT_EQ(complaint_about(f), "thermal_repulsion is -1, allowed is >= 0");
  f = thermal_fluid(1);
  f.heat_capacity_slope = 1;
  EXPECT_EQ(complaint_about(f),
            "thermal_repulsion is 20, allowed is 0 where a heat capacity follows the temperature");
  f = thermal_fluid(1, HeatForm::none);
  f.isothermal = true;
  EXPECT_EQ(complaint_about(f).find("thermal_repulsion is 20, allowed is 0 in an isothermal"), 0U);
}

}  // namespace
}  // namespace driftless::testing
