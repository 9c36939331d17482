#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "experiments/judge/wide_system.hpp"
#include "tests/small_system.hpp"

// Threads, lanes and the places of particles in memory are nobody's business: a path is the same,
// to the last bit where nothing but the way of working differs. The system has several tiles of
// cells along each axis. That every method keeps to this is in invariants_test.
namespace driftless::testing {
namespace {

using judge::wide_box;
using judge::wide_fluid;
using judge::wide_state;
using judge::wide_system;

constexpr double time_step = 0.01;
constexpr std::uint64_t steps = 6;

State path(const Method& method, const FluidParameters& f, const State& start, unsigned threads) {
  System system = wide_system(f, start, threads);
  const auto integrator = method.make({});
  run(*integrator, system, time_step, 1, steps + 1);
  return system.state();
}

/// So many that tiles are cut along every axis.
TEST(Threads, OfManyParticlesTakeTheSamePath) {
  const Box box{Vector(17, 15.5, 16.2)};
  const auto f = wide_fluid(FrictionClosure::noise);
  State start;
  Uniform uniform(13);
  for (std::uint32_t i = 0; i < 12000; ++i) {
    start.position.push_back(uniform.vector(0, 1).cwiseProduct(box.lengths));
    start.velocity.push_back(uniform.vector(-1.5, 1.5));
    start.internal_energy.push_back(f.heat_capacity * f.temperature);
    start.id.push_back(i);
  }
  for (const auto* name : {"averaged-drift", "avalos-mackie-implicit", "shardlow-s2"}) {
    State alone;
    for (const unsigned threads : {1U, 3U}) {
      System system(Fluid(f), box, start, Noise(5, 1));
      system.set_threads(threads);
      const auto integrator = find_method(name)->make({});
      run(*integrator, system, time_step, 1, 3);
      if (threads == 1) alone = system.state();
      EXPECT_TRUE(same_bits(system.state(), alone)) << name;
    }
    EXPECT_GT(distance(box, alone, start).velocity, 0.1);
  }
}

TEST(SameBits, AreNotThoseOfASlightlyOtherStart) {
  const auto f = wide_fluid(FrictionClosure::noise);
  State start = wide_state(f);
  const auto& method = *find_method("shardlow-s1");
  const State end = path(method, f, start, 1);
  start.velocity[17][1] += 1e-9;
  EXPECT_FALSE(same_bits(path(method, f, start, 1), end));
}

// ---- Kernels in lanes and one by one. -----------------------------------------------------------

/// Every quantity that a pair sees leaves its trace.
template <class V>
Transfer<V> trace(const Pair<V>& p) {
  using std::exp;
  using std::sqrt;
  return {0.01 * (p.v + p.noise + p.r * p.u_i - p.w_heat * p.u_j),
          0.01 * (p.heat_noise + sqrt(p.u_i) * p.w_friction + p.v + p.uniform),
          0.02 * (p.noise - p.v + exp(-p.r) + p.heat_uniform)};
}
constexpr auto in_lanes = [](const auto& pair) { return trace(pair); };
constexpr auto one_by_one = [](const Pair<double>& pair) { return trace(pair); };

TEST(Kernels, AnswerInLanesAsTheyDoOneByOne) {
  const auto f = wide_fluid(FrictionClosure::friction);
  System system = wide_system(f, wide_state(f));
  Exchange lanes, single;
  system.accumulate(in_lanes, lanes, 2);
  system.accumulate(one_by_one, single, 2);
  for (std::size_t i = 0; i < system.size(); ++i) {
    EXPECT_LT((lanes.momentum[i] - single.momentum[i]).norm(), 1e-11);
    EXPECT_NEAR(lanes.energy[i], single.energy[i], 1e-11);
  }
}

/// The temperature of the first species, whose heat capacity is not constant where that of the pair
/// may be.
template <class V>
Transfer<V> trace_of_first_species(const Fluid& fluid, const Pair<V>& p) {
  const V theta = fluid.temperature(p.u_i);
  return {0.01 * p.v * theta, 0.01 * theta, -0.01 * theta};
}

TEST(Kernels, SeeTheLawsOfTheFirstSpeciesInPairsOfOthers) {
  auto f = wide_fluid(FrictionClosure::noise);
  f.heat_capacity_slope = 40;
  f.further_species = {{.mass = 1, .heat_capacity = 60}};
  State start = wide_state(f);
  for (std::size_t i = 0; i < start.size(); ++i) start.species.push_back(i % 2);
  System system = wide_system(f, start);
  const Fluid& fluid = system.fluid();
  Exchange lanes, single;
  system.accumulate([&](const auto& pair) { return trace_of_first_species(fluid, pair); }, lanes);
  system.accumulate([&](const Pair<double>& pair) { return trace_of_first_species(fluid, pair); },
                    single);
  double largest = 0;
  for (std::size_t i = 0; i < system.size(); ++i) {
    EXPECT_NEAR(lanes.energy[i], single.energy[i], 1e-11);
    EXPECT_LT((lanes.momentum[i] - single.momentum[i]).norm(), 1e-11);
    largest = std::max(largest, std::abs(single.energy[i]));
  }
  EXPECT_GT(largest, 1e-3);
}

/// A sweep over pairs in a given order, by hand.
State swept(const System& system, const std::vector<System::Geometry>& pairs, const Sweep& how) {
  const Noise noise(5, 1);
  State s = system.state();
  const State start = s;
  for (const auto& g : pairs) {
    const bool frozen = how.energies == SweepEnergies::frozen;
    const auto normals = noise.pair_normals(s.id[g.i], s.id[g.j], how.stage, true, true);
    const auto uniforms = noise.pair_uniforms(s.id[g.i], s.id[g.j], how.stage);
    const State& seen = frozen ? start : s;
    const auto transfer = trace<double>(
        {g.r, g.w_friction, g.w_heat, (s.velocity[g.i] - s.velocity[g.j]).dot(g.e),
         seen.internal_energy[g.i], seen.internal_energy[g.j], normals.friction, normals.heat,
         how.uniforms ? uniforms.friction : 1, how.uniforms ? uniforms.heat : 1});
    const Vector change = transfer.momentum / system.fluid().mass() * g.e;
    s.velocity[g.i] += change;
    s.velocity[g.j] -= change;
    s.internal_energy[g.i] += transfer.energy_i;
    s.internal_energy[g.j] += transfer.energy_j;
  }
  return s;
}

std::vector<System::Geometry> pairs_by_ids(System& system) {
  std::vector<System::Geometry> pairs;
  system.for_each_pair([&](const System::Geometry& g) { pairs.push_back(g); });
  const auto& id = system.state().id;
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return std::pair(id[a.i], id[a.j]) < std::pair(id[b.i], id[b.j]);
  });
  return pairs;
}

