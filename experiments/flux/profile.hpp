#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/statistics.hpp"
#include "model/system.hpp"

namespace driftless::flux {

/// Profiles of density and temperatures along an axis in bins of equal width, with error bars that
/// count autocorrelation.
class Profile {
 public:
  Profile(const Box& box, int axis, std::size_t bins);

  void sample(const System& system);

  std::size_t bins() const { return bins_; }
  double width() const { return width_; }
  double centre(std::size_t bin) const { return (static_cast<double>(bin) + 0.5) * width_; }
  /// Number density of a bin.
  Estimate density(std::size_t bin) const;
  /// 1/<1/theta> and 2 K/3k of the particles in a bin, the mean of all particles' momenta at rest.
  Estimate internal_temperature(std::size_t bin) const;
  Estimate kinetic_temperature(std::size_t bin) const;

  /// Straight lines through the internal temperatures of some bins, against their centres' distance
  /// from `origin`, which may be mirrored: so the two ways from a hot slab to a cold one are fitted
  /// as one.
  struct Line {
    Estimate slope;
    Estimate middle;        ///< temperature at the mean distance
    Estimate mean_density;  ///< of these bins
  };
  Line line(const std::vector<std::size_t>& bins, double origin) const;

 private:
  /// Samples of some quantities: columns of the bins, one quantity after the other.
  enum Quantity { count, inverse_temperature, kinetic };
  Eigen::MatrixXd samples(const std::vector<std::size_t>& bins,
                          const std::vector<Quantity>& quantities) const;

  int axis_;
  std::size_t bins_;
  double width_, bin_volume_, length_;
  double boltzmann_ = 1, kinetic_share_ = 1;
  std::vector<std::vector<double>> rows_;  ///< of a sample: the quantities of all bins
};

}  // namespace driftless::flux
