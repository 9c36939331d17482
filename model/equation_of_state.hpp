#pragma once

#include <cmath>

#include "model/lanes.hpp"

namespace driftless {

/// Entropy s(u) of a particle: temperature 1/theta = ds/du, heat capacity c = du/dtheta.
class EquationOfState {
 public:
  /// s = phi ln u.
  static EquationOfState constant_heat_capacity(double phi) { return {phi, 1 / phi, 0}; }
  /// theta = T whatever u, s = u/T.
  static EquationOfState reservoir(double temperature) { return {0, 0, temperature}; }

  template <class V>
  V temperature(V u) const {
    if (reservoir_ > 0) return V(reservoir_);
    return u * inverse_heat_capacity_;
  }
  template <class V>
  V inverse_heat_capacity(V /*u*/) const {
    return V(inverse_heat_capacity_);
  }
  template <class V>
  V entropy(V u) const {
    using std::log;
    if (reservoir_ > 0) return u * (1 / reservoir_);
    return heat_capacity_ * log(u);
  }
  template <class V>
  V entropy_gain(V u, V gain) const {
    using std::abs;
    using std::log;
    if (reservoir_ > 0) return gain * (1 / reservoir_);
    // log(1 + x) = x log(y)/(y - 1) with y = 1 + x as rounded (Kahan).
    const V x = gain / u, y = 1 + x, away = y - 1;
    const auto seen = abs(away) > 0;
    return heat_capacity_ * x * select(seen, log(y) / select(seen, away, V(1)), V(1));
  }
  double internal_energy(double temperature) const { return heat_capacity_ * temperature; }

 private:
  EquationOfState(double phi, double inverse, double reservoir)
      : heat_capacity_(phi), inverse_heat_capacity_(inverse), reservoir_(reservoir) {}
  double heat_capacity_, inverse_heat_capacity_, reservoir_;
};

}  // namespace driftless
