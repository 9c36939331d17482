#pragma once

#include <vector>

#include "experiments/transport/decay.hpp"
#include "model/system.hpp"

namespace driftless::transport {

/// Follows every particle of a system through the periodic box: the mean squared displacement and
/// the autocorrelation of velocities, from origins one window apart, over all particles. Between
/// two samples no particle may move half of the box.
class Diffusion {
 public:
  /// A window has `lags` - 1 sampling intervals.
  explicit Diffusion(std::size_t lags) : displacement_(lags), velocity_(lags) {}

  void take(const System& system);

  /// <|r(t) - r(0)|^2>, and <v(t).v(0)>/3, by lag; of the windows begun so far.
  std::vector<double> squared_displacement() const { return means(displacement_); }
  std::vector<double> velocity_autocorrelation() const { return means(velocity_); }

 private:
  struct Sum {
    double value = 0, count = 0;
  };
  static std::vector<double> means(const std::vector<Sum>& sums);
  /// Adds what every particle moved since the last sample.
  void follow(const System& system);

  std::vector<Sum> displacement_, velocity_;
  std::size_t lag_ = 0;
  std::vector<Vector> last_, travelled_, first_velocity_;  ///< by id
};

/// D from the slope of the squared displacement, 6 D, over the second half of its window.
double diffusion_from_displacement(const Decay& squared_displacement);

/// D as the integral of the velocities' autocorrelation (Green and Kubo).
double diffusion_from_velocity(const Decay& velocity_autocorrelation);

}  // namespace driftless::transport