TEST(Sweeps, ByIdsAreWhatALoopOverPairsDoes) {
  const auto f = wide_fluid(FrictionClosure::noise);
  for (const auto energies : {SweepEnergies::fresh, SweepEnergies::frozen}) {
    for (const auto order : {SweepOrder::forward, SweepOrder::reverse}) {
      for (const bool uniforms : {false, true}) {
        System system = wide_system(f, wide_state(f));
        auto pairs = pairs_by_ids(system);
        if (order == SweepOrder::reverse) std::reverse(pairs.begin(), pairs.end());
        const Sweep how{.order = order,
                        .sequence = SweepSequence::by_ids,
                        .stage = 3,
                        .energies = energies,
                        .uniforms = uniforms};
        const State expected = swept(system, pairs, how);
        System coloured = wide_system(f, wide_state(f));
        system.sweep(in_lanes, how);
        EXPECT_LT(distance(wide_box(), system.state(), expected).largest(), 1e-10);
        coloured.sweep(in_lanes,
                       {.order = order, .stage = 3, .energies = energies, .uniforms = uniforms});
        EXPECT_GT(distance(wide_box(), coloured.state(), expected).largest(), 1e-6);
      }
    }
  }
}

TEST(Sweeps, ByIdsDoNotSeeWhereTheCellsAreAndColouredOnesDo) {
  const auto f = wide_fluid(FrictionClosure::noise);
  const Vector shift(0.37, 1.21, -0.64);
  const State start = wide_state(f);
  State moved = start;
  for (auto& position : moved.position) position += shift;
  for (const auto* order : {"ids", "coloured"}) {
    const Options options = {{"order", std::string(order)}};
    const auto end = [&](const State& from) {
      System system = wide_system(f, from);
      const auto integrator = find_method("shardlow-s1")->make(options);
      run(*integrator, system, time_step, 1, steps + 1);
      return system.state();
    };
    State back = end(moved);
    for (auto& position : back.position) position -= shift;
    const double apart = distance(wide_box(), back, end(start)).largest();
    if (std::string(order) == "ids") {
      EXPECT_LT(apart, 1e-9);
    } else {
      EXPECT_GT(apart, 1e-6);
    }
  }
}

TEST(Sweeps, InReverseUndoWhatASweepForwardDid) {
  // Each pair turns its relative velocity round, which undoes itself.
  const auto f = wide_fluid(FrictionClosure::noise);
  const double mu = Fluid(f).reduced_mass();
  const auto turn = [&](const auto& pair) { return Transfer{-2 * mu * pair.v}; };
  for (const auto sequence : {SweepSequence::coloured, SweepSequence::by_ids}) {
    for (const unsigned threads : {1U, 4U}) {
      const State start = wide_state(f);
      System system = wide_system(f, start, threads);
      system.sweep(turn, {.sequence = sequence});
      EXPECT_GT(distance(wide_box(), system.state(), start).velocity, 1);
      System wrong = system;
      system.sweep(turn, {.order = SweepOrder::reverse, .sequence = sequence});
      EXPECT_LT(distance(wide_box(), system.state(), start).velocity, 1e-12);
      wrong.sweep(turn, {.sequence = sequence});
      EXPECT_GT(distance(wide_box(), wrong.state(), start).velocity, 1);
    }
  }
}

}  // namespace
}  // namespace driftless::testing
