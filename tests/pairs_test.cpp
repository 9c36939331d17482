#include "model/pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

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

/// What the search finds, in the order of ids.
std::vector<PairSearch::Found> found_in(PairSearch& search, const State& state) {
  std::vector<PairSearch::Found> found;
  search.find(state, [&](const PairSearch::Found& pair) { found.push_back(pair); });
  const auto ids = [&](const auto& pair) { return std::pair(state.id[pair.i], state.id[pair.j]); };
  std::sort(found.begin(), found.end(),
            [&](const auto& a, const auto& b) { return ids(a) < ids(b); });
  return found;
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
    {"a column thinner than three ranges", {2, 2, 9}, {3, 3, 30}, 300},
    {"the same along x", {9, 2, 2}, {30, 3, 3}, 300},
    {"the same along y", {2, 9, 2}, {3, 30, 3}, 300},
    {"a plate thinner than three ranges", {5, 5, 2}, {8, 8, 3}, 300},
    {"the same across x", {2, 5, 5}, {3, 8, 8}, 300},
    {"the same across y", {4, 2, 3}, {8, 3, 8}, 300},
    {"a long column", {2, 3, 300}, {3, 4, 1000}, 300},
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
        ASSERT_EQ(fault(found_in(search, state), box, range, state), "") << "repeat " << repeat;
      }
    }
  }
}

TEST(PairSearch, ThatFindsNoNeighboursWouldBeNoticed) {
  Uniform uniform(4);
  const Box box{Vector::Constant(4)};
  const State state = random_state(uniform, box, 100);
  PairSearch search(box, 1, 100);
  const auto found = found_in(search, state);
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
  const auto a = found_in(one, state);
  const auto b = found_in(two, permuted);
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

// The search is linear in the particles as long as its cells are no larger than a few ranges.
TEST(CellGrid, HasCellsOfTheRangeInAThinBoxToo) {
  const auto count = [](const Vector& lengths, double density = 3) {
    const auto particles = static_cast<std::size_t>(density * lengths.prod());
    return CellGrid(Box{lengths}, 1, particles).count();
  };
  EXPECT_EQ(count({2.5, 2.5, 1000}), Eigen::Vector3i(1, 1, 1000));
  EXPECT_EQ(count({1000, 2.5, 2.5}), Eigen::Vector3i(1000, 1, 1));
  EXPECT_EQ(count({2.5, 100, 100}), Eigen::Vector3i(1, 100, 100));
  EXPECT_EQ(count({3, 3, 1000}), Eigen::Vector3i(3, 3, 1000));
  EXPECT_EQ(count({3.9, 2.9, 3.9}), Eigen::Vector3i(1, 1, 1));
  EXPECT_EQ(count({30, 30, 30}), Eigen::Vector3i(30, 30, 30));
  // Dilute: at most eight cells a particle.
  EXPECT_LE(count({3, 3, 1000}, 0.01).prod(), 8 * 90);
  EXPECT_LE(count({100, 100, 100}, 0.001).prod(), 8 * 1000);
  EXPECT_LE(count({2, 1000, 1000}, 1e-4).prod(), 8 * 200);
}

TEST(PairSearch, FindsNothingWithoutARangeOrWithoutParticles) {
  Uniform uniform(6);
  const Box box{Vector::Constant(1)};
  const State state = random_state(uniform, box, 20);
  PairSearch no_range(box, 0, 20), nobody(box, 0.3, 0), alone(box, 0.3, 1);
  EXPECT_TRUE(found_in(no_range, state).empty());
  EXPECT_TRUE(found_in(nobody, State{}).empty());
  EXPECT_TRUE(found_in(alone, random_state(uniform, box, 1)).empty());
}

// ---- Order: groups of pairs stand for a sweep one after the other. ------------------------------

/// Pairs group after group.
struct InOrder {
  PairIndices pairs;
  std::vector<std::uint32_t> end;
};

InOrder in_order(const GroupedPairs& grouped) {
  InOrder all{{}, grouped.groups.end};
  for (const auto n : grouped.groups.order) {
    all.pairs.append(grouped.pairs.i[n], grouped.pairs.j[n]);
  }
  return all;
}

/// A dense system in a box of some cells, and its pairs.
struct Dense {
  State state;
  CellGrid cells;
  PairBlocks blocks;
  std::vector<InOrder> grouped;  ///< of each block

  Dense(const Vector& lengths, std::size_t particles, unsigned threads, std::uint64_t seed = 8)
      : cells(Box{lengths}, 1, particles), blocks(cells, 1, threads) {
    Uniform uniform(seed);
    state = random_state(uniform, Box{lengths}, particles);
    cells.sort(state);
    blocks.find(cells);
    for (auto& block : blocks.all()) grouped.push_back(in_order(blocks.group(block, cells)));
  }

  /// The pairs by ids in the order of a sweep: colours, blocks, groups.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order() const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (const auto& block : grouped) add(block.pairs, all);
    return all;
  }
  void add(const PairIndices& pairs,
           std::vector<std::pair<std::uint32_t, std::uint32_t>>& all) const {
    for (std::size_t n = 0; n < pairs.size; ++n) {
      all.emplace_back(cells.id(pairs.i[n]), cells.id(pairs.j[n]));
    }
  }
};

