#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "experiments/binned_law.hpp"
#include "experiments/statistics.hpp"

namespace driftless {

/// Samples of a stretch of one replica's run, counted in the bins of a `BinnedLaw`. It should last
/// two or more integrated autocorrelation times (with 1/2 for independent samples) of the sampled
/// quantity, so that all but neighbouring blocks are independent: of blocks of 1.4 of them the
/// distance keeps a bias of a tenth of its standard deviation, of 0.7 a third.
struct Block {
  std::size_t replica = 0;
  std::size_t index = 0;  ///< number of the stretch in its replica, in order of time
  std::vector<std::uint64_t> counts;
};

/// Squared distance of the sampled from the exact law: the Cramer-von Mises statistic
/// omega^2 = int (F - F0)^2 dF0, without bias (1/3 for samples all beyond one end of the law).
///
/// With D_A(t) = F_A(t) - t at the inner edges of the bins, t = F0, it is the mean over pairs of
/// independent blocks A, B of mean_t D_A(t) D_B(t), pairs weighted by the blocks' sample counts. As
/// the expectation factorises, it is exactly 0 under the exact law, however the samples inside a
/// block hang together. The usual statistic of one sample is not: its expectation counts the
/// variance of D_A, which is known for independent samples only, whereas the particles of a
/// snapshot share one energy and successive snapshots resemble each other. The price is that the
/// estimate can be negative. Pairs of the same or of neighbouring blocks of a replica do not enter.
///
/// The error is the jackknife's over the blocks, with the covariance of neighbouring blocks added
/// where it is positive. Far from the exact law it is right. At the exact law, where the statistic
/// is degenerate (linear in no block alone), the jackknife's variance is twice the true one: errors
/// are some 40 % too large there, which about makes up for the long upper tail of the statistic's
/// law. `effective_samples` is the number of equally large independent blocks, one more than the
/// error's degrees of freedom; `replicas_disagree` is never set.
///
/// Blocks without samples are left out. Throws std::invalid_argument if the numbers of bins differ,
/// two blocks have the same replica and index, or no pair of independent blocks is left. With fewer
/// than four blocks the error is infinite.
Estimate distribution_distance(const std::vector<Block>& blocks);

/// A histogram to be shown, all vectors of the same size.
struct Histogram {
  std::vector<double> x;        ///< bin centres, rising
  std::vector<double> density;  ///< measured, per unit of x
  std::vector<double> error;    ///< its standard error
  std::vector<double> exact;    ///< exact mean density in the bin
};

/// Merges the law's bins into some `display_bins` of about equal width, with an error from the
/// scatter of the blocks. The law's two end bins, one part in bins() of the samples each, reach out
/// to where there are none and are left out. Empty if there is no sample. Throws
/// std::invalid_argument if a block has not the law's number of bins.
Histogram display_histogram(const BinnedLaw& law, const std::vector<Block>& blocks,
                            std::size_t display_bins = 40);

}  // namespace driftless
