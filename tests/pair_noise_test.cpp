#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "model/instruction_set.hpp"
#include "model/noise.hpp"
#include "tests/noise_law.hpp"

// The numbers of many pairs at once. Some 40 comparisons with a false-alarm rate below 4e-10 each.
namespace driftless {
namespace {

/// Numbers of pairs, friction and heat side by side.
struct Numbers {
  std::vector<double> friction, heat;
  bool operator==(const Numbers&) const = default;
};

struct Names {
  std::vector<std::uint32_t> i, j;
};

std::size_t padded(std::size_t count) {
  const std::size_t lanes = lanes_of_library();
  return (count + lanes - 1) / lanes * lanes;
}

using Batch = void (Noise::*)(std::size_t, const std::uint32_t*, const std::uint32_t*, Stage,
                              double*, double*) const;
constexpr Batch normals = &Noise::pair_normals, uniforms = &Noise::pair_uniforms;

Numbers draw(Batch batch, const Noise& noise, Names names, unsigned stage = 0) {
  const std::size_t count = names.i.size();
  names.i.resize(padded(count));
  names.j.resize(padded(count));
  Numbers numbers{std::vector<double>(padded(count)), std::vector<double>(padded(count))};
  (noise.*batch)(count, names.i.data(), names.j.data(), stage, numbers.friction.data(),
                 numbers.heat.data());
  numbers.friction.resize(count);
  numbers.heat.resize(count);
  return numbers;
}

/// Ids of all sizes, the largest and the smallest among them.
Names any_names(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const std::uint32_t extreme[] = {0U, 1U, 0x7fffffffU, 0x80000000U, 0xfffffffeU, 0xffffffffU};
  const auto any = [&] {
    const auto word = engine();
    return word % 4 == 0 ? extreme[(word >> 8) % 6] : static_cast<std::uint32_t>(word >> 32);
  };
  Names names;
  for (std::size_t n = 0; n < count; ++n) {
    names.i.push_back(any());
    names.j.push_back(any());
  }
  return names;
}

// ---- The numbers by hand, from Random123's own Philox. ------------------------------------------

using Philox = r123::Philox4x32;

struct Name {
  std::uint64_t seed, replica, step;
  unsigned stage;
};

/// The 128 random bits of a pair, as two words.
std::array<std::uint64_t, 2> words_by_hand(const Name& name, std::uint32_t i, std::uint32_t j,
                                           Purpose purpose) {
  const auto low = [](std::uint64_t word) { return static_cast<std::uint32_t>(word); };
  const auto high = [](std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); };
  const auto key =
      Philox{}({{low(name.seed), high(name.seed), low(name.replica), high(name.replica)}},
               {{0x64726966U, 0x746c6573U}});
  const auto block = Philox{}(
      {{i, j, low(name.step),
        (name.stage << 24) | (static_cast<std::uint32_t>(purpose) << 8) | high(name.step)}},
      {{key[0], key[1]}});
  return {(std::uint64_t{block[1]} << 32) | block[0], (std::uint64_t{block[3]} << 32) | block[2]};
}

double uniform_by_hand(std::uint64_t word) {
  return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52;
}

std::vector<Name> any_environments() {
  std::mt19937_64 engine(5);
  std::vector<Name> all = {
      {0, 0, 0, 0},
      {~std::uint64_t{0}, ~std::uint64_t{0}, (std::uint64_t{1} << 40) - 1, 255},
      {1, 2, std::uint64_t{1} << 32, 128}};
  for (int n = 0; n < 30; ++n) {
    all.push_back({engine(), engine(), engine() >> 24, static_cast<unsigned>(engine() % 256)});
  }
  return all;
}

// The uniform variates show 52 of the 64 bits of either word.
TEST(PairNoise, HasTheWordsOfRandom123) {
  for (const auto& name : any_environments()) {
    Noise noise(name.seed, name.replica);
    noise.set_step(name.step);
    const auto names = any_names(1000, name.step);
    const auto numbers = draw(uniforms, noise, names, name.stage);
    for (std::size_t n = 0; n < names.i.size(); ++n) {
      const auto words = words_by_hand(name, names.i[n], names.j[n], Purpose::pair_uniform);
      ASSERT_EQ(numbers.friction[n], uniform_by_hand(words[0])) << n;
      ASSERT_EQ(numbers.heat[n], uniform_by_hand(words[1])) << n;
    }
  }
}

TEST(PairNoise, MakesNormalsByBoxAndMuller) {
  for (const auto& name : any_environments()) {
    Noise noise(name.seed, name.replica);
    noise.set_step(name.step);
    const auto names = any_names(1000, name.step + 1);
    const auto numbers = draw(normals, noise, names, name.stage);
    for (std::size_t n = 0; n < names.i.size(); ++n) {
      const auto words = words_by_hand(name, names.i[n], names.j[n], Purpose::friction);
      const double radius = std::sqrt(-2 * std::log(uniform_by_hand(words[0])));
      const double angle = std::acos(-1.0) * (uniform_by_hand(words[1]) - 0.5 + (words[1] & 1));
      ASSERT_NEAR(numbers.friction[n], radius * std::cos(angle), 1e-14) << n;
      ASSERT_NEAR(numbers.heat[n], radius * std::sin(angle), 1e-14) << n;
    }
  }
}

// ---- What callers rely on, to the last bit. -----------------------------------------------------

TEST(PairNoise, DoesNotDependOnThePlaceInTheArraysNorOnTheirSize) {
  const Noise noise(1, 2);
  const auto names = any_names(200, 3);
  for (const Batch batch : {normals, uniforms}) {
    const auto all = draw(batch, noise, names, 7);
    for (std::size_t first = 0; first < 20; ++first) {
      for (std::size_t count = 0; count < 20; ++count) {
        const auto part = [&](const auto& from) {
          const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
          return std::vector(begin, begin + static_cast<std::ptrdiff_t>(count));
        };
        EXPECT_EQ(draw(batch, noise, {part(names.i), part(names.j)}, 7),
                  (Numbers{part(all.friction), part(all.heat)}));
      }
    }
  }
}

TEST(PairNoise, OfOnePurposeDoesNotDependOnWhetherTheOtherIsWanted) {
  const Noise noise(1, 2);
  const auto names = any_names(padded(100), 3);
  for (const Batch batch : {normals, uniforms}) {
    const auto both = draw(batch, noise, names);
    Numbers alone = {std::vector<double>(names.i.size()), std::vector<double>(names.i.size())};
    const auto ask = [&](double* friction, double* heat) {
      (noise.*batch)(names.i.size(), names.i.data(), names.j.data(), 0, friction, heat);
    };
    ask(alone.friction.data(), nullptr);
    ask(nullptr, alone.heat.data());
    ask(nullptr, nullptr);
    EXPECT_EQ(alone, both);
  }
}

TEST(PairNoise, WritesNothingBehindTheLastLanes) {
  const Noise noise(1, 2);
  for (std::size_t count = 0; count < 40; ++count) {
    const auto names = any_names(padded(count), count);
    for (const Batch batch : {normals, uniforms}) {
      std::vector<double> friction(padded(count) + 20, -100), heat = friction;
      (noise.*batch)(count, names.i.data(), names.j.data(), 0, friction.data(), heat.data());
      for (std::size_t n = 0; n < friction.size(); ++n) {
        EXPECT_EQ(friction[n] == -100, n >= padded(count));
        EXPECT_EQ(heat[n] == -100, n >= padded(count));
      }
    }
  }
}

TEST(PairNoise, OfOnePairAloneIsTheSame) {
  const Noise noise(1, 2);
  const auto names = any_names(100, 3);
  const auto two = draw(normals, noise, names, 4), more = draw(uniforms, noise, names, 4);
  for (std::size_t n = 0; n < names.i.size(); ++n) {
    const auto i = names.i[n], j = names.j[n];
    EXPECT_EQ(noise.pair_normals(i, j, 4, true, true).friction, two.friction[n]);
    EXPECT_EQ(noise.pair_normals(i, j, 4, true, true).heat, two.heat[n]);
    EXPECT_EQ(noise.pair_normals(i, j, 4, true, false).friction, two.friction[n]);
    EXPECT_EQ(noise.pair_normals(i, j, 4, true, false).heat, 0);
    EXPECT_EQ(noise.pair_normals(i, j, 4, false, true).friction, 0);
    EXPECT_EQ(noise.pair_normals(i, j, 4, false, true).heat, two.heat[n]);
    EXPECT_EQ(noise.pair_uniforms(i, j, 4).friction, more.friction[n]);
    EXPECT_EQ(noise.pair_uniforms(i, j, 4).heat, more.heat[n]);
  }
}

TEST(PairNoise, IsNotTheNoiseOfAnyParticle) {
  std::set<std::uint64_t> of_particle;
  for (const auto purpose : {Purpose::initial_velocity, Purpose::initial_energy,
                             Purpose::initial_position, Purpose::monte_carlo}) {
    auto stream = Noise(1, 0).particle_stream(5, purpose);
    for (int n = 0; n < 100; ++n) of_particle.insert(stream());
  }
  ASSERT_EQ(of_particle.size(), 400U);
  for (std::uint32_t j = 0; j < 20; ++j) {
    for (unsigned stage = 0; stage < 256; ++stage) {
      for (const auto purpose : {Purpose::friction, Purpose::pair_uniform}) {
        for (const auto word : words_by_hand({1, 0, 0, stage}, 5, j, purpose)) {
          EXPECT_EQ(of_particle.count(word), 0U);
        }
      }
    }
  }
}

// ---- Refinement: one Wiener path for steps of any size. -----------------------------------------

Noise refined(unsigned cells, std::uint64_t step) {
  Noise noise(1, 2);
  noise.set_refinement(cells);
  noise.set_step(step);
  return noise;
}

/// Sums over `count` cells from `first` on, by their own noise, divided by the root of `count`.
Numbers sum_of_cells(const Names& names, std::uint64_t first, unsigned count, unsigned stage) {
  Numbers sum{std::vector<double>(names.i.size()), std::vector<double>(names.i.size())};
  for (unsigned cell = 0; cell < count; ++cell) {
    const auto numbers = draw(normals, refined(1, first + cell), names, stage);
    for (std::size_t n = 0; n < names.i.size(); ++n) {
      sum.friction[n] += numbers.friction[n] / std::sqrt(count);
      sum.heat[n] += numbers.heat[n] / std::sqrt(count);
    }
  }
  return sum;
}

double distance(const Numbers& one, const Numbers& other) {
  double largest = 0;
  for (std::size_t n = 0; n < one.friction.size(); ++n) {
    largest = std::max({largest, std::abs(one.friction[n] - other.friction[n]),
                        std::abs(one.heat[n] - other.heat[n])});
  }
  return largest;
}

TEST(RefinedNoise, OfAStepIsTheSumOfItsCells) {
  const auto names = any_names(100, 3);
  for (const unsigned stage : {0U, 1U, 5U}) {
    const auto expected = sum_of_cells(names, 13, 6, stage);
    EXPECT_LE(distance(draw(normals, refined(6, 3), names, stage), expected), 1e-14);
    EXPECT_GT(distance(draw(normals, refined(6, 4), names, stage), expected), 1);
  }
}

TEST(RefinedNoise, OfAPartIsTheSumOfThePartsCells) {
  const auto names = any_names(100, 3);
  const auto part = [&](Batch batch, Stage stage) {
    Noise noise = refined(6, 3);
    Numbers numbers{std::vector<double>(padded(100)), std::vector<double>(padded(100))};
    Names lanes = names;
    lanes.i.resize(padded(100));
    lanes.j.resize(padded(100));
    (noise.*batch)(100, lanes.i.data(), lanes.j.data(), stage, numbers.friction.data(),
                   numbers.heat.data());
    numbers.friction.resize(100);
    numbers.heat.resize(100);
    return numbers;
  };
  EXPECT_LE(distance(part(normals, {0, 2}), sum_of_cells(names, 13, 3, 0)), 1e-14);
  EXPECT_LE(distance(part(normals, {1, 2}), sum_of_cells(names, 16, 3, 0)), 1e-14);
  EXPECT_LE(distance(part(normals, {2, 3}), sum_of_cells(names, 17, 2, 0)), 1e-14);
  EXPECT_LE(distance(part(normals, {3, 2}), sum_of_cells(names, 16, 3, 1)), 1e-14);
  EXPECT_THROW(part(normals, {0, 4}), std::invalid_argument);
  EXPECT_THROW(Noise(1, 2).set_refinement(0), std::invalid_argument);
  EXPECT_EQ(part(uniforms, {1, 2}), draw(uniforms, refined(1, 3), names, 1));
}

TEST(RefinedNoise, IsTheSameNoiseWhereAStepIsOneCell) {
  const auto names = any_names(100, 3);
  Noise plain(1, 2);
  plain.set_step(7);
  EXPECT_EQ(draw(normals, refined(1, 7), names, 3), draw(normals, plain, names, 3));
}

// The sum over a path's steps is the same, however they are cut.
TEST(RefinedNoise, HasOnePathForAllSteps) {
  const auto names = any_names(50, 4);
  const auto path = [&](unsigned cells) {
    Numbers sum{std::vector<double>(50), std::vector<double>(50)};
    for (std::uint64_t step = 1; step <= 24 / cells; ++step) {
      const auto numbers = draw(normals, refined(cells, step), names);
      for (std::size_t n = 0; n < 50; ++n) {
        sum.friction[n] += std::sqrt(cells) * numbers.friction[n];
        sum.heat[n] += std::sqrt(cells) * numbers.heat[n];
      }
    }
    return sum;
  };
  for (const unsigned cells : {2U, 3U, 8U, 24U}) {
    EXPECT_LE(distance(path(cells), path(1)), 1e-13) << cells;
  }
}

TEST(RefinedNoise, IsNormal) {
  Names names;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    names.i.push_back(i);
    names.j.push_back(i + 1);
  }
  const auto numbers = draw(normals, refined(4, 1), names);
  EXPECT_TRUE(is_normal(numbers.friction) && is_normal(numbers.heat));
}

