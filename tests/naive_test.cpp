// The naive reference against the library: two programs of one scheme that share nothing but the
// parameters. Without noise they agree to rounding; with noise their statistics agree, on the way
// to equilibrium and in it, and a library at fault is told from the reference.

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "experiments/bench/naive.hpp"
#include "integrators/methods.hpp"
#include "integrators/shardlow.hpp"
#include "model/initial.hpp"

namespace driftless {
namespace {

constexpr double time_step = 0.01;
constexpr std::size_t particles = 375;  // at the density 3, five ranges a side

FluidParameters soft_fluid() {
  FluidParameters f;
  f.heat_capacity = 60;
  f.repulsion = 25;
  f.friction = 4.5;
  f.conduction = 1;
  f.heat_form = HeatForm::inverse_temperature;
  return f;
}

Box box_of(const FluidParameters& f) { return make_box(Fluid(f), Layout::fluid, particles, 3, 0); }

/// A lattice of particles all of one internal energy, with half of the kinetic energy of
/// equilibrium: so far from it that every exchange shows in what follows, and of the same total
/// energy in every replica, so that little else does.
State start_of(const FluidParameters& f, std::uint64_t replica) {
  const Noise noise(11, replica);
  State state = place(box_of(f), Layout::fluid, Placement::lattice, particles, 0, noise);
  const Fluid fluid(f);
  const double energy = microcanonical_law(fluid, Layout::fluid, particles).energy_at(1);
  draw_off_equilibrium(fluid, Layout::fluid, energy, noise, state);
  return state;
}

/// A step of the library.
using Step = std::function<void(System&)>;
/// What a planted fault does to a pair before the kernel sees it, on double or lanes.
struct NoFault {
  template <class P>
  P operator()(const P& pair) const {
    return pair;
  }
};
struct StrongFrictionNoise {
  double factor;
  template <class P>
  P operator()(P pair) const {
    pair.noise *= factor;
    return pair;
  }
};
/// Heat noise that has lost its sign always flows from j to i, from late to early ids.
struct HeatNoiseWithoutSign {
  template <class P>
  P operator()(P pair) const {
    using std::abs;
    pair.heat_noise = abs(pair.heat_noise);
    return pair;
  }
};

template <class Fault>
Step force_parallel(const Fault& fault) {
  return [fault, exchange = Exchange{}](System& system) mutable {
    const Fluid& fluid = system.fluid();
    system.accumulate(
        [&](const auto& pair) { return euler_exchange(fluid, fault(pair), time_step); }, exchange);
    system.move(time_step);
    system.apply(exchange);
  };
}

template <class Fault>
Step sequential(const Fault& fault) {
  return [fault](System& system) {
    const Fluid& fluid = system.fluid();
    system.sweep([&](const auto& pair) {
      const auto seen = fault(pair);
      auto total = shardlow_friction(fluid, seen, time_step, {});
      return total += euler_conduction(fluid, after(fluid, seen, total), time_step);
    });
    velocity_verlet(system, time_step);
  };
}

// The steps above are those of the methods.
TEST(Naive, ComparedStepsAreThoseOfTheMethods) {
  const auto f = soft_fluid();
  const std::pair<const char*, Step> steps[] = {{"averaged-drift", force_parallel(NoFault{})},
                                                {"shardlow-s1", sequential(NoFault{})}};
  for (const auto& [name, step] : steps) {
    System one(Fluid(f), box_of(f), start_of(f, 0), Noise(3, 0));
    System other(Fluid(f), box_of(f), start_of(f, 0), Noise(3, 0));
    step(one);
    find_method(name)->make({})->step(other, time_step);
    for (std::size_t i = 0; i < particles; ++i) {
      // To rounding alone, as the compiler may fuse the two differently.
      EXPECT_LT((one.state().velocity[i] - other.state().velocity[i]).norm(), 1e-12) << name;
      EXPECT_NEAR(one.state().internal_energy[i], other.state().internal_energy[i], 1e-11) << name;
    }
  }
}

// ---- Statistics

using Averages = std::map<std::string, double>;

/// Averages over particles of what both programs show of themselves.
class Sums {
 public:
  void add(const Vector& velocity, double internal_energy) {
    kinetic_ += 0.5 * velocity.squaredNorm();
    energy_ += internal_energy;
    squared_ += internal_energy * internal_energy;
    inverse_ += 1 / internal_energy;
  }
  /// Adds this moment's share to the averages over `moments` moments.
  void add_to(Averages& averages, const FluidParameters& f, double potential, std::size_t pairs,
              int moments) const {
    const double n = particles, mean = energy_ / n;
    const auto add = [&](const char* name, double value) { averages[name] += value / moments; };
    add("kinetic temperature", 2 * kinetic_ / (3 * (n - 1)));
    add("internal temperature", n / (inverse_ * f.heat_capacity));
    add("potential energy", potential / n);
    add("internal energy variance", squared_ / n - mean * mean);
    add("pairs", static_cast<double>(pairs) / n);
    add("total energy", (kinetic_ + energy_ + potential) / n);
  }

