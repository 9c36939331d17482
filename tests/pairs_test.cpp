#include "model/pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

struct Expected {
  std::uint32_t id_i, id_j;
  Vector difference;
};

/// Every pair by a double loop over the 27 nearest images, in the order of ids.
std::vector<Expected> double_loop(const Box& box, double range, const State& state) {
  std::vector<std::uint32_t> place(state.size());
  for (std::uint32_t p = 0; p < state.size(); ++p) place[p] = p;
  std::sort(place.begin(), place.end(), [&](auto a, auto b) { return state.id[a] < state.id[b]; });
  std::vector<Expected> all;
  for (std::size_t a = 0; a < place.size(); ++a) {
    for (std::size_t b = a + 1; b < place.size(); ++b) {
      const Vector apart = state.position[place[a]] - state.position[place[b]];
      Vector shortest = apart;
      for (int image = 0; image < 27; ++image) {
        const Vector shift(image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1);
        const Vector other = apart + shift.cwiseProduct(box.lengths);
        if (other.squaredNorm() < shortest.squaredNorm()) shortest = other;
      }
      if (shortest.norm() < range) {
        all.push_back({state.id[place[a]], state.id[place[b]], shortest});
      }
    }
  }
  return all;
}

/// What is wrong with the found pairs; empty if nothing. A pair within rounding of the range may be
/// found or not.
std::string fault(const std::vector<PairSearch::Found>& found, const Box& box, double range,
                  const State& state) {
  const auto expected = double_loop(box, range * (1 - 1e-13), state);
  std::size_t n = 0;
  for (const auto& pair : found) {
    const bool marginal = std::abs(std::sqrt(pair.squared_distance) / range - 1) < 1e-13;
    if (n == expected.size() || state.id[pair.i] != expected[n].id_i ||
        state.id[pair.j] != expected[n].id_j) {
      if (marginal) continue;
      return "pair " + std::to_string(n) + " is not the expected one";
    }
    if ((pair.difference - expected[n].difference).norm() > 1e-12) return "a wrong difference";
    if (std::abs(pair.squared_distance - pair.difference.squaredNorm()) > 1e-14) {
      return "a wrong distance";
    }
    ++n;
  }
  return n == expected.size() ? "" : "pairs are missing";
}

State random_state(Uniform& uniform, const Box& box, std::size_t particles) {
  State state;
  for (std::uint32_t i = 0; i < particles; ++i) {
    Vector position = uniform.vector(0, 1).cwiseProduct(box.lengths);
    // Some on an edge, some a hair below the upper one, some on the edges of thirds.
    for (int axis = 0; axis < 3; ++axis) {
      const double chance = uniform();
      const double length = box.lengths[axis];
      if (chance < 0.05) position[axis] = 0;
      if (chance > 0.95) position[axis] = std::nextafter(length, 0);
      if (chance > 0.45 && chance < 0.5) position[axis] = length / 3;
    }
    state.position.push_back(position);
    state.velocity.push_back(Vector::Zero());
    state.internal_energy.push_back(1);
    state.id.push_back(i);
  }
  std::shuffle(state.id.begin(), state.id.end(), uniform.engine());
  return state;
}

struct Scenery {
  const char* name;
  Vector smallest, largest;  ///< lengths of the box over the range
  std::size_t most_particles;
};

const Scenery sceneries[] = {
    {"two to three ranges a side", {2, 2, 2}, {3, 3, 3}, 80},
    {"exactly two ranges a side", {2, 2, 2}, {2, 2, 2}, 60},
    {"exactly three ranges a side", {3, 3, 3}, {3, 3, 3}, 120},
    {"three to five ranges a side", {3, 3, 3}, {5, 5, 5}, 250},
    {"a column", {2, 3, 8}, {3, 4, 12}, 300},
    {"a plate", {3, 9, 9}, {4, 12, 12}, 300},
    {"many cells", {8, 8, 8}, {11, 11, 11}, 500},
    {"far more cells than particles", {40, 40, 40}, {2000, 2000, 2000}, 60},
};

TEST(PairSearch, FindsWhatADoubleLoopFinds) {
  Uniform uniform(3);
  for (const auto& scenery : sceneries) {
    SCOPED_TRACE(scenery.name);
    for (int repeat = 0; repeat < 25; ++repeat) {
      const double range = uniform(0.1, 3);
      Box box{scenery.smallest};
      box.lengths += uniform.vector(0, 1).cwiseProduct(scenery.largest - scenery.smallest);
      box.lengths *= range;
      const std::size_t particles = uniform.below(scenery.most_particles + 1);
      PairSearch search(box, range, particles);
      // The same object twice: nothing of the first configuration may stay.
      for (int again = 0; again < 2; ++again) {
        const State state = random_state(uniform, box, particles);
        ASSERT_EQ(fault(search.find(state), box, range, state), "") << "repeat " << repeat;
      }
    }
  }
}

TEST(PairSearch, ThatFindsNoNeighboursWouldBeNoticed) {
  Uniform uniform(4);
  const Box box{Vector::Constant(4)};
  const State state = random_state(uniform, box, 100);
  PairSearch search(box, 1, 100);
  const auto found = search.find(state);
  ASSERT_EQ(fault(found, box, 1, state), "");
  ASSERT_GT(found.size(), 10U);
  for (std::size_t n = 0; n < found.size(); ++n) {
    auto fewer = found, reversed = found, repeated = found;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(n));
    reversed[n].difference *= -1;
    repeated.push_back(found[n]);
    EXPECT_NE(fault(fewer, box, 1, state), "");
    EXPECT_NE(fault(reversed, box, 1, state), "");
    EXPECT_NE(fault(repeated, box, 1, state), "");
    if (n == 0) continue;
    auto swapped = found;
    std::swap(swapped[n - 1], swapped[n]);
    EXPECT_NE(fault(swapped, box, 1, state), "");
  }
}

