#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace driftless {

/// A known law on an interval, cut into bins of equal probability, so that samples can be counted
/// without evaluating its distribution function.
class BinnedLaw {
 public:
  /// Beta(a, b) on (0, 1): the share of one part of a Dirichlet law, such as one particle's
  /// internal energy in the total. Throws std::invalid_argument unless a, b > 0 and there are two
  /// bins or more.
  static BinnedLaw beta(double a, double b, std::size_t bins = 256);

  /// x in (-1, 1), symmetric about 0, with x^2 ~ Beta(1/2, b): one momentum component over the root
  /// of what it could be at most. Throws as `beta`.
  static BinnedLaw signed_root(double b, std::size_t bins = 256);

  /// The standard normal law: one momentum component under a bath. Its first and last edges are
  /// infinite. Throws std::invalid_argument unless there are two bins or more.
  static BinnedLaw normal(std::size_t bins = 256);

  /// The Gamma law of a shape: an internal energy under a bath, in units of k T. Its last edge is
  /// infinite. Throws std::invalid_argument unless the shape is positive and there are two bins or
  /// more.
  static BinnedLaw gamma(double shape, std::size_t bins = 256);

  /// Bin of a sample, from 0: edges()[bin] <= sample < edges()[bin + 1]. Samples outside the law's
  /// interval go to its end bins; one that is not a number, to bin 0.
  std::size_t bin(double sample) const;

  std::size_t bins() const { return edges_.size() - 1; }

  /// The bins' limits, one more than bins, rising: first and last are the ends of the interval.
  const std::vector<double>& edges() const { return edges_; }

  /// Exact mean density in a bin, per unit of the sample: probability 1/bins over the bin's width.
  double density(std::size_t bin) const;

 private:
  explicit BinnedLaw(std::vector<double> edges);

  std::vector<double> edges_;
  // Equal cells between the first and the last inner edge; each knows the bin its left end is in.
  std::vector<std::uint32_t> guide_;
  double cells_per_unit_ = 0.0;
};

}  // namespace driftless