/// Whether a particle is twice in a group.
bool meets_itself(const InOrder& groups) {
  std::size_t from = 0;
  for (const auto end : groups.end) {
    std::set<std::uint32_t> seen;
    for (; from < end; ++from) {
      if (!seen.insert(groups.pairs.i[from]).second) return true;
      if (!seen.insert(groups.pairs.j[from]).second) return true;
    }
  }
  return false;
}

const Vector boxes[] = {{3.5, 3.5, 3.5}, {4, 4, 4},         {5.5, 4.2, 7.1},
                        {9, 3.3, 12.5},  {13, 13, 13},      {15.2, 17, 14.6},
                        {2.5, 9, 13},    {2.2, 2.9, 600.5}, {60.1, 2, 3.4}};

TEST(PairGroups, HoldEveryPairOnceAndNoParticleTwice) {
  for (const auto& lengths : boxes) {
    for (const double density : {0.3, 3.0, 12.0}) {
      if (density * lengths.prod() > 20000) continue;
      Dense dense(lengths, static_cast<std::size_t>(density * lengths.prod()), 1);
      auto grouped = dense.order();
      std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
      for (auto& block : dense.blocks.all()) dense.add(block.found, found);
      for (const auto& groups : dense.grouped) EXPECT_FALSE(meets_itself(groups));
      std::sort(grouped.begin(), grouped.end());
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      EXPECT_EQ(grouped, found);
    }
  }
}

TEST(PairGroups, ThatShareAParticleWouldBeNoticed) {
  Dense dense(boxes[1], 200, 1);
  InOrder groups = dense.grouped[0];
  ASSERT_FALSE(meets_itself(groups));
  groups.pairs.i[1] = groups.pairs.j[0];
  EXPECT_TRUE(meets_itself(groups));
}

TEST(CellGrid, PutsNeighbouringTilesOfEveryColourSideBySide) {
  const CellGrid cells(Box{Vector::Constant(10)}, 1, 3000);
  ASSERT_EQ(cells.tiles(), Eigen::Vector3i(1, 4, 4));
  EXPECT_EQ(cells.tiles_at_once(), 4U);
  for (int z = 0; z < 10; ++z) {
    for (int y = 0; y < 10; ++y) {
      const std::size_t quarter = (z >= 5 ? 2 : 0) + (y >= 5 ? 1 : 0);
      for (int x = 0; x < 10; ++x) EXPECT_EQ(cells.index(x, y, z) / 250, quarter);
    }
  }
}

TEST(CellGrid, HasNoWorkForASecondThreadInASmallBox) {
  EXPECT_EQ(CellGrid(Box{Vector::Constant(7)}, 1, 1000).tiles_at_once(), 1U);
  EXPECT_EQ(CellGrid(Box{Vector::Constant(3)}, 1, 80).tiles_at_once(), 1U);
  EXPECT_EQ(CellGrid(Box{{30, 10, 10}}, 1, 9000).tiles_at_once(), 14U);
}

TEST(PairBlocks, OfOneColourShareNoParticle) {
  for (const auto& lengths : boxes) {
    Dense dense(lengths, static_cast<std::size_t>(3 * lengths.prod()), 4);
    for (std::size_t colour = 0; colour < dense.blocks.colours().size(); ++colour) {
      std::vector<std::size_t> owner(dense.state.size(), 0);
      for (std::size_t n = 0; n < dense.blocks.colours()[colour]; ++n) {
        const auto& found = dense.blocks.block(colour, n).found;
        for (std::size_t pair = 0; pair < found.size; ++pair) {
          for (const auto particle : {found.i[pair], found.j[pair]}) {
            EXPECT_TRUE(owner[particle] == 0 || owner[particle] == n + 1);
            owner[particle] = n + 1;
          }
        }
      }
    }
  }
}

