#include "model/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/gamma_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/noise_law.hpp"

// Every statistical bound below has a false-alarm rate of at most 2e-10; about 200 comparisons.
namespace driftless {
namespace {

/// What a number is asked by; every field is part of its name.
struct Request {
  std::uint32_t i = 5, j = 9;
  std::uint64_t step = 3;
  unsigned stage = 0;
  Purpose purpose = Purpose::friction;
  std::uint64_t replica = 0, seed = 11;
};
using Draw = std::function<double(const Request&)>;

double draw(const Request& r) {
  Noise noise(r.seed, r.replica);
  noise.set_step(r.step);
  const bool friction = r.purpose == Purpose::friction;
  constexpr std::size_t lanes = 8;  // those of any processor: the library's are not this program's
  const std::array<std::uint32_t, lanes> i = {r.i}, j = {r.j};
  std::array<double, lanes> normal;
  noise.pair_normals(1, i.data(), j.data(), r.stage, friction ? normal.data() : nullptr,
                     friction ? nullptr : normal.data());
  return normal[0];
}

// ---- One check of everything that is asked of the numbers, by name of what is broken. ----------

using Complaints = std::set<std::string>;

void check_moments(const std::vector<double>& x, Complaints& complaints) {
  const double n = static_cast<double>(x.size());
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  for (const double z : x) {
    m1 += z / n;
    m2 += z * z / n;
    m3 += z * z * z / n;
    m4 += z * z * z * z / n;
  }
  // Variances of z, z^2, z^3, z^4 under the standard normal law: 1, 2, 15, 96.
  if (!(std::abs(m1) < bound * std::sqrt(1 / n))) complaints.insert("mean");
  if (!(std::abs(m2 - 1) < bound * std::sqrt(2 / n))) complaints.insert("variance");
  if (!(std::abs(m3) < bound * std::sqrt(15 / n))) complaints.insert("third moment");
  if (!(std::abs(m4 - 3) < bound * std::sqrt(96 / n))) complaints.insert("fourth moment");
}

/// Covariance of the numbers and of their squares between two neighbours in every direction.
void check_covariances(const Draw& numbers, Complaints& complaints) {
  struct Neighbour {
    const char* name;
    void (*change)(Request&);
  };
  const Neighbour neighbours[] = {
      {"(i, j) and (i, j + 1)", [](Request& r) { ++r.j; }},
      {"(i, j) and (i + 1, j)", [](Request& r) { ++r.i; }},
      {"(i, j) and (i + 1, j + 1)", [](Request& r) { ++r.i, ++r.j; }},
      {"(i, j) and (i + 1, j - 1)", [](Request& r) { ++r.i, --r.j; }},
      {"(i, j) and (j, i)", [](Request& r) { std::swap(r.i, r.j); }},
      {"a step and the next", [](Request& r) { ++r.step; }},
      {"a step and 2^32 later", [](Request& r) { r.step += std::uint64_t{1} << 32; }},
      {"a stage and the next", [](Request& r) { ++r.stage; }},
      {"friction and heat", [](Request& r) { r.purpose = Purpose::heat; }},
      {"a replica and the next", [](Request& r) { ++r.replica; }},
      {"a seed and the next", [](Request& r) { ++r.seed; }},
      {"replica and seed", [](Request& r) { ++r.replica, --r.seed; }},
  };
  constexpr int samples = 40000;
  for (const auto& neighbour : neighbours) {
    double product = 0, squares = 0;
    for (int n = 0; n < samples; ++n) {
      Request r;
      r.i = 3 * static_cast<std::uint32_t>(n % 200);
      r.j = 10000 + 3 * static_cast<std::uint32_t>(n / 200 % 20);
      r.step = 3 * static_cast<std::uint64_t>(n / 4000);
      const double x = numbers(r);
      neighbour.change(r);
      const double y = numbers(r);
      product += x * y;
      squares += (x * x - 1) * (y * y - 1) / 2;
    }
    // Under independence both summands have mean 0 and variance 1, the second with heavy tails.
    const double error = std::sqrt(samples);
    if (!(std::abs(product) < bound * error) || !(std::abs(squares) < 2 * bound * error)) {
      complaints.insert(neighbour.name);
    }
  }
}

Complaints check(const Draw& numbers) {
  Complaints complaints;
  for (const auto purpose : {Purpose::friction, Purpose::heat}) {
    std::vector<double> x;
    for (std::uint32_t i = 0; i < 300; ++i) {
      for (std::uint32_t j = i + 1; j < 300; ++j) {
        for (std::uint64_t step = 0; step < 5; ++step) {
          x.push_back(numbers({.i = i, .j = j, .step = step, .purpose = purpose}));
        }
      }
    }
    check_moments(x, complaints);
    if (!is_normal(x)) complaints.insert("law");
  }
  check_covariances(numbers, complaints);
  return complaints;
}

TEST(Noise, IsStandardNormalAndIndependentInEveryDirection) {
  EXPECT_EQ(check(draw), Complaints{});
}

/// The numbers of the library, each asked by another name than it should be.
Draw renamed(void (*change)(Request&)) {
  return [change](Request r) {
    change(r);
    return draw(r);
  };
}

TEST(NoiseFaults, AreSeen) {
  const auto seen = [](const Draw& faulty) { return check(faulty); };
  const auto without = [&](void (*change)(Request&)) { return seen(renamed(change)); };
  EXPECT_TRUE(without([](Request& r) { r.step = 0; }).count("a step and the next"));
  EXPECT_TRUE(without([](Request& r) { r.step &= 0xffffffffU; }).count("a step and 2^32 later"));
  EXPECT_TRUE(without([](Request& r) { r.stage = 0; }).count("a stage and the next"));
  EXPECT_TRUE(without([](Request& r) { r.purpose = Purpose::heat; }).count("friction and heat"));
  EXPECT_TRUE(without([](Request& r) { r.replica = 0; }).count("a replica and the next"));
  EXPECT_TRUE(without([](Request& r) { r.seed = 0; }).count("a seed and the next"));
  EXPECT_TRUE(without([](Request& r) {
                r.seed += r.replica;
                r.replica = 0;
              }).count("replica and seed"));
  EXPECT_TRUE(without([](Request& r) { r.j = 0; }).count("(i, j) and (i, j + 1)"));
  EXPECT_TRUE(without([](Request& r) { r.i = 0; }).count("(i, j) and (i + 1, j)"));
  EXPECT_TRUE(without([](Request& r) {
                r.i += r.j;
                r.j = 0;
              }).count("(i, j) and (i + 1, j - 1)"));
  EXPECT_TRUE(without([](Request& r) {
                r.j -= r.i;
                r.i = 0;
              }).count("(i, j) and (i + 1, j + 1)"));
  EXPECT_TRUE(without([](Request& r) {
                if (r.i > r.j) std::swap(r.i, r.j);
              }).count("(i, j) and (j, i)"));
  EXPECT_TRUE(seen([](const Request& r) { return draw(r) + 0.02; }).count("mean"));
  EXPECT_TRUE(seen([](const Request& r) { return draw(r) * 1.02; }).count("variance"));
  EXPECT_TRUE(seen([](const Request& r) {
                const double z = draw(r);
                return z + 0.02 * (z * z - 1);
              }).count("third moment"));
  const auto uniform = [](const Request& r) {  // of mean 0 and variance 1
    return std::sqrt(12.0) * (boost::math::cdf(boost::math::normal(), draw(r)) - 0.5);
  };
  EXPECT_TRUE(seen(uniform).count("fourth moment"));
  EXPECT_TRUE(seen(uniform).count("law"));
}

// ---- Exact properties. -------------------------------------------------------------------------

TEST(Noise, DoesNotDependOnTheOrderOfVisitsOrTheReader) {
  Noise noise(1, 2), other(1, 2);
  std::vector<Noise::PairNormals> both;
  for (std::uint32_t i = 0; i < 100; ++i) {
    noise.set_step(i / 10);
    both.push_back(noise.pair_normals(i, i + 7, i % 3, true, true));
  }
  for (std::uint32_t i = 100; i-- > 0;) {
    other.set_step(i / 10);
    const auto again = other.pair_normals(i, i + 7, i % 3, true, true);
    EXPECT_EQ(again.friction, both[i].friction);
    EXPECT_EQ(again.heat, both[i].heat);
  }
}

/// Every number of a choice of extreme and ordinary names.
std::vector<double> numbers_of_extreme_names(const Draw& numbers) {
  const std::uint64_t two_32 = std::uint64_t{1} << 32;
  const std::uint32_t last_id = std::numeric_limits<std::uint32_t>::max();
  std::vector<double> all;
  for (const std::uint32_t i : {0U, 1U, 2U, 256U, 65536U, last_id - 1, last_id}) {
    for (const std::uint32_t j : {0U, 1U, 2U, 256U, 65536U, last_id - 1, last_id}) {
      for (const std::uint64_t step :
           {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{256}, std::uint64_t{65536},
            two_32 - 1, two_32, two_32 + 1, 255 * two_32, 256 * two_32 - 1}) {
        for (const unsigned stage : {0U, 1U, 2U, 128U, 255U}) {
          for (const auto purpose : {Purpose::friction, Purpose::heat}) {
            if (i != j) all.push_back(numbers({i, j, step, stage, purpose}));
          }
        }
      }
    }
  }
  return all;
}

std::size_t repetitions(std::vector<double> all) {
  const std::size_t total = all.size();
  std::sort(all.begin(), all.end());
  return total - static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin());
}

// Of 3780 different numbers of some 50 bits two coincide by chance once in 10^8 runs.
TEST(Noise, HasNoTwoLegalNamesForOneNumber) {
  EXPECT_EQ(repetitions(numbers_of_extreme_names(draw)), 0U);
  EXPECT_GT(repetitions(numbers_of_extreme_names([](Request r) {
              r.step &= 0xffffffffU;
              return draw(r);
            })),
            0U);
  EXPECT_GT(repetitions(numbers_of_extreme_names([](Request r) {
              r.stage &= 0x7f;
              return draw(r);
            })),
            0U);
}

std::vector<std::uint64_t> words(std::uint32_t id, Purpose purpose, std::uint64_t step,
                                 std::size_t count) {
  Noise noise(3, 4);
  noise.set_step(step);
  auto stream = noise.particle_stream(id, purpose);
  std::vector<std::uint64_t> all(count);
  std::generate(all.begin(), all.end(), [&] { return stream(); });
  return all;
}

TEST(NoiseStream, OfParticlesAreAllDifferent) {
  std::vector<std::uint64_t> all;
  for (const std::uint32_t id : {0U, 1U, 65536U, 0xffffffffU}) {
    for (const std::uint64_t step : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32}) {
      for (const auto purpose :
           {Purpose::friction, Purpose::heat, Purpose::initial_velocity, Purpose::initial_energy,
            Purpose::initial_position, Purpose::monte_carlo}) {
        const auto some = words(id, purpose, step, 400);
        all.insert(all.end(), some.begin(), some.end());
      }
    }
  }
  const std::size_t total = all.size();
  std::sort(all.begin(), all.end());
  EXPECT_EQ(static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin()), total);
}

