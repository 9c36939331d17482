#include "experiments/distribution_distance.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace driftless {
namespace {

double total(const Block& block) {
  return static_cast<double>(
      std::accumulate(block.counts.begin(), block.counts.end(), std::uint64_t{0}));
}

/// Blocks that hold samples, in order of replica and time.
std::vector<Block> sorted_blocks(const std::vector<Block>& blocks) {
  std::vector<Block> result;
  for (const Block& block : blocks) {
    if (block.counts.size() != blocks.front().counts.size()) {
      throw std::invalid_argument("blocks differ in their number of bins");
    }
    if (total(block) > 0.0) result.push_back(block);
  }
  const auto before = [](const Block& a, const Block& b) {
    return a.replica != b.replica ? a.replica < b.replica : a.index < b.index;
  };
  std::sort(result.begin(), result.end(), before);
  for (std::size_t i = 1; i < result.size(); ++i) {
    if (!before(result[i - 1], result[i])) throw std::invalid_argument("a block is given twice");
  }
  return result;
}

/// Only blocks that follow each other in the sorted order can be neighbours.
bool are_neighbours(const Block& earlier, const Block& later) {
  return earlier.replica == later.replica && later.index - earlier.index == 1;
}

/// Blocks by inner edges: F_A(t) - t, scaled so that a row product is the mean over t.
Eigen::MatrixXd deviations(const std::vector<Block>& blocks) {
  const std::size_t bins = blocks.front().counts.size();
  Eigen::MatrixXd result(static_cast<Eigen::Index>(blocks.size()),
                         static_cast<Eigen::Index>(bins) - 1);
  for (std::size_t row = 0; row < blocks.size(); ++row) {
    const double samples = total(blocks[row]);
    std::uint64_t below = 0;
    for (std::size_t edge = 1; edge < bins; ++edge) {
      below += blocks[row].counts[edge - 1];
      result(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(edge) - 1) =
          static_cast<double>(below) / samples -
          static_cast<double>(edge) / static_cast<double>(bins);
    }
  }
  return result / std::sqrt(static_cast<double>(bins));
}

/// Sum over blocks of squares, and with neighbours' products added where these are positive.
struct Scatter {
  double independent = 0.0;
  double with_neighbours = 0.0;
};

Scatter scatter(const std::vector<Block>& blocks, const Eigen::VectorXd& influence) {
  Scatter result;
  result.independent = influence.squaredNorm();
  double products = 0.0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (are_neighbours(blocks[i - 1], blocks[i])) products += influence[row - 1] * influence[row];
  }
  result.with_neighbours = result.independent + std::max(0.0, 2.0 * products);
  return result;
}

/// The statistic is sum(products)/sum(weights) over the pairs of independent blocks; here the parts
/// of both sums that each block takes part in.
struct PairSums {
  Eigen::VectorXd products;
  Eigen::VectorXd weights;
};

PairSums pair_sums(const std::vector<Block>& blocks, const Eigen::VectorXd& samples) {
  const Eigen::MatrixXd scaled = samples.asDiagonal() * deviations(blocks);
  const Eigen::VectorXd sum = scaled.colwise().sum().transpose();
  PairSums result;
  result.products = scaled * sum - scaled.rowwise().squaredNorm();
  result.weights = samples.array() * (samples.sum() - samples.array());
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    if (!are_neighbours(blocks[i - 1], blocks[i])) continue;
    const auto row = static_cast<Eigen::Index>(i);
    const double product = scaled.row(row).dot(scaled.row(row - 1));
    const double weight = samples[row] * samples[row - 1];
    for (const Eigen::Index one : {row - 1, row}) {
      result.products[one] -= product;
      result.weights[one] -= weight;
    }
  }
  return result;
}

Eigen::VectorXd sample_counts(const std::vector<Block>& blocks) {
  Eigen::VectorXd samples(static_cast<Eigen::Index>(blocks.size()));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    samples[static_cast<Eigen::Index>(i)] = total(blocks[i]);
  }
  return samples / samples.maxCoeff();
}

