#include "model/fluid.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace driftless {
namespace {

void require(bool allowed, const char* name, double value, const char* range) {
  if (allowed && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " is " << value << ", allowed is " << range;
  throw std::invalid_argument(message.str());
}

/// At the one temperature that there is the two closures are the same; with `noise` nothing is
/// noise-induced.
FluidParameters with_bath(FluidParameters parameters) {
  if (!parameters.isothermal) return parameters;
  parameters.friction_closure = FrictionClosure::noise;
  parameters.heat_capacity = 1;
  return parameters;
}

}  // namespace

Fluid::Fluid(const FluidParameters& parameters)
    : parameters_(with_bath(parameters)), inverse_heat_capacity_(1 / parameters_.heat_capacity) {
  const auto& f = parameters_;
  require(f.boltzmann >= 0, "boltzmann", f.boltzmann, ">= 0");
  require(f.mass > 0, "mass", f.mass, "> 0");
  require(f.temperature > 0, "temperature", f.temperature, "> 0");
  require(f.heat_capacity > 0, "heat_capacity", f.heat_capacity, "> 0");
  require(f.repulsion >= 0, "repulsion", f.repulsion, ">= 0");
  require(f.repulsion_range > 0, "repulsion_range", f.repulsion_range, "> 0");
  require(f.friction >= 0, "friction", f.friction, ">= 0");
  require(f.friction_range > 0, "friction_range", f.friction_range, "> 0");
  require(f.conduction >= 0, "conduction", f.conduction, ">= 0");
  require(f.heat_range > 0, "heat_range", f.heat_range, "> 0");
  require(!f.isothermal || !f.has_conduction(), "conduction", f.conduction,
          "0 in an isothermal fluid, whose particles have no heat to exchange");
  require(f.weight_exponent > 0, "weight_exponent", f.weight_exponent, "> 0");
}

double Fluid::range() const {
  double range = 0;
  if (has_repulsion()) range = std::max(range, parameters_.repulsion_range);
  if (has_friction()) range = std::max(range, parameters_.friction_range);
  if (has_conduction()) range = std::max(range, parameters_.heat_range);
  return range;
}

double Fluid::potential_laplacian(double distance) const {
  const double range = parameters_.repulsion_range;
  if (distance >= range) return 0;
  return parameters_.repulsion / range - 2 * repulsive_force(distance) / distance;
}

}  // namespace driftless
