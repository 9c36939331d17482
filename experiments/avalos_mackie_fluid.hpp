#pragma once

#include <cmath>

#include "model/fluid.hpp"

/// The fluid of Bonet Avalos and Mackie, J. Chem. Phys. 111, 5267 (1999), in their units: m =
/// zeta_0 = T_R = 1 and k = 1/2 make lengths, times and momenta theirs.
namespace driftless::am99 {

/// B = k/phi; the paper's own is not known to us, and only shares of k/phi depend on it.
inline constexpr double heat_ratio = 0.01;

/// The ranges that have 8 and 100 particles of density 1 within them.
inline constexpr double few = 1.24, many = 2.88;

inline FluidParameters fluid(double range, double conduction) {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.heat_capacity = f.boltzmann / heat_ratio;
  f.friction = 1;
  f.friction_closure = FrictionClosure::friction;
  f.friction_range = f.heat_range = range;
  f.conduction = conduction * f.heat_capacity;
  f.heat_form = conduction > 0 ? HeatForm::inverse_temperature : HeatForm::none;
  return f;
}

}  // namespace driftless::am99
