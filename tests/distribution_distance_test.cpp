#include "experiments/distribution_distance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

// Every statistical statement below has a false-alarm rate of at most 1e-8; the seeds are fixed.

namespace driftless {
namespace {

using Random = std::mt19937_64;

/// A gas of parts that share one conserved energy. Each time step some pairs pool their energies
/// and share them anew, which keeps the exact Dirichlet law and resembles its past for a few steps.
class Gas {
 public:
  Gas(Random& random, int parts, double shape) : random_(random), shape_(shape) {
    std::gamma_distribution<double> gamma(shape, 1.0);
    shares_.resize(static_cast<std::size_t>(parts));
    double total = 0.0;
    for (double& share : shares_) total += share = gamma(random_);
    for (double& share : shares_) share /= total;
  }

  void step() {
    std::gamma_distribution<double> gamma(shape_, 1.0);
    std::uniform_int_distribution<std::size_t> any(0, shares_.size() - 1);
    for (std::size_t i = 0; i < shares_.size() / 3; ++i) {
      const std::size_t one = any(random_);
      const std::size_t other = any(random_);
      if (one == other) continue;
      const double first = gamma(random_);
      const double part = first / (first + gamma(random_));
      const double both = shares_[one] + shares_[other];
      shares_[one] = part * both;
      shares_[other] = (1.0 - part) * both;
    }
  }

  const std::vector<double>& shares() const { return shares_; }