// ---- Laws of a million pairs, by name of what is broken. ----------------------------------------

/// Normals and uniform variates of the same pairs, neighbours in ids side by side.
struct Sample {
  Numbers normal, uniform;
};

Sample sample() {
  Noise noise(29, 3);
  Names names;
  for (std::uint32_t i = 0; i < 1024; ++i) {
    for (std::uint32_t j = 0; j < 1024; ++j) {
      names.i.push_back(i);
      names.j.push_back(2000 + j);
    }
  }
  return {draw(normals, noise, names), draw(uniforms, noise, names)};
}

/// The two uniform variates that a pair of normals comes from: of the radius and of the angle.
struct Plane {
  std::vector<double> radius, angle;
};

Plane plane(const Numbers& normal) {
  Plane plane;
  for (std::size_t n = 0; n < normal.friction.size(); ++n) {
    const double x = normal.friction[n], y = normal.heat[n];
    plane.radius.push_back(std::exp(-(x * x + y * y) / 2));
    plane.angle.push_back(std::atan2(y, x) / (2 * std::acos(-1.0)) + 0.5);
  }
  return plane;
}

Numbers normals_of(const Plane& plane) {
  Numbers normal;
  for (std::size_t n = 0; n < plane.radius.size(); ++n) {
    const double radius = std::sqrt(-2 * std::log(plane.radius[n]));
    const double angle = 2 * std::acos(-1.0) * (plane.angle[n] - 0.5);
    normal.friction.push_back(radius * std::cos(angle));
    normal.heat.push_back(radius * std::sin(angle));
  }
  return normal;
}

