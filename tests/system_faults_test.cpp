#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "tests/small_system.hpp"

// What is left behind by a copy, an exception or a failed step does not show in what follows.
namespace driftless::testing {
namespace {

Box some_cells() { return {Vector(8.3, 6.4, 4.7)}; }
Box one_cell() { return {Vector::Constant(3.5)}; }

System random_system(const Box& box) {
  const auto f = small_fluid({FrictionClosure::noise, HeatForm::temperature, true}, 0.1);
  Uniform uniform(1);
  State state;
  for (std::uint32_t i = 0; i < 700; ++i) {
    state.position.push_back(uniform.vector(0, 1).cwiseProduct(box.lengths));
    state.velocity.push_back(uniform.vector(-1, 1));
    state.internal_energy.push_back(uniform(10, 14));
    state.id.push_back(i);
  }
  return System(Fluid(f), box, std::move(state), Noise(1, 1));
}
System cells_system() { return random_system(some_cells()); }

std::vector<double> distances(System& system, FunctionReference<void()> meanwhile) {
  std::vector<double> all;
  system.for_each_pair([&](const System::Geometry& g) {
    if (all.empty()) meanwhile();
    all.push_back(g.r);
  });
  return all;
}

TEST(SystemCopies, ShareNoMemory) {
  System system = cells_system();
  const auto alone = distances(system, [] {});
  System copy = system;
  copy.move(0.3);
  EXPECT_EQ(distances(system, [&] { distances(copy, [] {}); }), alone);
}

TEST(Accumulate, SeesNoUniformVariatesOfEarlierSweeps) {
  System system = cells_system();
  const auto uniform = [](const auto& pair) { return Transfer{pair.uniform}; };
  Exchange before, after;
  system.accumulate(uniform, before);
  system.sweep([](const auto& pair) { return Transfer{0 * pair.v}; }, {.uniforms = true});
  system.accumulate(uniform, after);
  EXPECT_EQ(after.momentum, before.momentum);
}

TEST(Accumulate, StartsAnewAfterAKernelThatThrew) {
  System system = cells_system();
  const auto kernel = [](const auto& pair) { return Transfer{pair.v}; };
  Exchange before, after;
  system.accumulate(kernel, before);
  int calls = 0;
  const auto throwing = [&](const Pair<double>&) -> Transfer<double> {
    if (++calls == 1500) throw 1;
    return {100.0};
  };
  EXPECT_THROW(system.accumulate(throwing, after), int);
  system.accumulate(kernel, after);
  EXPECT_EQ(after.momentum, before.momentum);
}

TEST(Accumulate, KeepsNoNormalsOfAKernelThatThrew) {
  // One block of many pairs: its first ones are drawn, the others not.
  System system = random_system(one_cell()), other = random_system(one_cell());
  const auto kernel = [](const auto& start, const auto& end) {
    return Transfer{start.noise + end.heat_noise};
  };
  Exchange expected, total;
  other.accumulate(other.motion(), kernel, expected);
  const auto throwing = [](const Pair<double>&, const TrialPair<double>&) -> Transfer<double> {
    throw 1;
  };
  EXPECT_THROW(system.accumulate(system.motion(), throwing, total), int);
  system.accumulate(system.motion(), kernel, total);
  EXPECT_EQ(total.momentum, expected.momentum);
}

TEST(StepFailureDeathTest, LeavesAStateThatCanBeLookedAt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto look = [] {
    System system = cells_system();
    Motion motion = system.motion();
    motion.velocity[7][0] = std::numeric_limits<double>::quiet_NaN();
    try {
      system.set_motion(motion);
    } catch (const StepFailure&) {
    }
    try {
      system.move(0.1);
    } catch (const StepFailure&) {
    }
    try {
      system.potential_energy();
    } catch (const StepFailure&) {
    }
    std::exit(0);
  };
  EXPECT_EXIT(look(), ::testing::ExitedWithCode(0), "");
}

// Blocks are cut by how many particles there are, which the grid knows before it has sorted them.
TEST(CellGrid, KnowsTheNumberOfParticlesFromTheStart) {
  EXPECT_EQ(CellGrid(some_cells(), 1, 700).particles(), 700U);
}

}  // namespace
}  // namespace driftless::testing
