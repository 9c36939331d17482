#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/initial.hpp"
#include "model/system.hpp"

/// Where the stability of methods is looked at: one fluid, and what is varied of it.
namespace driftless::judge {

/// A fluid in units k = m = T = 1, all ranges 1. The conduction is of the form
/// `inverse-temperature`.
struct StabilityPoint {
  double heat_capacity = 60;     ///< phi/k
  double friction = 4.5;         ///< zeta_0
  double conduction = 1;         ///< rate L_0/(phi T^2): in the units of [MAN] their C
  double density = 3;            ///< number density
  double repulsion = 0;          ///< a of the soft potential, in k T per range
  double temperature_ratio = 1;  ///< of the box's halves at the start, 1 on average

  bool operator==(const StabilityPoint&) const = default;
};

/// A quantity that is varied about the base, `StabilityPoint{}`.
struct StabilityAxis {
  std::string_view name;   ///< "density"
  std::string_view title;  ///< "number density"
  double StabilityPoint::*coordinate;
  std::vector<double> quick, full;  ///< the base's own value is among them
};

/// Heat capacity, friction, conduction, density, repulsion, initial temperature ratio.
const std::vector<StabilityAxis>& stability_axes();

FluidParameters stability_fluid(const StabilityPoint& point, FrictionClosure closure);

/// Time between collisions 3 m/(rho zeta_0 [w]) [Groot, Warren 1997], [w] = 2 pi/15.
double collision_time(const StabilityPoint& point);

/// A system at its start, for how long it is run, and the exact law's mean energies.
struct StabilityStart {
  System system;
  double duration;
  double kinetic_energy, internal_energy;
};

/// 125 particles from the exact law at the temperature 1, with a repulsion from a hybrid Monte
/// Carlo chain. For a temperature ratio, velocities and internal energies of the particles in the
/// half x < L/2 are then scaled to the higher temperature, the others to the lower one.
StabilityStart stability_start(const StabilityPoint& point, FrictionClosure closure,
                               std::uint64_t seed, unsigned replica);

/// The steps that must not be reached lest internal energies become negative, as estimated by
/// Mackie, Bonet Avalos and Navas (1999) from what n = (4 pi/3) r_c^3 rho neighbours send a
/// particle in a step: conduction, C n r_c |grad T| dt = 1 (eq. 3.33), nothing without a gradient;
/// and its noise, sqrt(B C dt) n = 1 (eq. 3.34), B = k/phi.
struct PositivityEstimates {
  std::optional<double> conduction, noise;
};
PositivityEstimates positivity_estimates(const StabilityPoint& point);

}  // namespace driftless::judge