/// The numbers of the pair after each one.
std::vector<double> next(std::vector<double> x) {
  std::rotate(x.begin(), x.begin() + 1, x.end());
  return x;
}

using Complaints = std::set<std::string>;

Complaints check(const Sample& sample) {
  Complaints complaints;
  const auto demand = [&](bool holds, const char* what) {
    if (!holds) complaints.insert(what);
  };
  const auto [radius, angle] = plane(sample.normal);
  const auto& [friction, heat] = sample.uniform;
  demand(is_normal(sample.normal.friction) && is_normal(sample.normal.heat), "normal law");
  demand(is_uniform(radius, 4096), "radius");
  demand(is_uniform(angle, 4096), "angle");
  demand(fill_square(radius, angle), "radius and angle");
  demand(fill_square(radius, next(radius)) && fill_square(angle, next(angle)) &&
             fill_square(radius, next(angle)) && fill_square(angle, next(radius)),
         "a pair and the next");
  demand(is_uniform(friction, 4096) && is_uniform(heat, 4096), "uniform law");
  demand(fill_square(friction, heat), "two uniforms");
  demand(fill_square(friction, next(friction)) && fill_square(heat, next(heat)) &&
             fill_square(friction, next(heat)) && fill_square(heat, next(friction)),
         "uniforms of a pair and of the next");
  demand(fill_square(friction, radius) && fill_square(friction, angle) &&
             fill_square(heat, radius) && fill_square(heat, angle),
         "uniforms and normals");
  return complaints;
}