 private:
  double kinetic_ = 0, energy_ = 0, squared_ = 0, inverse_ = 0;
};

constexpr int replicas = 32, few_replicas = 8;
constexpr int steps = 100, first_measured = 40, every = 5;

bool is_measured(int step) { return step > first_measured && step % every == 0; }
constexpr int moments = (steps - first_measured) / every;

std::vector<Averages> run_naive(void (NaiveFluid::*step)(double)) {
  const auto f = soft_fluid();
  std::vector<Averages> all(replicas);
  for (int replica = 0; replica < replicas; ++replica) {
    const auto seed = static_cast<std::uint64_t>(1000 + replica);
    NaiveFluid fluid(f, box_of(f), start_of(f, static_cast<std::uint64_t>(replica)), seed);
    for (int n = 1; n <= steps; ++n) {
      (fluid.*step)(time_step);
      if (!is_measured(n)) continue;
      Sums sums;
      for (const auto& p : fluid.particles()) sums.add(p.velocity, p.internal_energy);
      sums.add_to(all[replica], f, fluid.potential_energy(), fluid.pairs(), moments);
    }
  }
  return all;
}

std::vector<Averages> run_library(const Step& step, int replicas_run = replicas) {
  const auto f = soft_fluid();
  std::vector<Averages> all(replicas_run);
  for (int replica = 0; replica < replicas_run; ++replica) {
    const auto number = static_cast<std::uint64_t>(replica);
    System system(Fluid(f), box_of(f), start_of(f, number), Noise(5, number));
    for (int n = 1; n <= steps; ++n) {
      system.set_step(static_cast<std::uint64_t>(n));
      step(system);
      if (!is_measured(n)) continue;
      Sums sums;
      for (std::size_t i = 0; i < particles; ++i) {
        sums.add(system.state().velocity[i], system.state().internal_energy[i]);
      }
      std::size_t pairs = 0;
      system.for_each_pair([&](const auto&) { ++pairs; });
      sums.add_to(all[replica], f, system.potential_energy(), pairs, moments);
    }
  }
  return all;
}

/// Mean of an observable over replicas, and the sum of squared deviations from it.
std::pair<double, double> mean_and_squares(const std::vector<Averages>& all,
                                           const std::string& name) {
  double mean = 0, squares = 0;
  for (const auto& averages : all) mean += averages.at(name) / static_cast<double>(all.size());
  for (const auto& averages : all) squares += std::pow(averages.at(name) - mean, 2);
  return {mean, squares};
}

/// Student's two-sample statistic of an observable. Replicas start in pairs from the same state,
/// which can only bring their means closer.
double student_t(const std::vector<Averages>& one, const std::vector<Averages>& other,
                 const std::string& name) {
  const double n = static_cast<double>(one.size()), m = static_cast<double>(other.size());
  const auto [mean_one, squares_one] = mean_and_squares(one, name);
  const auto [mean_other, squares_other] = mean_and_squares(other, name);
  const double variance = (squares_one + squares_other) / (n + m - 2);
  return (mean_one - mean_other) / std::sqrt(variance * (1 / n + 1 / m));
}

/// Six standard deviations, that is 2e-9 (two-sided), where the deviation itself is estimated.
double bound(std::size_t samples) {
  const boost::math::students_t law(static_cast<double>(samples) - 2);
  return boost::math::quantile(boost::math::complement(law, 1e-9));
}

/// The observable that differs most, and how much of the bound that is.
std::pair<double, std::string> worst(const std::vector<Averages>& one,
                                     const std::vector<Averages>& other) {
  std::pair<double, std::string> worst;
  for (const auto& [name, value] : one.front()) {
    const double t = std::abs(student_t(one, other, name)) / bound(one.size() + other.size());
    if (t > worst.first) worst = {t, name};
  }
  return worst;
}

/// The library agrees with the reference, in six observables at 2e-9 each; with a fault it does
/// not.
template <class MakeStep>
void compare(void (NaiveFluid::*naive_step)(double), MakeStep&& make_step, double strong) {
  const auto reference = run_naive(naive_step);
  const auto right = worst(run_library(make_step(NoFault{})), reference);
  EXPECT_LT(right.first, 1) << right.second;
  const auto noisy = worst(run_library(make_step(StrongFrictionNoise{strong})), reference);
  EXPECT_GT(noisy.first, 1) << "friction noise too strong, largest in " << noisy.second;
  const auto signless =
      worst(run_library(make_step(HeatNoiseWithoutSign{}), few_replicas), reference);
  EXPECT_GT(signless.first, 1) << "heat noise without sign, largest in " << signless.second;
}

// A false alarm in 1e8 runs. The total energy, which the scheme keeps in the mean alone, tells of
// friction noise 3 % too strong.
TEST(Naive, ForceParallelStepHasTheStatisticsOfAveragedDrift) {
  compare(
      &NaiveFluid::force_parallel_step, [](const auto& fault) { return force_parallel(fault); },
      1.03);
}

// A false alarm in 1e8 runs. As this scheme keeps the total energy, whatever its noise, it takes
// 6 % to be told.
TEST(Naive, SequentialStepHasTheStatisticsOfShardlowS1) {
  compare(
      &NaiveFluid::sequential_step, [](const auto& fault) { return sequential(fault); }, 1.06);
}

// ---- Without noise, to rounding

FluidParameters without_noise(FluidParameters f) {
  f.boltzmann = 0;
  return f;
}

/// Largest difference of positions, velocities and internal energies after a few steps.
double difference(const FluidParameters& naive_parameters, const FluidParameters& parameters,
                  const Box& box, const State& start, void (NaiveFluid::*naive_step)(double),
                  const char* method) {
  NaiveFluid naive(naive_parameters, box, start, 1);
  System system(Fluid(parameters), box, start, Noise(1, 0));
  const auto integrator = find_method(method)->make({});
  double largest = 0;
  for (std::uint64_t step = 1; step <= 5; ++step) {
    (naive.*naive_step)(time_step);
    system.set_step(step);
    integrator->step(system, time_step);
  }
  for (std::size_t i = 0; i < start.size(); ++i) {
    const auto& p = naive.particles()[i];
    const auto& state = system.state();
    largest = std::max({largest, (box.minimum_image(p.position - state.position[i])).norm(),
                        (p.velocity - state.velocity[i]).norm(),
                        std::abs(p.internal_energy - state.internal_energy[i])});
  }
  return largest;
}

// Energies are of order 60 and sums run over a dozen pairs: rounding stays below 1e-12 a step.
constexpr double rounding = 1e-11;
constexpr double slightly = 1 + 1e-7;  // what a parameter at fault is off by

/// Random positions, and internal energies that differ.
State varied_start(const FluidParameters& f) {
  const Noise noise(12, 0);
  State state = place(box_of(f), Layout::fluid, Placement::random, particles, 0, noise);
  const Fluid fluid(f);
  const double energy = microcanonical_law(fluid, Layout::fluid, particles).energy_at(1);
  draw_microcanonical(fluid, Layout::fluid, energy, noise, state);
  return state;
}

TEST(Naive, ForceParallelStepIsAveragedDriftWhereNothingFluctuates) {
  const auto f = soft_fluid();
  const auto start = varied_start(f);
  const auto quiet = without_noise(f);
  const auto compare_to = [&](const FluidParameters& other) {
    return difference(quiet, other, box_of(f), start, &NaiveFluid::force_parallel_step,
                      "averaged-drift");
  };
  EXPECT_LT(compare_to(quiet), rounding);
  for (const auto parameter :
       {&FluidParameters::repulsion, &FluidParameters::friction, &FluidParameters::conduction}) {
    auto faulty = quiet;
    faulty.*parameter *= slightly;
    EXPECT_GT(compare_to(faulty), rounding);
  }
}

// Isolated pairs, so that the order of pairs is of no account.
TEST(Naive, SequentialStepIsShardlowS1WhereNothingFluctuates) {
  const auto f = soft_fluid();
  const Fluid fluid(f);
  const Noise noise(13, 0);
  const Box box = make_box(fluid, Layout::pairs, 100, 0, 0.5);
  State start = place(box, Layout::pairs, Placement::lattice, 100, 0.5, noise);
  draw_given_spread(fluid, Layout::pairs, 0.5, 1, noise, start);
  for (std::size_t i = 0; i < start.size(); ++i) {
    start.internal_energy[i] *= 1 + 0.01 * static_cast<double>(i);
  }
  const auto quiet = without_noise(f);
  const auto compare_to = [&](const FluidParameters& other) {
    return difference(quiet, other, box, start, &NaiveFluid::sequential_step, "shardlow-s1");
  };
  EXPECT_LT(compare_to(quiet), rounding);
  for (const auto parameter :
       {&FluidParameters::repulsion, &FluidParameters::friction, &FluidParameters::conduction}) {
    auto faulty = quiet;
    faulty.*parameter *= slightly;
    EXPECT_GT(compare_to(faulty), rounding);
  }
}

// ---- Pairs

TEST(Naive, FindsEveryPairOnce) {
  const auto f = soft_fluid();
  const auto start = varied_start(f);
  const Box box = box_of(f);
  double potential = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < particles; ++i) {
    for (std::size_t j = i + 1; j < particles; ++j) {
      const double r = box.minimum_image(start.position[i] - start.position[j]).norm();
      if (r >= 1) continue;
      ++pairs;
      potential += Fluid(f).potential(r);
    }
  }
  NaiveFluid naive(f, box, start, 1);
  EXPECT_EQ(naive.pairs(), pairs);
  EXPECT_NEAR(naive.potential_energy(), potential, 1e-9 * potential);
}

TEST(Naive, RefusesWhatItDoesNotKnow) {
  const auto f = soft_fluid();
  const auto start = varied_start(f);
  const auto make = [&](const FluidParameters& other, double length) {
    NaiveFluid(other, {Vector::Constant(length)}, start, 1);
  };
  EXPECT_NO_THROW(make(f, 5));
  EXPECT_THROW(make(f, 2.9), std::invalid_argument);
  auto other = f;
  other.friction_closure = FrictionClosure::friction;
  EXPECT_THROW(make(other, 5), std::invalid_argument);
  other = f;
  other.heat_form = HeatForm::temperature;
  EXPECT_THROW(make(other, 5), std::invalid_argument);
  other = f;
  other.heat_range = 1.1;
  EXPECT_THROW(make(other, 5), std::invalid_argument);
}

}  // namespace
}  // namespace driftless
