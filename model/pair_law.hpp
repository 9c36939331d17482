#pragma once

#include <algorithm>
#include <cmath>

#include "model/equation_of_state.hpp"
#include "model/exchange_laws.hpp"
#include "model/fluid_parameters.hpp"
#include "model/pair.hpp"

namespace driftless {

/// One of the two of a pair: a particle, or what stands for a wall.
struct Partner {
  double mass = 1;  ///< infinite for a wall
  EquationOfState state = EquationOfState::constant_heat_capacity(1);
};

/// How strongly the two of a pair act on each other, and how far.
struct PairCoefficients {
  double repulsion = 0, repulsion_range = 1;
  double friction = 0, friction_range = 1;
  double conduction = 0, heat_range = 1;
  double thermal_repulsion = 0;
};

/// The constitutive laws of one kind of pair - two species, or a species and a wall -: what such a
/// pair exchanges per unit time, as functions of what it sees. Every function is pure and generic
/// in V (double or a vector of lanes).
class PairLaw {
 public:
  PairLaw(const FluidParameters& fluid, const PairCoefficients& coefficients, const Partner& i,
          const Partner& j);
  /// A field that pulls every particle of the species with the same force, measured along an axis;
  /// r is the coordinate.
  static PairLaw uniform_field(const FluidParameters& fluid, double force, const Partner& i);

  bool has_repulsion() const {
    return uniform_ || coefficients_.repulsion != 0 || coefficients_.thermal_repulsion != 0;
  }
  bool has_friction() const { return coefficients_.friction != 0; }
  bool has_conduction() const {
    return heat_form_ != HeatForm::none && coefficients_.conduction != 0;
  }
  /// Whether both heat capacities are constant, no coefficient has a factor and it is not a field.
  bool is_common() const {
    return i_.state.has_constant_heat_capacity() && j_.state.has_constant_heat_capacity() &&
           friction_factor_.is_constant() && conduction_factor_.is_constant() && !uniform_;
  }
  /// The largest range of the terms that act; 0 if none does or it is a field.
  double range() const;
  double reduced_mass() const { return reduced_mass_; }
  double inverse_mass_i() const { return 1 / i_.mass; }
  double inverse_mass_j() const { return 1 / j_.mass; }
  /// Whose potential energy it is: half of each particle's, all the particle's at a wall.
  double potential_share_i() const { return share_i_; }
  double potential_share_j() const { return 1 - share_i_; }

  template <class V>
  V temperature_i(const Pair<V>& pair) const {
    return i_.state.temperature(pair.u_i);
  }
  template <class V>
  V temperature_j(const Pair<V>& pair) const {
    return j_.state.temperature(pair.u_j);
  }
  /// 1/c_i + 1/c_j, c = du/dtheta.
  template <class V>
  V inverse_heat_capacities(const Pair<V>& pair) const {
    return i_.state.inverse_heat_capacity(pair.u_i) + j_.state.inverse_heat_capacity(pair.u_j);
  }
  /// s(u + gain) - s(u) of each, to rounding however small the gain; energies must be above 0.
  template <class V>
  V entropy_gain_i(const Pair<V>& pair, V gain) const {
    return i_.state.entropy_gain(pair.u_i, gain);
  }
  template <class V>
  V entropy_gain_j(const Pair<V>& pair, V gain) const {
    return j_.state.entropy_gain(pair.u_j, gain);
  }

  template <class V>
  V friction_weight(V distance) const {
    return weight(distance, coefficients_.friction_range);
  }
  template <class V>
  V heat_weight(V distance) const {
    return weight(distance, coefficients_.heat_range);
  }

  /// Repulsive force on i along e at distance r: a (1 - r/r_c) inside the range. What of it follows
  /// the temperatures is not in it, nor in the potential: see thermal_shape().
  template <class V>
  V repulsive_force(V distance) const {
    if (!meets_common_laws<V> && uniform_) return V(coefficients_.repulsion);
    return coefficients_.repulsion * depth(distance, coefficients_.repulsion_range);
  }
  /// psi(r) = (a r_c/2)(1 - r/r_c)^2 inside the range.
  template <class V>
  V potential(V distance) const {
    if (!meets_common_laws<V> && uniform_) return -coefficients_.repulsion * distance;
    const V x = depth(distance, coefficients_.repulsion_range);
    return 0.5 * coefficients_.repulsion * coefficients_.repulsion_range * x * x;
  }
  /// Potential (r_c/2)(1 - r/r_c)^2 and force 1 - r/r_c of a repulsion of strength 1.
  template <class V>
  V thermal_shape(V distance) const {
    const V x = depth(distance, coefficients_.repulsion_range);
    return 0.5 * coefficients_.repulsion_range * x * x;
  }
  template <class V>
  V thermal_shape_force(V distance) const {
    return depth(distance, coefficients_.repulsion_range);
  }
  /// psi''(r) + 2 psi'(r)/r, the Laplacian of psi with respect to one particle's position; with
  /// `thermal` the strength of what follows the temperatures.
  double potential_laplacian(double distance, double thermal = 0) const;
  /// psi''(r).
  double potential_curvature(double distance) const;