TEST(PairSearch, DoesNotDependOnTheOrderOfStorage) {
  Uniform uniform(5);
  const Box box{Vector(4.5, 3.2, 6)};
  const State state = random_state(uniform, box, 150);
  std::vector<std::size_t> order(150);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), uniform.engine());
  State permuted = state;
  for (std::size_t n = 0; n < order.size(); ++n) {
    permuted.position[n] = state.position[order[n]];
    permuted.id[n] = state.id[order[n]];
  }
  PairSearch one(box, 1, 150), two(box, 1, 150);
  const auto& a = one.find(state);
  const auto& b = two.find(permuted);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(state.id[a[n].i], permuted.id[b[n].i]);
    EXPECT_EQ(state.id[a[n].j], permuted.id[b[n].j]);
    EXPECT_LT((a[n].difference - b[n].difference).norm(), 1e-14);
  }
}

TEST(PairSearch, RefusesABoxShorterThanTwiceTheRange) {
  EXPECT_THROW(PairSearch(Box{Vector(5, 1.99, 5)}, 1, 10), std::invalid_argument);
  EXPECT_NO_THROW(PairSearch(Box{Vector(5, 2, 5)}, 1, 10));
}

TEST(PairSearch, FindsNothingWithoutARangeOrWithoutParticles) {
  Uniform uniform(6);
  const Box box{Vector::Constant(1)};
  const State state = random_state(uniform, box, 20);
  EXPECT_TRUE(PairSearch(box, 0, 20).find(state).empty());
  EXPECT_TRUE(PairSearch(box, 0.3, 0).find(State{}).empty());
  EXPECT_TRUE(PairSearch(box, 0.3, 1).find(random_state(uniform, box, 1)).empty());
}

TEST(PairList, GivesTheDirectionFromJToIAndTheWeights) {
  Uniform uniform(7);
  const Fluid fluid(small_fluid({FrictionClosure::noise, HeatForm::temperature, true}, 1));
  const Box box = small_box();
  const State state = random_state(uniform, box, 60);
  PairList pairs(box, fluid, 60);
  pairs.update(state, fluid, 1);
  ASSERT_GT(pairs.size(), 20U);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const auto& g = pairs.geometry(n);
    EXPECT_LT(state.id[g.i], state.id[g.j]);
    EXPECT_NEAR(g.e.norm(), 1, 1e-14);
    // Walking from j along e for the distance r leads to i.
    const Vector end = state.position[g.j] + g.r * g.e;
    EXPECT_LT(box.minimum_image(end - state.position[g.i]).norm(), 1e-14);
    EXPECT_EQ(g.w_friction, fluid.friction_weight(g.r));
    EXPECT_EQ(g.w_heat, fluid.heat_weight(g.r));
  }
}

TEST(PairList, LeavesOutParticlesInOnePlace) {
  const Fluid fluid(small_fluid({}, 1));
  State state;
  for (std::uint32_t i = 0; i < 3; ++i) {
    state.position.push_back(i < 2 ? Vector(1, 1, 1) : Vector(1.5, 1, 1));
    state.id.push_back(i);
  }
  PairList pairs(small_box(), fluid, 3);
  pairs.update(state, fluid, 1);
  EXPECT_EQ(pairs.size(), 2U);  // both with the third
}

TEST(PairList, RenewsGeometryWithPositionsAndNoiseWithStepAndStage) {
  const Fluid fluid(small_fluid({FrictionClosure::noise, HeatForm::temperature}, 1));
  State state = small_state(fluid.parameters());
  PairList pairs(small_box(), fluid, state.size());
  Noise noise(1, 0);
  pairs.update(state, fluid, 1);
  const auto first = pairs.draw(state, fluid, noise, 0);
  EXPECT_GT(first, pairs.size());
  EXPECT_LE(first, 2 * pairs.size());
  EXPECT_EQ(pairs.draw(state, fluid, noise, 0), 0U);
  const double number = pairs.normals(0).friction;
  EXPECT_EQ(pairs.draw(state, fluid, noise, 1), first);
  EXPECT_NE(pairs.normals(0).friction, number);
  EXPECT_EQ(pairs.draw(state, fluid, noise, 0), first);
  EXPECT_EQ(pairs.normals(0).friction, number);
  noise.set_step(1);
  EXPECT_EQ(pairs.draw(state, fluid, noise, 0), first);
  EXPECT_NE(pairs.normals(0).friction, number);
  const double r = pairs.geometry(0).r;
  state.position[0] += Vector(0.01, 0, 0);
  state.position[1] -= Vector(0, 0.01, 0);
  pairs.update(state, fluid, 1);  // the same version: the same geometry
  EXPECT_EQ(pairs.geometry(0).r, r);
  pairs.update(state, fluid, 2);
  EXPECT_NE(pairs.geometry(0).r, r);
  EXPECT_GT(pairs.draw(state, fluid, noise, 0), 0U);  // the pairs may be others
}

}  // namespace
}  // namespace driftless::testing