/// For each particle the partners in the order in which they are met.
std::vector<std::vector<std::uint32_t>> partners(const Dense& dense) {
  std::vector<std::vector<std::uint32_t>> met(dense.state.size());
  for (const auto& [i, j] : dense.order()) {
    met[i].push_back(j);
    met[j].push_back(i);
  }
  return met;
}

TEST(PairBlocks, MeetPairsInTheSameOrderForAnyNumberOfThreads) {
  for (const auto& lengths : boxes) {
    const auto particles = static_cast<std::size_t>(3 * lengths.prod());
    const auto alone = partners(Dense(lengths, particles, 1));
    for (const unsigned threads : {2U, 4U, 7U}) {
      EXPECT_EQ(partners(Dense(lengths, particles, threads)), alone);
    }
    EXPECT_NE(partners(Dense(lengths, particles, 1, 9)), alone);
  }
}

/// The order in which a particle meets its partners if pairs come by ascending ids.
bool ascends(const InOrder& groups, const CellGrid& cells) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> last(cells.particles(), {0, 0});
  for (std::size_t n = 0; n < groups.pairs.size; ++n) {
    const auto i = groups.pairs.i[n], j = groups.pairs.j[n];
    const std::pair ids(cells.id(i), cells.id(j));
    if (last[i] > ids || last[j] > ids) return false;
    last[i] = last[j] = ids;
  }
  return true;
}

TEST(PairGroups, ByIdsLetEveryParticleMeetItsPartnersInAscendingOrder) {
  for (const auto& lengths : boxes) {
    Dense dense(lengths, static_cast<std::size_t>(3 * lengths.prod()), 1);
    const auto groups = in_order(dense.blocks.by_ids(dense.cells));
    EXPECT_EQ(groups.pairs.size, dense.blocks.pairs());
    EXPECT_FALSE(meets_itself(groups));
    EXPECT_TRUE(ascends(groups, dense.cells));
    if (dense.cells.single()) {
      EXPECT_TRUE(ascends(dense.grouped[0], dense.cells));
    } else {
      EXPECT_FALSE(ascends(dense.grouped[0], dense.cells));
    }
  }
}

// ---- What a system shows of its pairs. ----------------------------------------------------------

TEST(SystemPairs, HaveTheDirectionFromJToIAndTheWeights) {
  Uniform uniform(7);
  const Fluid fluid(small_fluid({FrictionClosure::noise, HeatForm::temperature, true}, 1));
  const Box box = small_box();
  const State state = random_state(uniform, box, 60);
  System system(fluid, box, state, Noise(1, 0));
  std::size_t pairs = 0;
  system.for_each_pair([&](const System::Geometry& g) {
    ++pairs;
    EXPECT_LT(state.id[g.i], state.id[g.j]);
    EXPECT_NEAR(g.e.norm(), 1, 1e-14);
    // Walking from j along e for the distance r leads to i.
    const Vector end = state.position[g.j] + g.r * g.e;
    EXPECT_LT(box.minimum_image(end - state.position[g.i]).norm(), 1e-14);
    EXPECT_NEAR(g.w_friction, fluid.friction_weight(g.r), 1e-15);
    EXPECT_NEAR(g.w_heat, fluid.heat_weight(g.r), 1e-15);
  });
  EXPECT_GT(pairs, 20U);
}

TEST(SystemPairs, LeaveOutParticlesInOnePlace) {
  State state;
  for (std::uint32_t i = 0; i < 3; ++i) {
    state.position.push_back(i < 2 ? Vector(1, 1, 1) : Vector(1.5, 1, 1));
    state.velocity.push_back(Vector::Zero());
    state.internal_energy.push_back(10);
    state.id.push_back(i);
  }
  System system(Fluid(small_fluid({.potential = true}, 1)), small_box(), state, Noise(1, 0));
  std::size_t pairs = 0;
  system.for_each_pair([&](const System::Geometry&) { ++pairs; });
  EXPECT_EQ(pairs, 2U);  // both with the third
  for (const auto& force : system.conservative_force()) EXPECT_TRUE(force.allFinite());
}

}  // namespace
}  // namespace driftless::testing