  /// Theta of two temperatures, 1/Theta = (1/theta_i + 1/theta_j)/2 (Mackie et al. 2.37).
  template <class V>
  V mean_temperature(const Pair<V>& pair) const {
    return mean_of(temperature_i(pair), temperature_j(pair));
  }

  /// Whether Gamma, or Lambda, depends on the internal energies: then there is a noise-induced
  /// friction, or heat rate.
  bool friction_noise_follows_energies() const {
    return has_friction() &&
           (closure_ == FrictionClosure::friction || !friction_factor_.is_constant());
  }
  bool heat_noise_follows_energies() const {
    return has_conduction() &&
           (heat_form_ == HeatForm::temperature || !conduction_factor_.is_constant());
  }

  /// The friction law of a pair in its present state; but for the factor of the temperatures zeta
  /// is constant in the energies for the closure `friction`, Gamma for the closure `noise`.
  template <class V>
  FrictionLaw<V> friction(const Pair<V>& pair) const {
    if (has_factor<V>(friction_factor_)) {
      return factored_friction(pair.r, pair.w_friction, pair.u_i, pair.u_j);
    }
    const V theta_i = temperature_i(pair), theta_j = temperature_j(pair);
    const V zeta_0 = coefficients_.friction * pair.w_friction;
    if (closure_ == FrictionClosure::noise) {
      const V inverse_mean = 0.5 * (theta_i + theta_j) * inverse_product(theta_i, theta_j);
      return {zeta_0 * temperature_ * inverse_mean, 2 * boltzmann_ * zeta_0 * temperature_, V(0)};
    }
    const V mean = mean_of(theta_i, theta_j);
    const V slope = mean * mean *
                    (i_.state.inverse_heat_capacity(pair.u_i) / (theta_i * theta_i) +
                     j_.state.inverse_heat_capacity(pair.u_j) / (theta_j * theta_j));
    return {zeta_0, 2 * boltzmann_ * zeta_0 * mean, 0.25 * boltzmann_ * zeta_0 * slope};
  }

  /// d ln Gamma/du of either. The noise-induced friction is Gamma^2/2 times their sum.
  template <class V>
  AmplitudeSlopes<V> friction_noise_slopes(const Pair<V>& pair) const {
    if (has_factor<V>(friction_factor_)) return factored_slopes(pair.r, pair.u_i, pair.u_j);
    if (closure_ == FrictionClosure::noise) return {V(0), V(0)};
    const V mean = mean_temperature(pair);
    const auto slope = [&](const EquationOfState& state, V u) {
      const V theta = state.temperature(u);
      return 0.25 * mean * state.inverse_heat_capacity(u) / (theta * theta);
    };
    return {slope(i_.state, pair.u_i), slope(j_.state, pair.u_j)};
  }

  /// The conduction law of a pair in its present state.
  template <class V>
  ConductionLaw<V> conduction(const Pair<V>& pair) const {
    if (has_factor<V>(conduction_factor_)) {
      return factored_conduction(pair.r, pair.w_heat, pair.u_i, pair.u_j);
    }
    const V theta_i = temperature_i(pair), theta_j = temperature_j(pair);
    const V coefficient = coefficients_.conduction * pair.w_heat;
    if (heat_form_ == HeatForm::inverse_temperature) {
      return {coefficient * (theta_j - theta_i) * inverse_product(theta_i, theta_j),
              2 * boltzmann_ * coefficient, V(0)};
    }
    return {coefficient * (theta_j - theta_i), 2 * boltzmann_ * coefficient * theta_i * theta_j,
            boltzmann_ * coefficient *
                (theta_j * i_.state.inverse_heat_capacity(pair.u_i) -
                 theta_i * j_.state.inverse_heat_capacity(pair.u_j))};
  }

