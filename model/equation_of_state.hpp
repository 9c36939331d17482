#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "model/lanes.hpp"

namespace driftless {

/// log(1 + x)/x to rounding, however small x.
template <class V>
V log_one_plus_over(V x) {
  using std::abs;
  using std::log;
  // log(1 + x) = x log(y)/(y - 1) with y = 1 + x as rounded (Kahan).
  const V y = 1 + x, away = y - 1;
  const auto seen = abs(away) > 0;
  return select(seen, log(y) / select(seen, away, V(1)), V(1));
}

/// A stretch of energies along which the heat capacity c = du/dtheta changes linearly with the
/// temperature: with x = theta - theta_0 and w = u - u_0,
///   c = c_0 + b x,  w = c_0 x + b x^2/2,  hence c^2 = c_0^2 + 2 b w and w = x (c_0 + c)/2,
///   s = a ln theta + b theta,  a = c_0 - b theta_0.
/// Every function is generic in V (double or a vector of lanes).
struct LinearHeatCapacity {
  double u = 0, theta = 0;  ///< u_0 and theta_0
  double capacity = 1;      ///< c_0
  double slope = 0;         ///< b

  template <class V>
  V heat_capacity(V internal_energy) const {
    using std::max;
    using std::sqrt;
    return sqrt(max(capacity * capacity + 2 * slope * (internal_energy - u), V(0)));
  }
  template <class V>
  V temperature(V internal_energy) const {
    return theta + 2 * (internal_energy - u) / (capacity + heat_capacity(internal_energy));
  }
  template <class V>
  V entropy(V internal_energy) const {
    using std::log;
    const V theta_of_u = temperature(internal_energy);
    return logarithmic() * log(theta_of_u) + slope * theta_of_u;
  }
  template <class V>
  V entropy_gain(V internal_energy, V gain) const {
    const V before = heat_capacity(internal_energy), after = heat_capacity(internal_energy + gain);
    const V theta_of_u = temperature(internal_energy);
    const V x = 2 * gain / ((before + after) * theta_of_u);  // (theta' - theta)/theta
    return x * (logarithmic() * log_one_plus_over(x) + slope * theta_of_u);
  }
  double internal_energy(double temperature) const {
    const double x = temperature - theta;
    return u + x * (capacity + 0.5 * slope * x);
  }
  double logarithmic() const { return capacity - slope * theta; }  ///< a
  bool operator==(const LinearHeatCapacity&) const = default;
};

/// Temperature and internal energy of one particle.
struct StatePoint {
  double temperature;
  double internal_energy;
  bool operator==(const StatePoint&) const = default;
};

/// The entropy s(u) of one particle and what follows from it: the temperature theta = (ds/du)^-1
/// and the heat capacity c = du/dtheta. s is increasing and concave: theta > 0 rises with u.
/// A value; the functions are pure, and those that take V are generic in it (double or a vector of
/// lanes). They are meant for u > 0; at u <= 0 a temperature is not above 0.
class EquationOfState {
 public:
  /// s = ln u.
  EquationOfState() = default;

  /// s = phi ln u, u = phi theta (Mackie, Bonet Avalos and Navas 1999, eq. 3.18). Throws
  /// std::invalid_argument, as all makers do, naming what is refused, its value and what is
  /// allowed.
  static EquationOfState constant_heat_capacity(double heat_capacity);

  /// A heat capacity that rises with the temperature, c = heat_capacity + slope (theta -
  /// temperature), hence u = c(0) theta + slope theta^2/2 and s = c(0) ln theta + slope theta. It
  /// has to be above 0 at all temperatures: slope >= 0 and c(0) > 0.
  static EquationOfState linear_heat_capacity(double heat_capacity, double slope,
                                              double temperature);

  /// A body of infinite heat capacity: theta = temperature and s = u/temperature whatever u.
  static EquationOfState reservoir(double temperature);

  /// Through two points or more, of increasing temperatures and internal energies above 0. Between
  /// them c is continuous, above 0 and piecewise linear in theta, with a bend at each point and
  /// half-way between two [Schumaker, SIAM J. Numer. Anal. 20, 853 (1983)], so that points of a
  /// constant or linear heat capacity are interpolated without error; s is the integral of
  /// du/theta along it. Below the first point (theta_1, u_1) c is u_1/theta_1, so that u and theta
  /// reach 0 together; above the last one c stays as it is there. Refusals name the point by its
  /// number, from 1, and its values.
  static EquationOfState table(const std::vector<StatePoint>& points);

