#pragma once

#include <algorithm>
#include <cmath>

#include "model/pair.hpp"

namespace driftless {

/// Which of the two friction coefficients depends on the distance alone (theory of the closures:
/// Espanol 1997 for `noise`, Mackie, Bonet Avalos and Navas 1999, eq. 3.23, for `friction`).
enum class FrictionClosure { noise, friction };

/// Which heat coefficient depends on the distance alone: L of eq. 3.24 of Mackie et al. 1999
/// (`inverse_temperature`, flux L (1/theta_i - 1/theta_j)) or the conductivity lambda of Ripoll and
/// Ernst 2005 (`temperature`, flux lambda (theta_i - theta_j)).
enum class HeatForm { none, inverse_temperature, temperature };

/// Parameters of one species of particles, all in program units: of DPDE, with internal energies,
/// or of isothermal DPD, where a bath takes their place.
struct FluidParameters {
  double boltzmann = 1;      ///< Boltzmann's constant k >= 0; 0 switches every fluctuation off
  double mass = 1;           ///< particle mass m > 0
  double temperature = 1;    ///< T > 0 at which `friction` is quoted; of the bath if isothermal
  double heat_capacity = 1;  ///< phi = du/dtheta > 0 of one particle (s = phi ln u)
  double repulsion = 0;      ///< a of psi = (a r_c/2)(1 - r/r_c)^2 (Groot and Warren 1997)
  double repulsion_range = 1;
  double friction = 0;  ///< zeta_0 at temperature T, for either closure
  FrictionClosure friction_closure = FrictionClosure::noise;
  double friction_range = 1;
  double conduction = 0;  ///< L_0 for `inverse_temperature`, lambda_0 for `temperature`
  HeatForm heat_form = HeatForm::none;
  double heat_range = 1;
  double weight_exponent = 2;  ///< s of w(r) = (1 - r/r_c)^s, for friction and heat
  /// Particles have no internal energy: friction and its noise exchange energy with a bath of the
  /// temperature T, Gamma^2 = 2 k T zeta with zeta = zeta_0 w(r) for either closure [Espanol,
  /// Warren, Europhys. Lett. 30, 191 (1995)]. Nothing conducts, and the heat capacity has no
  /// meaning.
  bool isothermal = false;

  bool has_repulsion() const { return repulsion != 0; }
  bool has_friction() const { return friction != 0; }
  bool has_conduction() const { return heat_form != HeatForm::none && conduction != 0; }
  bool operator==(const FluidParameters&) const = default;
};

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

/// The constitutive laws: what a pair exchanges per unit time, as functions of what the pair sees.
/// Every function is pure and generic in V (double or a vector of lanes).
class Fluid {
 public:
  /// Throws std::invalid_argument naming the parameter, its value and the allowed range. If
  /// isothermal, the closure is `noise` and the heat capacity 1, so that bath_energy() has the
  /// bath's temperature and the laws below are those of the bath.
  explicit Fluid(const FluidParameters& parameters);

  const FluidParameters& parameters() const { return parameters_; }
  bool has_repulsion() const { return parameters_.has_repulsion(); }
  bool has_friction() const { return parameters_.has_friction(); }
  bool has_conduction() const { return parameters_.has_conduction(); }
  bool isothermal() const { return parameters_.isothermal; }
  /// What kernels see in the place of an internal energy in an isothermal fluid.
  double bath_energy() const { return internal_energy(parameters_.temperature); }
  bool fluctuates() const { return parameters_.boltzmann > 0; }
  double boltzmann() const { return parameters_.boltzmann; }
  double mass() const { return parameters_.mass; }
  double reduced_mass() const { return parameters_.mass / 2; }

  /// The largest range of the terms that act; 0 if none does.
  double range() const;

  /// theta(u) = u/phi, temperature of a particle (ds/du = 1/theta).
  template <class V>
  V temperature(V internal_energy) const {
    return internal_energy * inverse_heat_capacity_;
  }
  /// c(u) = du/dtheta.
  template <class V>
  V heat_capacity(V /*internal_energy*/) const {
    return V(parameters_.heat_capacity);
  }
  /// s(u) = phi ln u, up to a constant.
  template <class V>
  V entropy(V internal_energy) const {
    using std::log;
    return parameters_.heat_capacity * log(internal_energy);
  }
  /// s(u + gain) - s(u), to rounding however small the gain; both energies must be above 0.
  template <class V>
  V entropy_gain(V internal_energy, V gain) const {
    using std::abs;
    using std::log;
    // log(1 + x) = x log(y)/(y - 1) with y = 1 + x as rounded (Kahan).
    const V x = gain / internal_energy, y = 1 + x, away = y - 1;
    const auto seen = abs(away) > 0;
    return parameters_.heat_capacity * x * select(seen, log(y) / select(seen, away, V(1)), V(1));
  }
  /// u(theta), the inverse of temperature().
  double internal_energy(double temperature) const {
    return parameters_.heat_capacity * temperature;
  }

  template <class V>
  V friction_weight(V distance) const {
    return weight(distance, parameters_.friction_range);
  }
  template <class V>
  V heat_weight(V distance) const {
    return weight(distance, parameters_.heat_range);
  }