  /// lambda of a pair in its present state.
  template <class V>
  V conductivity(const Pair<V>& pair) const {
    V coefficient = coefficients_.conduction * pair.w_heat;
    if (has_factor<V>(conduction_factor_)) coefficient *= factor(pair.r, pair.u_i, pair.u_j);
    if (heat_form_ != HeatForm::inverse_temperature) return coefficient;
    return coefficient / (temperature_i(pair) * temperature_j(pair));
  }

  /// d ln Lambda/du of either. The noise-induced heat rate is Lambda^2 times their difference.
  template <class V>
  AmplitudeSlopes<V> heat_noise_slopes(const Pair<V>& pair) const {
    if (has_factor<V>(conduction_factor_)) return factored_heat_slopes(pair.r, pair.u_i, pair.u_j);
    if (heat_form_ != HeatForm::temperature) return {V(0), V(0)};
    const auto slope = [&](const EquationOfState& state, V u) {
      return 0.5 * state.inverse_heat_capacity(u) / state.temperature(u);
    };
    return {slope(i_.state, pair.u_i), slope(j_.state, pair.u_j)};
  }

 private:
  template <class V>
  static bool has_factor(const CoefficientLaw& law) {
    return !meets_common_laws<V> && !law.is_constant();
  }
  template <class V>
  PairTemperatures<V> temperatures(V u_i, V u_j) const {
    return {i_.state.temperature(u_i), j_.state.temperature(u_j),
            i_.state.inverse_heat_capacity(u_i), j_.state.inverse_heat_capacity(u_j)};
  }
  /// A of Gamma^2 = 2 k A, given zeta_0 w.
  template <class V>
  Coefficient<V> friction_noise_intensity(V zeta, V distance, const PairTemperatures<V>& at) const {
    const auto g = friction_factor_.factor(distance, at.theta_i, at.theta_j);
    if (closure_ == FrictionClosure::noise) return (zeta * temperature_) * g;
    return friction_intensity(zeta * g, at);
  }
  /// A of Lambda^2 = 2 k A, given L_0 w or lambda_0 w.
  template <class V>
  Coefficient<V> heat_noise_intensity(V coefficient, V distance,
                                      const PairTemperatures<V>& at) const {
    const auto g = conduction_factor_.factor(distance, at.theta_i, at.theta_j);
    if (heat_form_ == HeatForm::inverse_temperature) return coefficient * g;
    return heat_intensity(coefficient * g, at);
  }
  // Not inlined, and values alone: they would crowd the loops over pairs, whose common case has no
  // factor, and keep pairs in memory instead of registers.
  template <class V>
  [[gnu::noinline, gnu::cold]] FrictionLaw<V> factored_friction(V distance, V weight, V u_i,
                                                                V u_j) const {
    const auto at = temperatures(u_i, u_j);
    const V zeta = coefficients_.friction * weight;
    return friction_law(boltzmann_, friction_noise_intensity(zeta, distance, at), at);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] ConductionLaw<V> factored_conduction(V distance, V weight, V u_i,
                                                                    V u_j) const {
    const auto at = temperatures(u_i, u_j);
    const V coefficient = coefficients_.conduction * weight;
    return conduction_law(boltzmann_, heat_noise_intensity(coefficient, distance, at), at);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] AmplitudeSlopes<V> factored_slopes(V distance, V u_i, V u_j) const {
    const auto at = temperatures(u_i, u_j);
    return amplitude_slopes(friction_noise_intensity(V(1.0), distance, at), at);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] AmplitudeSlopes<V> factored_heat_slopes(V distance, V u_i,
                                                                       V u_j) const {
    const auto at = temperatures(u_i, u_j);
    return amplitude_slopes(heat_noise_intensity(V(1.0), distance, at), at);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] V factor(V distance, V u_i, V u_j) const {
    const auto at = temperatures(u_i, u_j);
    return conduction_factor_.factor(distance, at.theta_i, at.theta_j).value;
  }
  template <class V>
  static V mean_of(V theta_i, V theta_j) {
    return 2 * theta_i * theta_j / (theta_i + theta_j);
  }
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
    if (weight_exponent_ == 2) return x * x;
    // The logarithm of an argument in its domain, whatever lane is beyond the range.
    const V power = exp(weight_exponent_ * log(select(x > 0, x, V(1))));
    return select(x > 0, power, V(0));
  }

  PairCoefficients coefficients_;
  Partner i_, j_;
  double boltzmann_, temperature_, weight_exponent_, reduced_mass_, share_i_;
  FrictionClosure closure_;
  HeatForm heat_form_;
  CoefficientLaw friction_factor_, conduction_factor_;
  bool uniform_ = false;
};

}  // namespace driftless
