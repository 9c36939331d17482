#include "model/pair_law.hpp"

#include <limits>

namespace driftless {
namespace {

/// The factor of a coefficient that follows temperatures: given, or else the power.
CoefficientLaw factor_of(const CoefficientLaw& law, double exponent, double temperature) {
  return law.is_constant() ? CoefficientLaw::power(exponent, temperature) : law;
}

double reduced(double m_i, double m_j) {
  if (m_i == m_j) return m_i / 2;
  return std::isinf(m_j) ? m_i : m_i * m_j / (m_i + m_j);
}

}  // namespace

PairLaw::PairLaw(const FluidParameters& fluid, const PairCoefficients& coefficients,
                 const Partner& i, const Partner& j)
    : coefficients_(coefficients),
      i_(i),
      j_(j),
      boltzmann_(fluid.boltzmann),
      temperature_(fluid.temperature),
      weight_exponent_(fluid.weight_exponent),
      reduced_mass_(reduced(i.mass, j.mass)),
      share_i_(std::isinf(j.mass) ? 1 : 0.5),
      closure_(fluid.friction_closure),
      heat_form_(fluid.heat_form),
      friction_factor_(
          factor_of(fluid.friction_law, fluid.friction_temperature_exponent, fluid.temperature)),
      conduction_factor_(factor_of(fluid.conduction_law, fluid.conduction_temperature_exponent,
                                   fluid.temperature)) {}

PairLaw PairLaw::uniform_field(const FluidParameters& fluid, double force, const Partner& i) {
  const Partner earth{std::numeric_limits<double>::infinity(), i.state};
  PairLaw law(fluid, {.repulsion = force}, i, earth);
  law.uniform_ = true;
  return law;
}

double PairLaw::range() const {
  double range = 0;
  if (uniform_) return range;
  if (has_repulsion()) range = std::max(range, coefficients_.repulsion_range);
  if (has_friction()) range = std::max(range, coefficients_.friction_range);
  if (has_conduction()) range = std::max(range, coefficients_.heat_range);
  return range;
}

double PairLaw::potential_curvature(double distance) const {
  const double range = coefficients_.repulsion_range;
  return uniform_ || distance >= range ? 0 : coefficients_.repulsion / range;
}

double PairLaw::potential_laplacian(double distance, double thermal) const {
  const double range = coefficients_.repulsion_range;
  if (distance >= range) return 0;
  const double of_distance =
      potential_curvature(distance) - 2 * repulsive_force(distance) / distance;
  if (thermal == 0) return of_distance;
  return of_distance + thermal * (1 / range - 2 * thermal_shape_force(distance) / distance);
}

}  // namespace driftless