TEST(PairNoise, IsNormalAndUniformAndIndependentInThePlane) {
  EXPECT_EQ(check(sample()), Complaints{});
}

TEST(PairNoiseFaults, AreSeen) {
  const auto good = sample();
  const auto good_plane = plane(good.normal);
  const auto seen = [&](void (*spoil)(Plane&)) {
    auto faulty = good_plane;
    spoil(faulty);
    return check({normals_of(faulty), good.uniform});
  };
  const auto seen_uniform = [&](auto&& spoil) {
    auto faulty = good;
    spoil(faulty.uniform);
    return check(faulty);
  };
  EXPECT_EQ(seen([](Plane&) {}), Complaints{});  // the way there and back does no harm
  EXPECT_TRUE(seen([](Plane& p) {
                for (double& angle : p.angle) angle = (std::floor(256 * angle) + 0.5) / 256;
              }).count("angle"));
  EXPECT_TRUE(seen([](Plane& p) {
                for (double& radius : p.radius) radius = (std::floor(1024 * radius) + 0.5) / 1024;
              }).count("radius"));
  EXPECT_TRUE(seen([](Plane& p) {  // a half plane only
                for (double& angle : p.angle) angle = 0.25 + angle / 2;
              })
                  .count("normal law"));
  EXPECT_TRUE(seen([](Plane& p) { p.radius = p.angle; }).count("radius and angle"));
  EXPECT_TRUE(seen([](Plane& p) {
                for (std::size_t n = 1; n < p.radius.size(); n += 2) p.radius[n] = p.radius[n - 1];
              }).count("a pair and the next"));
  EXPECT_TRUE(seen_uniform([](Numbers& u) {
                for (double& x : u.heat) x *= 0.99;
              }).count("uniform law"));
  EXPECT_TRUE(seen_uniform([](Numbers& u) { u.heat = u.friction; }).count("two uniforms"));
  EXPECT_TRUE(seen_uniform([](Numbers& u) {
                u.heat = next(u.friction);
              }).count("uniforms of a pair and of the next"));
  EXPECT_TRUE(seen_uniform([&](Numbers& u) {
                u.friction = good_plane.radius;
              }).count("uniforms and normals"));
}

}  // namespace
}  // namespace driftless