TEST(NoiseStream, DoesNotRepeatWithinAHundredThousandWords) {
  auto all = words(0, Purpose::monte_carlo, 1, 100000);
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

TEST(NoiseStream, CopiesAreIndependentReadersOfTheSameNumbers) {
  auto stream = Noise(1, 0).particle_stream(5, Purpose::initial_energy);
  stream();
  auto copy = stream;
  for (int n = 0; n < 10; ++n) EXPECT_EQ(stream(), copy());
  copy();
  auto again = Noise(1, 0).particle_stream(5, Purpose::initial_energy);
  for (int n = 0; n < 11; ++n) again();
  EXPECT_EQ(stream(), again());
}

/// One variate for each of many particles.
template <class Distribution>
std::vector<double> variates(Purpose purpose, Distribution distribution) {
  const Noise noise(17, 3);
  std::vector<double> all;
  for (std::uint32_t id = 0; id < 200000; ++id) {
    auto stream = noise.particle_stream(id, purpose);
    distribution.reset();
    all.push_back(distribution(stream));
  }
  return all;
}

struct Moments {
  double mean, variance;
};
Moments moments(const std::vector<double>& x) {
  double mean = 0, variance = 0;
  for (const double z : x) mean += z / static_cast<double>(x.size());
  for (const double z : x) variance += (z - mean) * (z - mean) / static_cast<double>(x.size());
  return {mean, variance};
}

TEST(NoiseStream, FeedsTheDistributionsOfBoostAndOfTheStandardLibrary) {
  const double n = 200000;
  const auto uniform = variates(Purpose::initial_position, boost::random::uniform_01<double>());
  EXPECT_TRUE(is_uniform(uniform));
  EXPECT_TRUE(
      is_normal(variates(Purpose::initial_velocity, boost::random::normal_distribution<double>())));
  EXPECT_TRUE(is_normal(variates(Purpose::initial_velocity, std::normal_distribution<double>())));
  const double a = 26;  // mean a, variance a, fourth central moment 3 a^2 + 6 a
  const auto gamma =
      moments(variates(Purpose::initial_energy, boost::random::gamma_distribution<double>(a)));
  EXPECT_NEAR(gamma.mean, a, bound * std::sqrt(a / n));
  EXPECT_NEAR(gamma.variance, a, bound * std::sqrt((2 * a * a + 6 * a) / n));
}

TEST(NoiseStream, BothHalvesOfAllBlocksAreUniform) {
  std::vector<double> x;
  for (std::uint32_t id = 0; id < 100; ++id) {
    for (const auto word : words(id, Purpose::initial_energy, 0, 1000)) {
      x.push_back(static_cast<double>(word >> 11) * 0x1p-53);
    }
  }
  EXPECT_TRUE(is_uniform(x));
  std::vector<double> low;  // the low half of the words
  for (std::uint32_t id = 0; id < 100; ++id) {
    for (const auto word : words(id, Purpose::initial_energy, 0, 1000)) {
      low.push_back(static_cast<double>(word & 0xffffffffU) * 0x1p-32);
    }
  }
  EXPECT_TRUE(is_uniform(low));
}

// The known answers that Random123 publishes for philox4x32 with 10 rounds.
TEST(Philox, GivesThePublishedAnswers) {
  using Philox = r123::Philox4x32;
  const auto answer = [](Philox::ctr_type counter, Philox::key_type key) {
    return Philox{}(counter, key);
  };
  const std::uint32_t ones = 0xffffffffU;
  EXPECT_EQ(answer({{0, 0, 0, 0}}, {{0, 0}}),
            (Philox::ctr_type{{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}}));
  EXPECT_EQ(answer({{ones, ones, ones, ones}}, {{ones, ones}}),
            (Philox::ctr_type{{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}}));
  EXPECT_EQ(
      answer({{0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}}, {{0xa4093822U, 0x299f31d0U}}),
      (Philox::ctr_type{{0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}}));
}

// Committed results are repeated from their seeds: what a seed means may not change unnoticed.
TEST(NoiseStream, OfASeedIsTheSameInEveryVersion) {
  Noise noise(20240607, 12);
  noise.set_step((std::uint64_t{1} << 32) + 345);
  auto stream = noise.particle_stream(6, Purpose::initial_energy);
  EXPECT_EQ(stream(), 0x250f8d5f190685b5U);
  EXPECT_EQ(stream(), 0x40841c95dc2e8324U);
  EXPECT_EQ(stream(), 0xd91bdb5a90526215U);
}

}  // namespace
}  // namespace driftless