  /// Repulsive force on i along e at distance r: a (1 - r/r_c) inside the range.
  template <class V>
  V repulsive_force(V distance) const {
    return parameters_.repulsion * depth(distance, parameters_.repulsion_range);
  }
  /// psi(r) = (a r_c/2)(1 - r/r_c)^2 inside the range.
  template <class V>
  V potential(V distance) const {
    const V x = depth(distance, parameters_.repulsion_range);
    return 0.5 * parameters_.repulsion * parameters_.repulsion_range * x * x;
  }
  /// psi''(r) + 2 psi'(r)/r, the Laplacian of psi with respect to one particle's position.
  double potential_laplacian(double distance) const;

  /// Theta of two internal energies, 1/Theta = (1/theta_i + 1/theta_j)/2 (Mackie et al. 2.37).
  template <class V>
  V mean_temperature(V u_i, V u_j) const {
    const V theta_i = temperature(u_i), theta_j = temperature(u_j);
    return 2 * theta_i * theta_j / (theta_i + theta_j);
  }

  /// The friction law of a pair in its present state; zeta is constant in the energies for the
  /// closure `friction`, Gamma for the closure `noise`, where nothing is noise-induced.
  template <class V>
  FrictionLaw<V> friction(const Pair<V>& pair) const {
    const auto& f = parameters_;
    const V theta_i = temperature(pair.u_i), theta_j = temperature(pair.u_j);
    const V zeta_0 = f.friction * pair.w_friction;
    if (f.friction_closure == FrictionClosure::noise) {
      const V inverse_mean = 0.5 * (theta_i + theta_j) * inverse_product(theta_i, theta_j);
      return {zeta_0 * f.temperature * inverse_mean, 2 * f.boltzmann * zeta_0 * f.temperature,
              V(0)};
    }
    const V mean = mean_temperature(pair.u_i, pair.u_j);
    const V slope = mean * mean *
                    (1 / (heat_capacity(pair.u_i) * theta_i * theta_i) +
                     1 / (heat_capacity(pair.u_j) * theta_j * theta_j));
    return {zeta_0, 2 * f.boltzmann * zeta_0 * mean, 0.25 * f.boltzmann * zeta_0 * slope};
  }

  /// d ln Gamma/du of either particle; 0 for the closure `noise`. The noise-induced friction is
  /// Gamma^2/2 times their sum.
  template <class V>
  AmplitudeSlopes<V> friction_noise_slopes(const Pair<V>& pair) const {
    if (parameters_.friction_closure == FrictionClosure::noise) return {V(0), V(0)};
    const V mean = mean_temperature(pair.u_i, pair.u_j);
    const auto slope = [&](V u) {
      const V theta = temperature(u);
      return mean / (4 * heat_capacity(u) * theta * theta);
    };
    return {slope(pair.u_i), slope(pair.u_j)};
  }

  /// The conduction law of a pair in its present state.
  template <class V>
  ConductionLaw<V> conduction(const Pair<V>& pair) const {
    const auto& f = parameters_;
    const V theta_i = temperature(pair.u_i), theta_j = temperature(pair.u_j);
    const V coefficient = f.conduction * pair.w_heat;
    if (f.heat_form == HeatForm::inverse_temperature) {
      return {coefficient * (theta_j - theta_i) * inverse_product(theta_i, theta_j),
              2 * f.boltzmann * coefficient, V(0)};
    }
    return {coefficient * (theta_j - theta_i), 2 * f.boltzmann * coefficient * theta_i * theta_j,
            f.boltzmann * coefficient *
                (theta_j / heat_capacity(pair.u_i) - theta_i / heat_capacity(pair.u_j))};
  }

  /// lambda of a pair in its present state.
  template <class V>
  V conductivity(const Pair<V>& pair) const {
    const V coefficient = parameters_.conduction * pair.w_heat;
    if (parameters_.heat_form != HeatForm::inverse_temperature) return coefficient;
    return coefficient / (temperature(pair.u_i) * temperature(pair.u_j));
  }

  /// d ln Lambda/du of either particle; 0 for `inverse_temperature`. The noise-induced heat rate is
  /// Lambda^2 times their difference.
  template <class V>
  AmplitudeSlopes<V> heat_noise_slopes(const Pair<V>& pair) const {
    if (parameters_.heat_form != HeatForm::temperature) return {V(0), V(0)};
    const auto slope = [&](V u) { return 1 / (2 * heat_capacity(u) * temperature(u)); };
    return {slope(pair.u_i), slope(pair.u_j)};
  }

 private:
  /// The one division that friction and conduction share.
  template <class V>
  static V inverse_product(V theta_i, V theta_j) {
    return 1 / (theta_i * theta_j);
  }
  /// 1 - r/r_c, 0 beyond the range.
  template <class V>
  static V depth(V distance, double range) {
    using std::max;
    return max(1 - distance * (1 / range), V(0));
  }
  template <class V>
  V weight(V distance, double range) const {
    using std::exp;
    using std::log;
    const V x = depth(distance, range);
    if (parameters_.weight_exponent == 2) return x * x;
    // The logarithm of an argument in its domain, whatever lane is beyond the range.
    const V power = exp(parameters_.weight_exponent * log(select(x > 0, x, V(1))));
    return select(x > 0, power, V(0));
  }

  FluidParameters parameters_;
  double inverse_heat_capacity_;
};

}  // namespace driftless
