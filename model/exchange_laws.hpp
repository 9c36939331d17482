#pragma once

#include "model/coefficient_law.hpp"

namespace driftless {

/// Friction of one pair: force -zeta v plus noise of strength Gamma along the pair's direction.
template <class V>
struct FrictionLaw {
  V friction;       ///< zeta
  V noise_squared;  ///< Gamma^2 = 2 k zeta Theta (Mackie et al. 1999, eq. 2.37)
  V induced;        ///< (1/4)(d/du_i + d/du_j) Gamma^2, the noise-induced friction
};

/// Conduction of one pair: heat rate lambda (theta_j - theta_i) plus noise of strength Lambda, from
/// j to i.
template <class V>
struct ConductionLaw {
  V rate;           ///< lambda (theta_j - theta_i)
  V noise_squared;  ///< Lambda^2 = 2 k lambda theta_i theta_j (Mackie et al. 1999, eq. 2.38)
  V induced;        ///< (1/2)(d/du_i - d/du_j) Lambda^2, the noise-induced heat rate
};

/// How the amplitude of a noise follows a pair's energies: d ln Gamma/du_i and d ln Gamma/du_j, or
/// the same of Lambda.
template <class V>
struct AmplitudeSlopes {
  V by_u_i, by_u_j;
};

/// The temperatures of a pair and how they follow the energies.
template <class V>
struct PairTemperatures {
  V theta_i, theta_j;
  V inverse_capacity_i, inverse_capacity_j;  ///< 1/c = dtheta/du

  V product() const { return theta_i * theta_j; }
  /// Theta, 1/Theta = (1/theta_i + 1/theta_j)/2 (Mackie et al. 1999, eq. 2.37).
  V mean() const { return 2 * product() / (theta_i + theta_j); }
};

// What friction and conduction are made of, for coefficients that depend on the temperatures in any
// way and for any equations of state. Either noise has the strength 2 k A, where A is what is
// called its intensity here:
//   friction    A = zeta Theta             (of the closure `noise`, A itself is given)
//   conduction  A = lambda theta_i theta_j (of the form `inverse_temperature`, A = L is given)
// By A_i = dA/dtheta_i and c = du/dtheta,
//   (1/4)(d/du_i + d/du_j) 2 k A = (k/2)(A_i/c_i + A_j/c_j)  is the noise-induced friction,
//   (1/2)(d/du_i - d/du_j) 2 k A = k (A_i/c_i - A_j/c_j)     the noise-induced heat rate.

/// A = zeta Theta of a friction coefficient zeta.
template <class V>
Coefficient<V> friction_intensity(const Coefficient<V>& zeta, const PairTemperatures<V>& at) {
  const V mean = at.mean();
  // dTheta/dtheta_i = Theta^2/(2 theta_i^2)
  const auto slope = [&](V theta, V by_theta) {
    const V ratio = mean / theta;
    return by_theta * mean + 0.5 * zeta.value * ratio * ratio;
  };
  return {zeta.value * mean, slope(at.theta_i, zeta.by_theta_i),
          slope(at.theta_j, zeta.by_theta_j)};
}

/// A = lambda theta_i theta_j of a conductivity lambda.
template <class V>
Coefficient<V> heat_intensity(const Coefficient<V>& lambda, const PairTemperatures<V>& at) {
  const V product = at.product();
  return {lambda.value * product, lambda.by_theta_i * product + lambda.value * at.theta_j,
          lambda.by_theta_j * product + lambda.value * at.theta_i};
}

/// The friction of a pair whose noise has a given intensity A.
template <class V>
FrictionLaw<V> friction_law(double boltzmann, const Coefficient<V>& intensity,
                            const PairTemperatures<V>& at) {
  const V inverse_mean = 0.5 * (at.theta_i + at.theta_j) / at.product();
  return {intensity.value * inverse_mean, 2 * boltzmann * intensity.value,
          0.5 * boltzmann *
              (intensity.by_theta_i * at.inverse_capacity_i +
               intensity.by_theta_j * at.inverse_capacity_j)};
}

/// The conduction of a pair whose noise has a given intensity A.
template <class V>
ConductionLaw<V> conduction_law(double boltzmann, const Coefficient<V>& intensity,
                                const PairTemperatures<V>& at) {
  return {intensity.value * (at.theta_j - at.theta_i) / at.product(),
          2 * boltzmann * intensity.value,
          boltzmann * (intensity.by_theta_i * at.inverse_capacity_i -
                       intensity.by_theta_j * at.inverse_capacity_j)};
}

/// d ln Gamma/du, or d ln Lambda/du, of a noise of intensity A > 0 up to a factor that does not
/// depend on the temperatures: left out should be the weights, which may be 0.
template <class V>
AmplitudeSlopes<V> amplitude_slopes(const Coefficient<V>& intensity,
                                    const PairTemperatures<V>& at) {
  const V half = 0.5 / intensity.value;
  return {half * intensity.by_theta_i * at.inverse_capacity_i,
          half * intensity.by_theta_j * at.inverse_capacity_j};
}

}  // namespace driftless