/// Share of each block's samples in the bins from `first` up to and without `last`.
Eigen::ArrayXd shares_of(const std::vector<Block>& blocks, std::size_t first, std::size_t last) {
  Eigen::ArrayXd shares(static_cast<Eigen::Index>(blocks.size()));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    std::uint64_t inside = 0;
    for (std::size_t bin = first; bin < last; ++bin) inside += blocks[i].counts[bin];
    shares[static_cast<Eigen::Index>(i)] = static_cast<double>(inside) / total(blocks[i]);
  }
  return shares;
}

}  // namespace

Estimate distribution_distance(const std::vector<Block>& all_blocks) {
  const std::vector<Block> blocks = sorted_blocks(all_blocks);
  if (blocks.size() < 2) throw std::invalid_argument("a distance needs two blocks of samples");
  const Eigen::VectorXd samples = sample_counts(blocks);
  const PairSums pairs = pair_sums(blocks, samples);
  // Every pair is in two blocks' sums.
  const double products = 0.5 * pairs.products.sum();
  const double weights = 0.5 * pairs.weights.sum();
  const double least = 1e-9 * samples.squaredNorm();
  if (weights < least) throw std::invalid_argument("all blocks are neighbours of each other");
  Estimate result;
  result.mean = products / weights;
  result.effective_samples = samples.sum() * samples.sum() / samples.squaredNorm();
  const Eigen::ArrayXd weights_left = weights - pairs.weights.array();
  if (blocks.size() < 4 || weights_left.minCoeff() < least) {
    result.error = std::numeric_limits<double>::infinity();
    return result;
  }
  const Eigen::ArrayXd without = (products - pairs.products.array()) / weights_left;
  const Scatter sums = scatter(blocks, without - without.mean());
  const double count = static_cast<double>(blocks.size());
  result.error = std::sqrt((count - 1.0) / count * sums.with_neighbours);
  if (sums.with_neighbours > 0.0) {
    result.effective_samples *= sums.independent / sums.with_neighbours;
  }
  result.degrees_of_freedom = std::max(1.0, result.effective_samples - 1.0);
  result.error *= student_factor(result.degrees_of_freedom);
  return result;
}

Histogram display_histogram(const BinnedLaw& law, const std::vector<Block>& all_blocks,
                            std::size_t display_bins) {
  const std::vector<Block> blocks = sorted_blocks(all_blocks);
  Histogram result;
  if (blocks.empty()) return result;
  const std::size_t bins = law.bins();
  if (blocks.front().counts.size() != bins) {
    throw std::invalid_argument("blocks differ from the law in their number of bins");
  }
  const Eigen::VectorXd samples = sample_counts(blocks);
  const Eigen::ArrayXd weights = samples / samples.sum();
  // Of the weighted scatter's expectation, 1 - 1/n for n equal blocks.
  const double unbiased = std::max(1.0 - weights.square().sum(), 1e-9);
  const std::vector<double>& edges = law.edges();
  const double width = (edges[bins - 1] - edges[1]) / static_cast<double>(display_bins);
  for (std::size_t first = 1; first + 1 < bins;) {
    std::size_t last = first + 1;
    while (last + 1 < bins && 0.5 * (edges[last] + edges[last + 1]) - edges[first] < width) ++last;
    const Eigen::ArrayXd shares = shares_of(blocks, first, last);
    const double share = (weights * shares).sum();
    const Scatter sums = scatter(blocks, weights * (shares - share));
    const double extent = edges[last] - edges[first];
    result.x.push_back(0.5 * (edges[first] + edges[last]));
    result.density.push_back(share / extent);
    result.error.push_back(std::sqrt(sums.with_neighbours / unbiased) / extent);
    result.exact.push_back(static_cast<double>(last - first) / static_cast<double>(bins) / extent);
    first = last;
  }
  return result;
}

}  // namespace driftless
