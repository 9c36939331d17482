#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "experiments/statistics.hpp"

namespace driftless::transport {

/// How a mode decays: values at equally spaced times from 0 on, in any unit.
struct Decay {
  double interval = 1;
  std::vector<double> values;
};

/// value(t) = amplitude exp(-rate t).
struct Exponential {
  double amplitude = 0, rate = 0;
};

/// The exponential through the times at which the curve, over its first value, first falls below
/// `from` until it first falls below `to` (or ends), by least squares of logarithms weighted with
/// the squares of the values. Nothing if there are fewer than three such times.
std::optional<Exponential> fit_exponential(const Decay& decay, double from = 0.9, double to = 0.2);

/// The rate 1/int_0^infinity value(t)/value(0) dt: Simpson's rule until the curve has fallen to
/// `to`, the exponential's integral from there on. Whatever the form of the decay, this is the rate
/// that the response to a steady source has; of an exponential it is the rate of decay. Throws
/// std::domain_error if the curve does not decay.
double integral_rate(const Decay& decay, double to = 0.1);

/// value(t) = exp(-rate t) (cosine cos(frequency t) + sine sin(frequency t)).
struct Oscillation {
  double rate = 0, frequency = 0, cosine = 0, sine = 0;
  /// omega_0 of q'' + 2 rate q' + omega_0^2 q = 0: sound speed times wavenumber.
  double undamped_frequency() const;
};

/// The damped oscillation by least squares (Levenberg and Marquardt), from a first guess of the
/// undamped frequency. Nothing if it is not found, or if there is no oscillation.
std::optional<Oscillation> fit_oscillation(const Decay& decay, double undamped_frequency);

/// What a number that is computed from the mean of curves is worth: delete-one jackknife over
/// independent replicas, widened by Student's factor. Infinite error with fewer than two replicas
/// or where `derive` gives no finite number. All curves have the same length. Throws
/// std::invalid_argument without curves.
Estimate jackknife(const std::vector<std::vector<double>>& replicas,
                   const std::function<double(const std::vector<double>& mean)>& derive);

}  // namespace driftless::transport