 private:
  Random& random_;
  double shape_;
  std::vector<double> shares_;
};

constexpr int parts = 10;
constexpr double shape = 5.0;

BinnedLaw exact_law() { return BinnedLaw::beta(shape, shape * (parts - 1)); }

std::vector<Block> blocks_of(Random& random, const BinnedLaw& law, double scale,
                             std::size_t replicas, std::size_t blocks, int snapshots) {
  std::vector<Block> result;
  for (std::size_t replica = 0; replica < replicas; ++replica) {
    Gas gas(random, parts, shape);
    for (std::size_t index = 0; index < blocks; ++index) {
      Block block{replica, index, std::vector<std::uint64_t>(law.bins())};
      for (int snapshot = 0; snapshot < snapshots; ++snapshot) {
        for (const double share : gas.shares()) ++block.counts[law.bin(scale * share)];
        gas.step();
      }
      result.push_back(block);
    }
  }
  return result;
}

/// The usual statistic of all samples together, less its expectation for independent samples.
double one_sample_statistic(const std::vector<Block>& blocks) {
  const std::size_t bins = blocks.front().counts.size();
  std::vector<double> pooled(bins);
  double samples = 0.0;
  for (const Block& block : blocks) {
    for (std::size_t bin = 0; bin < bins; ++bin) {
      pooled[bin] += static_cast<double>(block.counts[bin]);
      samples += static_cast<double>(block.counts[bin]);
    }
  }
  double below = 0.0;
  double sum = 0.0;
  for (std::size_t edge = 1; edge < bins; ++edge) {
    below += pooled[edge - 1];
    const double t = static_cast<double>(edge) / static_cast<double>(bins);
    sum += (below / samples - t) * (below / samples - t) - t * (1.0 - t) / samples;
  }
  return sum / static_cast<double>(bins);
}

/// Mean of many repetitions over its standard error.
double bias_z(int repetitions, const std::function<double()>& statistic) {
  Eigen::ArrayXd values(repetitions);
  for (double& value : values) value = statistic();
  const double count = static_cast<double>(repetitions);
  const double variance = (values - values.mean()).square().sum() / (count - 1.0);
  return values.mean() / std::sqrt(variance / count);
}

// Beyond 6.5 standard errors a mean of 400 or more of these skew statistics is not by chance.
constexpr double bias_bound = 6.5;

TEST(DistributionDistance, IsZeroOnAverageUnderTheExactLaw) {
  Random random(1);
  const BinnedLaw law = exact_law();
  const double z = bias_z(
      600, [&] { return distribution_distance(blocks_of(random, law, 1.0, 4, 8, 20)).mean; });
  EXPECT_LT(std::abs(z), bias_bound);
}

TEST(DistributionDistance, OneSampleStatisticIsBiasedByCorrelationInTime) {
  Random random(2);
  const BinnedLaw law = exact_law();
  const double z =
      bias_z(400, [&] { return one_sample_statistic(blocks_of(random, law, 1.0, 4, 8, 20)); });
  EXPECT_GT(z, bias_bound);
}

TEST(DistributionDistance, OneSnapshotStatisticIsBiasedByTheSharedEnergy) {
  Random random(3);
  const BinnedLaw law = exact_law();
  const double z =
      bias_z(4000, [&] { return one_sample_statistic(blocks_of(random, law, 1.0, 1, 1, 1)); });
  EXPECT_LT(z, -bias_bound);
}

TEST(DistributionDistance, PairsOfNeighbouringBlocksWouldBiasIt) {
  // Blocks of one snapshot resemble their neighbours; numbered with gaps they all enter the pairs.
  const BinnedLaw law = exact_law();
  const auto z = [&](std::size_t stride) {
    Random random(4);
    return bias_z(1500, [&] {
      std::vector<Block> blocks;
      for (std::size_t replica = 0; replica < 3; ++replica) {
        // Independent stretches of two blocks: only neighbours resemble each other.
        for (std::size_t stretch = 0; stretch < 4; ++stretch) {
          for (Block& block : blocks_of(random, law, 1.0, 1, 2, 2)) {
            block.replica = replica;
            block.index = stride * block.index + 10 * stretch;
            blocks.push_back(block);
          }
        }
      }
      return distribution_distance(blocks).mean;
    });
  };
  EXPECT_LT(std::abs(z(1)), bias_bound);
  EXPECT_GT(z(2), bias_bound);
}

TEST(DistributionDistance, ErrorIsNotTooSmallUnderTheExactLaw) {
  Random random(5);
  const BinnedLaw law = exact_law();
  constexpr int repetitions = 600;
  double squares = 0.0;
  double errors = 0.0;
  int beyond = 0;
  for (int i = 0; i < repetitions; ++i) {
    const Estimate made = distribution_distance(blocks_of(random, law, 1.0, 4, 8, 20));
    squares += made.mean * made.mean / repetitions;
    errors += made.error * made.error / repetitions;
    beyond += std::abs(made.mean) > 1.96 * made.error;
    EXPECT_LE(made.effective_samples, 32.0);
  }
  // The expected ratio is 2 (see the function); squares of such skew values are known to 20 %.
  EXPECT_GT(errors, squares);
  EXPECT_LT(errors, 4.0 * squares);
  EXPECT_LT(beyond, 0.05 * repetitions + 6.0 * std::sqrt(0.05 * repetitions));
}

TEST(DistributionDistance, CatchesAScaleWrongByOnePercent) {
  const BinnedLaw law = exact_law();
  const auto z = [&](double scale) {
    Random random(6);
    const Estimate made = distribution_distance(blocks_of(random, law, scale, 4, 12, 2000));
    return made.mean / made.error;
  };
  EXPECT_LT(std::abs(z(1.0)), 6.0);
  EXPECT_GT(z(1.01), 6.0);
  EXPECT_GT(z(0.99), 6.0);
}

TEST(DistributionDistance, IsTheCramerVonMisesDistanceOfAnotherLaw) {
  // Beta(1, 1) samples against Beta(2, 1), F0 = x^2: int (sqrt(t) - t)^2 dt = 1/30.
  const BinnedLaw law = BinnedLaw::beta(2.0, 1.0);
  constexpr int repetitions = 400;
  Random random(7);
  std::uniform_real_distribution<double> uniform;
  int held = 0;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < repetitions; ++i) {
    std::vector<Block> blocks;
    for (std::size_t replica = 0; replica < 40; ++replica) {
      Block block{replica, 0, std::vector<std::uint64_t>(law.bins())};
      // Unequal blocks.
      for (std::size_t j = 0; j < 20 + replica; ++j) ++block.counts[law.bin(uniform(random))];
      blocks.push_back(block);
    }
    const Estimate made = distribution_distance(blocks);
    held += std::abs(made.mean - 1.0 / 30.0) < 1.96 * made.error;
    sum += made.mean / repetitions;
    squares += made.mean * made.mean / repetitions;
  }
  const double error = std::sqrt((squares - sum * sum) / repetitions);
  // The sum over 256 edges replaces the integral; its error is below 1e-4.
  EXPECT_NEAR(sum, 1.0 / 30.0, 6.0 * error + 1e-4);
  EXPECT_GT(held, 0.93 * repetitions - 6.0 * std::sqrt(0.07 * repetitions));
}

TEST(DistributionDistance, DependsOnNoOrderAndScalesWithNoCount) {
  Random random(8);
  std::vector<Block> blocks = blocks_of(random, exact_law(), 1.1, 3, 5, 3);
  const Estimate made = distribution_distance(blocks);
  std::swap(blocks[0], blocks[7]);
  for (Block& block : blocks) {
    for (std::uint64_t& count : block.counts) count *= 3;
  }
  const Estimate again = distribution_distance(blocks);
  EXPECT_NEAR(again.mean, made.mean, 1e-14);
  EXPECT_NEAR(again.error, made.error, 1e-14);
  EXPECT_FALSE(made.replicas_disagree);
}

Block block(std::size_t replica, std::size_t index, std::vector<std::uint64_t> counts) {
  return {replica, index, std::move(counts)};
}

TEST(DistributionDistance, RefusesBlocksThatSayNothing) {
  EXPECT_THROW(distribution_distance({}), std::invalid_argument);
  EXPECT_THROW(distribution_distance({block(0, 0, {1, 2})}), std::invalid_argument);
  EXPECT_THROW(distribution_distance({block(0, 0, {1, 2}), block(0, 1, {1, 2})}),
               std::invalid_argument);
  EXPECT_THROW(distribution_distance({block(0, 0, {1, 2}), block(1, 0, {0, 0})}),
               std::invalid_argument);
  EXPECT_THROW(distribution_distance({block(0, 0, {1, 2}), block(0, 0, {1, 2})}),
               std::invalid_argument);
  EXPECT_THROW(distribution_distance({block(0, 0, {1, 2}), block(1, 0, {1, 2, 3})}),
               std::invalid_argument);
}

TEST(DistributionDistance, TwoBlocksByHand) {
  // One inner edge at 1/2: (3/4 - 1/2)(1 - 1/2), averaged over two bins.
  const Estimate made = distribution_distance({block(0, 0, {3, 1}), block(1, 0, {2, 0})});
  EXPECT_DOUBLE_EQ(made.mean, 0.25 * 0.5 / 2.0);
  EXPECT_EQ(made.error, std::numeric_limits<double>::infinity());
}

TEST(DisplayHistogram, ShowsTheExactLaw) {
  Random random(9);
  const BinnedLaw law = exact_law();
  const Histogram shown = display_histogram(law, blocks_of(random, law, 1.0, 4, 20, 50));
  ASSERT_GE(shown.x.size(), 20u);
  ASSERT_LE(shown.x.size(), 45u);
  const Histogram scaled = display_histogram(law, blocks_of(random, law, 1.2, 4, 20, 50));
  double largest_z = 0.0;
  double largest_scaled_z = 0.0;
  for (std::size_t i = 0; i < shown.x.size(); ++i) {
    if (i > 0) {
      EXPECT_GT(shown.x[i], shown.x[i - 1]);
    }
    const double x = shown.x[i];
    const double exact = std::exp(std::lgamma(shape * parts) - std::lgamma(shape) -
                                  std::lgamma(shape * (parts - 1))) *
                         std::pow(x, shape - 1) * std::pow(1 - x, shape * (parts - 1) - 1);
    EXPECT_NEAR(shown.exact[i], exact, 0.04 * exact + 0.02);
    largest_z = std::max(largest_z, std::abs(shown.density[i] - shown.exact[i]) / shown.error[i]);
    largest_scaled_z =
        std::max(largest_scaled_z, std::abs(scaled.density[i] - scaled.exact[i]) / scaled.error[i]);
  }
  EXPECT_LT(largest_z, 7.5);  // of 40 bins, with errors from 80 blocks
  EXPECT_GT(largest_scaled_z, 7.5);
}

TEST(DisplayHistogram, ErrorIsThatOfABinomialLawForIndependentSamples) {
  const BinnedLaw law = BinnedLaw::signed_root(20.0);
  Random random(10);
  std::uniform_int_distribution<std::size_t> any(0, law.bins() - 1);
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < 400; ++i) {
    blocks.push_back(block(i, 0, std::vector<std::uint64_t>(law.bins())));
    for (int j = 0; j < 500; ++j) ++blocks.back().counts[any(random)];
  }
  const Histogram shown = display_histogram(law, blocks);
  ASSERT_FALSE(shown.x.empty());
  for (std::size_t i = 0; i < shown.x.size(); ++i) {
    const double width = i + 1 < shown.x.size() ? shown.x[i + 1] - shown.x[i] : 0.0;
    if (width == 0.0) continue;
    const double extent = shown.exact[i] > 0.0 ? width : 1.0;
    const double share = shown.exact[i] * extent;
    // Neighbouring bins differ a little in width; errors from 400 blocks are good to 4 %.
    EXPECT_NEAR(shown.error[i] * extent, std::sqrt(share * (1.0 - share) / 200000.0),
                0.35 * std::sqrt(share / 200000.0));
  }
}

TEST(DisplayHistogram, HandlesNoSamplesAndRefusesOtherBins) {
  const BinnedLaw law = BinnedLaw::beta(2.0, 2.0, 8);
  EXPECT_TRUE(display_histogram(law, {}).x.empty());
  EXPECT_THROW(display_histogram(law, {block(0, 0, {1, 2})}), std::invalid_argument);
}

}  // namespace
}  // namespace driftless
