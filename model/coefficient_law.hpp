#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

#include "model/lanes.hpp"

// Declared here, defined by model/differentiable.hpp, which takes long to compile.
namespace Eigen {
template <class Derivatives>
class AutoDiffScalar;
}

namespace driftless {

/// A coefficient of a pair with its derivatives by the two temperatures.
template <class V>
struct Coefficient {
  V value;
  V by_theta_i, by_theta_j;
};

/// factor * coefficient, where the factor does not depend on the temperatures.
template <class V>
Coefficient<V> operator*(V factor, const Coefficient<V>& coefficient) {
  return {factor * coefficient.value, factor * coefficient.by_theta_i,
          factor * coefficient.by_theta_j};
}

/// A number that carries its derivatives by theta_i and theta_j; who writes a law includes
/// model/differentiable.hpp.
using Differentiable = Eigen::AutoDiffScalar<Eigen::Vector2d>;

/// How a coefficient of friction or conduction follows distance and temperatures: a factor g(r,
/// theta_i, theta_j) > 0 on zeta_0 w(r), lambda_0 w(r) or L_0 w(r), the same when i and j change
/// places. A value; copies share a function.
class CoefficientLaw {
 public:
  /// g at distance r. Lambdas have to name the result's type:
  /// [](double r, const Differentiable& theta_i, const Differentiable& theta_j) -> Differentiable
  using Function = std::function<Differentiable(double distance, const Differentiable& theta_i,
                                                const Differentiable& theta_j)>;

  /// g = 1.
  CoefficientLaw() = default;

  /// g = (theta_i theta_j/temperature^2)^(exponent/2): the power of the pair's (geometric) mean
  /// temperature. Throws std::invalid_argument naming the parameter, its value and the allowed
  /// range.
  static CoefficientLaw power(double exponent, double temperature);

  /// Any g, evaluated for one pair after the other and from any thread. It is tried at distances
  /// below the range and temperatures from a third to four times the given one, and
  /// std::invalid_argument thrown naming the point where it is not finite, not above 0, not
  /// symmetric, or changes with a temperature otherwise than its derivative says.
  static CoefficientLaw any(Function function, double temperature, double range);

  bool is_constant() const { return form_ == Form::constant; }

  /// g with its derivatives; V is double or a vector of lanes.
  template <class V>
  Coefficient<V> factor(V distance, V theta_i, V theta_j) const {
    if (form_ == Form::constant) return {V(1.0), V(0.0), V(0.0)};
    if (form_ == Form::any) return one_by_one(distance, theta_i, theta_j);
    using std::exp;
    using std::log;
    const V g = exp(half_exponent_ * log(theta_i * theta_j * inverse_temperature_squared_));
    return {g, half_exponent_ * g / theta_i, half_exponent_ * g / theta_j};
  }

  /// The same law; functions are the same only as copies.
  bool operator==(const CoefficientLaw&) const = default;

 private:
  enum class Form { constant, power, any };

  Coefficient<double> evaluate(double distance, double theta_i, double theta_j) const;

  /// Not inlined: it would crowd the loops over pairs, whose common case is another form.
  template <class V>
  [[gnu::noinline]] Coefficient<V> one_by_one(V distance, V theta_i, V theta_j) const {
    if constexpr (std::is_same_v<V, double>) {
      return evaluate(distance, theta_i, theta_j);
    } else {
      double r[V::count()], i[V::count()], j[V::count()];
      distance.store(r);
      theta_i.store(i);
      theta_j.store(j);
      for (std::size_t n = 0; n < V::count(); ++n) {
        const auto g = evaluate(r[n], i[n], j[n]);
        r[n] = g.value;
        i[n] = g.by_theta_i;
        j[n] = g.by_theta_j;
      }
      return {V::load(r), V::load(i), V::load(j)};
    }
  }

  Form form_ = Form::constant;
  double half_exponent_ = 0, inverse_temperature_squared_ = 1;
  std::shared_ptr<const Function> function_;
};

}  // namespace driftless
