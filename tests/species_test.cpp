#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/math/distributions/beta.hpp>

#include "experiments/judge/wide_system.hpp"
#include "integrators/reference.hpp"
#include "integrators/shardlow.hpp"
#include "model/initial.hpp"
#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

// Several species: every method meets unlike masses, heat capacities and coefficients in its own
// pair updates.
namespace driftless::testing {
namespace {

constexpr double boltzmann = 0.5;
constexpr double step_size = 0.004;
constexpr std::uint64_t steps = 20;
constexpr double rounding = 1e-10;
constexpr double visible = 1e-9;

/// Two or three species: a heavy one, and a light one that holds less heat; coefficients by pairs.
FluidParameters several_species(FluidParameters f, unsigned count) {
  const auto pair = [&](unsigned a, unsigned b, double factor) {
    PairParameters p{a, b};
    if (f.has_repulsion()) p.repulsion = factor * f.repulsion;
    p.friction = factor * f.friction;
    if (f.has_conduction()) p.conduction = f.conduction / factor;
    return p;
  };
  f.further_species = {{.mass = 4 * f.mass, .heat_capacity = 1.5 * f.heat_capacity}};
  f.pairs = {pair(0, 1, 1.4), pair(1, 1, 0.6)};
  if (count == 2) return f;
  f.further_species.push_back({.mass = 0.5 * f.mass, .heat_capacity = 0.6 * f.heat_capacity});
  f.pairs.push_back(pair(2, 0, 0.5));
  f.pairs.push_back(pair(2, 1, 0.8));
  return f;
}

/// Gives particles their species by ids, and what they hold the temperatures that they had.
State with_species(const FluidParameters& f, State state) {
  const auto count = f.further_species.size() + 1;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto species = static_cast<std::uint8_t>(state.id[i] % count);
    state.species.push_back(species);
    if (species == 0) continue;
    state.internal_energy[i] *= f.further_species[species - 1].heat_capacity / f.heat_capacity;
  }
  return state;
}

/// What a method can run, with friction of every closure and every form of heat.
std::vector<Terms> terms_of(const Method& method) {
  std::vector<Terms> all;
  for (const bool potential : {false, true}) {
    for (const auto closure : method.closures) {
      for (const auto heat : all_heat_forms()) all.push_back({closure, heat, potential});
    }
    if (method.isothermal) {
      all.push_back({FrictionClosure::noise, HeatForm::none, potential, true});
    }
  }
  return all;
}

class Species : public ::testing::TestWithParam<const Method*> {};

TEST_P(Species, KeepMomentumAndEnergyAsClaimed) {
  const Method& method = *GetParam();
  for (const auto& terms : terms_of(method)) {
    for (const unsigned count : {2U, 3U}) {
      SCOPED_TRACE(terms.name());
      const auto f = several_species(small_fluid(terms, boltzmann), count);
      System system(Fluid(f), small_box(), with_species(f, small_state(f)), Noise(7, 0));
      const double energy = system.total_energy();
      const Vector momentum = system.momentum();
      const auto integrator = method.make({});
      run(*integrator, system, step_size, 1, steps + 1);
      EXPECT_LT((system.momentum() - momentum).norm(), rounding);
      if (terms.isothermal) continue;
      const double change = std::abs(system.total_energy() / energy - 1);
      const auto claim = terms.potential ? method.energy_with_potential : method.energy_ideal;
      if (claim == EnergyClaim::exact) {
        EXPECT_LT(change, rounding);
      } else {
        EXPECT_GT(change, visible);
      }
    }
  }
}

TEST_P(Species, OfEqualParametersAreOne) {
  const Method& method = *GetParam();
  double effect = 0;
  for (const auto& terms : terms_of(method)) {
    SCOPED_TRACE(terms.name());
    auto f = small_fluid(terms, boltzmann);
    const State one = run(method, f, small_state(f), step_size, steps);
    f.further_species = {{.mass = f.mass, .heat_capacity = f.heat_capacity}};
    const State two = run(method, f, with_species(f, small_state(f)), step_size, steps);
    EXPECT_LT(distance(small_box(), one, two).largest(), rounding);
    // And unlike ones are not.
    f.further_species[0].mass *= 1.001;
    const State unlike = run(method, f, with_species(f, small_state(f)), step_size, steps);
    effect = std::max(effect, distance(small_box(), one, unlike).largest());
  }
  EXPECT_GT(effect, 1e-6);
}

State end_of_wide_run(const Method& method, const FluidParameters& f, const State& start,
                      unsigned threads) {
  System system = judge::wide_system(f, start, threads);
  const auto integrator = method.make({});
  run(*integrator, system, step_size, 1, 4);
  return system.state();
}

TEST_P(Species, HaveTheSameBitsForAnyThreadsAndAnyStorage) {
  const Method& method = *GetParam();
  for (const bool isothermal : {false, true}) {
    if (isothermal && !method.isothermal) continue;
    auto f = judge::wide_fluid(method.closures[0]);
    f.isothermal = isothermal;
    if (isothermal) f.heat_form = HeatForm::none;
    if (isothermal) f.conduction = 0;
    f = several_species(f, 3);
    const State start = with_species(f, judge::wide_state(f));
    const State one = end_of_wide_run(method, f, start, 1);
    for (const unsigned threads : {2U, 4U}) {
      EXPECT_TRUE(judge::same_bits(one, end_of_wide_run(method, f, start, threads)));
    }
    const auto order = judge::shuffled_places(start.size(), 3);
    const State stored = judge::in_order(start, order);
    EXPECT_TRUE(
        judge::same_bits(judge::in_order(one, order), end_of_wide_run(method, f, stored, 1)));
  }
}

/// Towards the deterministic limit, k = 0.
TEST_P(Species, ConvergeToTheSolutionOfTheEquations) {
  const Method& method = *GetParam();
  if (!method.consistent) return;
  for (const bool isothermal : {false, true}) {
    if (isothermal && !method.isothermal) continue;
    const Terms terms = isothermal ? Terms{FrictionClosure::noise, HeatForm::none, false, true}
                                   : Terms{method.closures[0], HeatForm::inverse_temperature};
    const auto f = several_species(small_fluid(terms, 0), 3);
    const State start = with_species(f, small_state(f));
    const double duration = 0.4;
    // A bath's friction is that of the closure that does not ask for temperatures.
    auto equations = f;
    if (isothermal) {
      equations.isothermal = false;
      equations.friction_closure = FrictionClosure::friction;
    }
    State exact_start = start;
    if (isothermal) exact_start.internal_energy.assign(start.size(), 10);
    const State exact =
        reference_solution(Fluid(equations), small_box(), exact_start, false, duration);
    double errors[2];
    for (const int n : {0, 1}) {
      const int count = 200 << n;
      const State end = run(method, f, start, duration / count, static_cast<std::uint64_t>(count));
      auto found = distance(small_box(), end, exact);
      if (isothermal) found.internal_energy = 0;
      errors[n] = found.largest();
    }
    SCOPED_TRACE(terms.name());
    EXPECT_LT(errors[1], 0.05);
    EXPECT_GT(std::log2(errors[0] / errors[1]), method.noise_free_order - 0.2);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, Species, ::testing::ValuesIn(methods()), test_name);

// ---- The exact laws of each species. -----------------------------------------------------------

constexpr std::size_t particles = 12, count_of_species = 3, runs = 60;
constexpr int quartiles = 4;
// A Student variate from 60 independent runs is beyond this less than once in 10^9 times.
constexpr double bound = 7.5;

/// A dense ideal fluid of three species whose energies relax within a few units of time.
FluidParameters mixture(const Method& method, bool isothermal) {
  auto f = small_fluid({method.closures[0], HeatForm::inverse_temperature}, boltzmann);
  f.friction = 10;
  f.conduction = 30;
  f.isothermal = isothermal;
  if (isothermal) f.conduction = 0;
  return several_species(f, count_of_species);
}

/// What a run shows of one species, each over what the exact law has, less 1.
struct OfSpecies {
  double kinetic = -1;                                        ///< m v^2
  double inverse = -1;                                        ///< 1/theta
  std::array<double, quartiles> quarters = {-1, -1, -1, -1};  ///< of the law of u
};
using OfRun = std::array<OfSpecies, count_of_species>;

/// Averages of one run that starts in the exact law.
class MixtureRun {
 public:
  MixtureRun(const FluidParameters& f, std::size_t run)
      : fluid_(f), noise_(11, run), system_(start()), law_(law_of(system_.state())) {
    for (std::size_t i = 0; i < particles; ++i) mass_ += system_.mass(i);
    for (std::size_t s = 0; s < count_of_species; ++s) {
      const double phi = s == 0 ? f.heat_capacity : f.further_species[s - 1].heat_capacity;
      const double shape = phi / boltzmann + 1;
      const boost::math::beta_distribution<> share(shape, law_.total_shape() - shape);
      for (int n = 1; n < quartiles; ++n) edges_[s].push_back(quantile(share, 0.25 * n));
    }
  }

  OfRun averages(Integrator& integrator, double time_step, int count) {
    OfRun sums;
    for (int n = 1; n <= count; ++n) {
      system_.set_step(static_cast<std::uint64_t>(n));
      integrator.step(system_, time_step);
      for (std::size_t i = 0; i < particles; ++i) add(i, 1.0 / count, sums);
    }
    return sums;
  }
  System& system() { return system_; }

 private:
  System start() const {
    const Box box{Vector::Constant(2.2)};
    State state = place(box, Layout::fluid, Placement::random, particles, 0, noise_);
    for (std::size_t i = 0; i < particles; ++i) {
      state.species.push_back(static_cast<std::uint8_t>(i % count_of_species));
    }
    if (fluid_.isothermal()) {
      draw_canonical(fluid_, Layout::fluid, fluid_.parameters().temperature, noise_, state);
    } else {
      draw_microcanonical(fluid_, Layout::fluid, energy(law_of(state)), noise_, state);
    }
    return {fluid_, box, std::move(state), noise_};
  }

  void add(std::size_t i, double weight, OfRun& sums) const {
    const auto& state = system_.state();
    const auto species = state.species_of(i);
    auto& sum = sums[species];
    weight *= static_cast<double>(count_of_species) / particles;
    const double thermal = boltzmann * temperature();
    const double square = system_.mass(i) * state.velocity[i].squaredNorm();
    sum.kinetic += weight * square / (3 * thermal * (1 - system_.mass(i) / mass_));
    if (fluid_.isothermal()) return;
    const double u = state.internal_energy[i];
    const double theta = system_.equation_of_state(i).temperature(u);
    sum.inverse += weight / theta * law_.internal_temperature(energy(law_));
    const auto& edges = edges_[species];
    const auto quarter =
        std::upper_bound(edges.begin(), edges.end(), u / energy(law_)) - edges.begin();
    sum.quarters[static_cast<std::size_t>(quarter)] += weight * quartiles;
  }
  double temperature() const { return fluid_.parameters().temperature; }
  double energy(const MicrocanonicalLaw& law) const { return law.energy_at(temperature()); }
  MicrocanonicalLaw law_of(const State& state) const {
    return microcanonical_law(fluid_, Layout::fluid, particles, state.species);
  }

  Fluid fluid_;
  Noise noise_;
  System system_;
  MicrocanonicalLaw law_;
  double mass_ = 0;
  std::array<std::vector<double>, count_of_species> edges_;  ///< of the quarters of the law of u
};

/// The largest deviation of any average over the runs, in standard errors; the largest of these.
struct Clearest {
  double errors = 0, largest_error = 0;

  void take(const std::vector<double>& of_runs) {
    double mean = 0, squares = 0;
    const auto n = static_cast<double>(of_runs.size());
    for (const double value : of_runs) mean += value / n;
    for (const double value : of_runs) squares += (value - mean) * (value - mean);
    const double error = std::sqrt(squares / (n * (n - 1)));
    errors = std::max(errors, std::abs(mean) / error);
    largest_error = std::max(largest_error, error);
  }
};

template <class Make>
Clearest clearest_deviation(const FluidParameters& f, Make&& make, double time_step,
                            int count = 4000) {
  std::vector<OfRun> all;
  for (std::size_t n = 0; n < runs; ++n) {
    const auto integrator = make();
    all.push_back(MixtureRun(f, n).averages(*integrator, time_step, count));
  }
  Clearest clearest;
  const auto take = [&](auto&& value) {
    std::vector<double> of_runs;
    for (const auto& of_run : all) of_runs.push_back(value(of_run));
    clearest.take(of_runs);
  };
  for (std::size_t s = 0; s < count_of_species; ++s) {
    take([&](const OfRun& of_run) { return of_run[s].kinetic; });
    if (f.isothermal) continue;
    take([&](const OfRun& of_run) { return of_run[s].inverse; });
    for (std::size_t n = 0; n < quartiles; ++n) {
      take([&](const OfRun& of_run) { return of_run[s].quarters[n]; });
    }
  }
  return clearest;
}

Clearest clearest_deviation(const char* name, bool isothermal, double time_step) {
  const Method& method = *find_method(name);
  return clearest_deviation(
      mixture(method, isothermal), [&] { return method.make({}); }, time_step);
}

TEST(Mixture, HasTheLawOfEachSpecies) {
  for (const auto& [name, time_step] :
       {std::pair{"metropolized-splitting", 0.02}, std::pair{"shardlow-s1", 0.01},
        std::pair{"avalos-mackie-midpoint", 0.01}}) {
    const auto found = clearest_deviation(name, false, time_step);
    EXPECT_LT(found.errors, bound) << name;
    EXPECT_LT(found.largest_error, 0.03) << name;
  }
}

TEST(Mixture, IsothermalHasTheTemperatureOfTheBathInEachSpecies) {
  // Exact for pairs at any step, and so for ideal fluids.
  for (const auto& [name, time_step] :
       {std::pair{"shardlow-s1", 0.1}, std::pair{"lowe-andersen", 0.1}}) {
    const auto found = clearest_deviation(name, true, time_step);
    EXPECT_LT(found.errors, bound) << name;
    EXPECT_LT(found.largest_error, 0.02) << name;
  }
}

/// shardlow-s1 in which particles of all species weigh what those of the first do, as pairs see it.
class WrongReducedMass : public Integrator {
 public:
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    auto parameters = fluid.parameters();
    for (auto& species : parameters.further_species) species.mass = parameters.mass;
    const Fluid wrong(parameters);
    const auto wrong_law = [&](const PairLaw* law) {
      for (std::size_t i = 0; i < fluid.species(); ++i) {
        for (std::size_t j = 0; j < fluid.species(); ++j) {
          if (law == &fluid.law(i, j)) return i == j ? law : &wrong.law(i, j);
        }
      }
      throw std::logic_error("a pair of no kind");
    };
    system.sweep([&](const auto& pair) {
      auto seen = pair;
      seen.law = wrong_law(pair.law);
      return shardlow_friction(fluid, seen, dt, {});
    });
    system.move(dt);
  }
};

TEST(MixtureFaults, TheFirstSpeciesReducedMassForUnlikePairsIsSeen) {
  const Method& method = *find_method("shardlow-s1");
  const auto faulty = [] { return std::make_unique<WrongReducedMass>(); };
  EXPECT_GT(clearest_deviation(mixture(method, true), faulty, 0.3, 1000).errors, bound);
  // With internal energies it does not even keep the energy.
  MixtureRun run(mixture(method, false), 0);
  WrongReducedMass wrong;
  const double energy = run.system().total_energy();
  run.averages(wrong, 0.01, 10);
  EXPECT_GT(std::abs(run.system().total_energy() / energy - 1), 1e-4);
}

}  // namespace
}  // namespace driftless::testing
