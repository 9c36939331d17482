// The order of storage, which follows the cells in large systems.

#include <gtest/gtest.h>

#include "integrators/integrator.hpp"
#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

const Box box{Vector::Constant(16)};

FluidParameters fluid_of(FrictionClosure closure) {
  return small_fluid({closure, HeatForm::temperature, true}, 0.01);
}

/// So many that storage may change its order, at random places.
State large_state() {
  State state;
  Uniform uniform(11);
  for (std::uint32_t i = 0; i < 12000; ++i) {
    state.position.push_back(uniform.vector(0, 16));
    state.velocity.push_back(uniform.vector(-1, 1));
    state.internal_energy.push_back(uniform(20, 30));
    state.id.push_back(i);
  }
  return state;
}

System large_system(FrictionClosure closure = FrictionClosure::friction) {
  return {Fluid(fluid_of(closure)), box, large_state(), Noise(4, 2)};
}

template <class Values>
Values by_ids(const State& state, const Values& values) {
  Values ordered(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) ordered[state.id[i]] = values[i];
  return ordered;
}

/// The same bits, whatever the order of storage.
void expect_same(const State& a, const State& b) {
  EXPECT_EQ(by_ids(a, a.position), by_ids(b, b.position));
  EXPECT_EQ(by_ids(a, a.velocity), by_ids(b, b.velocity));
  EXPECT_EQ(by_ids(a, a.internal_energy), by_ids(b, b.internal_energy));
}

/// The share of particles whose successor in storage is near.
double share_beside_near(const State& state) {
  double near = 0;
  for (std::size_t i = 1; i < state.size(); ++i) {
    near += (state.position[i] - state.position[i - 1]).norm() < 2;
  }
  return near / static_cast<double>(state.size());
}

TEST(Storage, ComesIntoTheOrderOfCellsUnnoticedByPairs) {
  const auto noise_free = [](const auto& p) {
    return Transfer{0.01 * p.v * p.w_friction, 0.01 * (p.u_j - p.u_i), 0.01 * (p.u_i - p.u_j)};
  };
  for (const unsigned threads : {1U, 3U}) {
    System ordered = large_system(), other = large_system();
    ordered.set_threads(threads);
    const auto force = ordered.conservative_force();  // still in the order of ids
    const auto evaluated = ordered.counters().pair_evaluations;
    const Places places = ordered.order_storage();
    const State state = ordered.state();
    EXPECT_EQ(state.id, places);
    EXPECT_LT(share_beside_near(other.state()), 0.05);
    EXPECT_GT(share_beside_near(state), 0.9);
    expect_same(state, other.state());
    EXPECT_EQ(by_ids(state, ordered.conservative_force()), force);
    EXPECT_EQ(ordered.counters().pair_evaluations, evaluated);
    Exchange total, expected;
    ordered.accumulate(noise_free, total);
    other.accumulate(noise_free, expected);
    EXPECT_EQ(by_ids(state, total.momentum), expected.momentum);
    EXPECT_EQ(by_ids(state, total.energy), expected.energy);
    ordered.move(0.01), other.move(0.01);
    ordered.sweep(noise_free), other.sweep(noise_free);
    expect_same(ordered.state(), other.state());
  }
}

/// Four steps, before the third of which storage is due to be ordered, or is not.
State after_four_steps(const Method& method, bool ordered) {
  System system = large_system(method.closures.front());
  const auto integrator = method.make({});
  for (std::uint64_t step = 49; step < 53; ++step) {
    if (ordered) {
      begin_step(system, *integrator, step);
    } else {
      system.set_step(step);
    }
    integrator->step(system, 1e-4);
  }
  return system.state();
}

class StorageOfMethod : public ::testing::TestWithParam<const Method*> {};

TEST_P(StorageOfMethod, TakesAlongWhatIsKeptBetweenSteps) {
  const State ordered = after_four_steps(*GetParam(), true);
  EXPECT_GT(share_beside_near(ordered), 0.8);
  expect_same(ordered, after_four_steps(*GetParam(), false));
}

INSTANTIATE_TEST_SUITE_P(Methods, StorageOfMethod, ::testing::ValuesIn(methods()), test_name);

/// Keeps something between steps that it does not bring along.
class Remembering : public Integrator {
 public:
  void step(System& system, double) override { kept_.assign(system.size(), 1.0); }
  std::vector<double> save() const override { return kept_; }

 private:
  std::vector<double> kept_;
};

TEST(Storage, StaysForIntegratorsThatKeepWhatDoesNotComeAlong) {
  Remembering integrator;
  System system = large_system();
  integrator.step(system, 0);
  begin_step(system, integrator, 51);
  EXPECT_EQ(system.state().id, large_state().id);
}

TEST(Storage, OfFewParticlesAndOfFrozenOnesStays) {
  const auto integrator = find_method("shardlow-s1")->make({});
  const auto f = fluid_of(FrictionClosure::noise);
  const State few_at_start = small_state(f);
  System few(Fluid(f), small_box(), few_at_start, Noise(4, 2));
  begin_step(few, *integrator, 51);
  EXPECT_EQ(few.state().id, few_at_start.id);
  System frozen(Fluid(f), box, large_state(), Noise(4, 2), true);
  begin_step(frozen, *integrator, 51);
  EXPECT_EQ(frozen.state().id, large_state().id);
}

}  // namespace
}  // namespace driftless::testing
