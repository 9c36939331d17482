#pragma once

#include "integrators/flows.hpp"

namespace driftless {

/// (1 - exp(-x))/x for x >= 0, the mean of exp(-t) over 0 < t < x, to rounding.
template <class V>
V mean_decay(const V& x) {
  using std::exp;
  using std::max;
  const V series = 1 - x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6))));
  const V away = max(x, V(0.01));  // both are computed for every x
  return select(x < 0.01, series, (1 - exp(-away)) / away);
}

/// The change v' - v of the exact solution over dt of mu dv = -zeta v dt + Gamma dB at constant
/// coefficients, the Ornstein-Uhlenbeck process:
///   v' = e^{-x} v + (Gamma/mu) {dt (1 - e^{-2x})/(2x)}^{1/2} W,  x = zeta dt/mu
template <class V>
V ornstein_uhlenbeck(const Pair<V>& pair, const V& zeta, const V& noise_squared, double mu,
                     double dt) {
  using std::sqrt;
  const V x = zeta * dt / mu;
  return sqrt(noise_squared * dt * mean_decay(2 * x)) / mu * pair.noise -
         x * mean_decay(x) * pair.v;
}

}  // namespace driftless