  bool has_constant_heat_capacity() const { return form_ == Form::constant; }
  bool is_reservoir() const { return form_ == Form::reservoir; }

  /// theta(u).
  template <class V>
  V temperature(V internal_energy) const {
    if (meets_common_laws<V> || form_ == Form::constant) [[likely]]
      return internal_energy * inverse_heat_capacity_;
    return other_temperature(internal_energy);
  }

  /// 1/c(u) = dtheta/du; 0 for a reservoir.
  template <class V>
  V inverse_heat_capacity(V internal_energy) const {
    if (meets_common_laws<V> || form_ == Form::constant) [[likely]]
      return V(inverse_heat_capacity_);
    return other_inverse_heat_capacity(internal_energy);
  }

  /// s(u), up to a constant.
  template <class V>
  V entropy(V internal_energy) const {
    using std::log;
    if (meets_common_laws<V> || form_ == Form::constant) [[likely]]
      return heat_capacity_ * log(internal_energy);
    return other_entropy(internal_energy);
  }

  /// s(u + gain) - s(u), to rounding however small the gain; both energies must be above 0.
  template <class V>
  V entropy_gain(V internal_energy, V gain) const {
    if (meets_common_laws<V> || form_ == Form::constant) [[likely]] {
      const V x = gain / internal_energy;
      return heat_capacity_ * x * log_one_plus_over(x);
    }
    return other_entropy_gain(internal_energy, gain);
  }

  /// u(theta), the inverse of temperature(). A reservoir's energy has no origin: any number above 0
  /// would do, and its temperature is returned.
  double internal_energy(double temperature) const;

  bool operator==(const EquationOfState&) const = default;

 private:
  enum class Form { constant, linear, reservoir, table };

  // The other forms. Not inlined: they would crowd the loops over pairs, whose common case is a
  // constant heat capacity.
  template <class V>
  [[gnu::noinline, gnu::cold]] V other_temperature(V internal_energy) const {
    if (form_ == Form::reservoir) return V(temperature_);
    if (form_ == Form::linear) return linear_.temperature(internal_energy);
    return one_by_one([this](double u, double) { return pieces_[place_of(u)].temperature(u); },
                      internal_energy);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] V other_inverse_heat_capacity(V internal_energy) const {
    if (form_ == Form::reservoir) return V(0.0);
    if (form_ == Form::linear) return 1 / linear_.heat_capacity(internal_energy);
    return one_by_one(
        [this](double u, double) { return 1 / pieces_[place_of(u)].heat_capacity(u); },
        internal_energy);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] V other_entropy(V internal_energy) const {
    if (form_ == Form::reservoir) return internal_energy * inverse_temperature_;
    if (form_ == Form::linear) return linear_.entropy(internal_energy);
    return one_by_one([this](double u, double) { return table_entropy(u); }, internal_energy);
  }
  template <class V>
  [[gnu::noinline, gnu::cold]] V other_entropy_gain(V internal_energy, V gain) const {
    if (form_ == Form::reservoir) return gain * inverse_temperature_;
    if (form_ == Form::linear) return linear_.entropy_gain(internal_energy, gain);
    return one_by_one([this](double u, double more) { return table_entropy_gain(u, more); },
                      internal_energy, gain);
  }

  /// f(u, gain) of every lane.
  template <class V, class Function>
  static V one_by_one(const Function& f, V u, V gain = V(0.0)) {
    if constexpr (std::is_same_v<V, double>) {
      return f(u, gain);
    } else {
      double energies[V::count()], gains[V::count()];
      u.store(energies);
      gain.store(gains);
      for (std::size_t n = 0; n < V::count(); ++n) energies[n] = f(energies[n], gains[n]);
      return V::load(energies);
    }
  }
  /// The place in pieces_ of the piece that holds an energy.
  std::size_t place_of(double internal_energy) const;
  double table_entropy(double internal_energy) const;
  double table_entropy_gain(double internal_energy, double gain) const;

  Form form_ = Form::constant;
  double heat_capacity_ = 1, inverse_heat_capacity_ = 1;
  double temperature_ = 1, inverse_temperature_ = 1;  ///< of a reservoir
  LinearHeatCapacity linear_;
  std::vector<LinearHeatCapacity> pieces_;  ///< of a table; all but the first begin at their u_0
  std::vector<double> entropies_;  ///< s(u_0) of the pieces; not of the first, where u_0 = 0
};

}  // namespace driftless
