#pragma once

#include "model/fluid.hpp"
#include "model/state.hpp"

/// What theory says of transport in a fluid without structure (g = 1): pairs see the mean of the
/// fluid. Exact where very many particles interact; without repulsion.
namespace driftless::transport {

/// 8 pi range^3/((s + 1)(s + 2)(s + 3)), the volume integral of w(r) = (1 - r/range)^s.
double weight_volume(double range, double exponent);

/// w_0 = rho zeta_0 [w]/(3 m), at which a particle's velocity forgets [Groot, Warren, J. Chem.
/// Phys. 107, 4423 (1997)].
double collision_rate(const FluidParameters& fluid, double density);

/// w_q = rho L_0 [w]/(phi T^2), at which conduction relaxes a particle's internal energy.
double heat_rate(const FluidParameters& fluid, double density);

/// kT/(m w_0).
double diffusion(const FluidParameters& fluid, double density);

/// c_v = phi + 5k/2 of a particle without repulsion [AM99 4.4], c_p = phi + 7k/2.
double heat_capacity_at_volume(const FluidParameters& fluid);

/// sqrt(c_p/c_v k T/m) [MAN 3.30].
double sound_speed(const FluidParameters& fluid);

/// 2 pi rho^2 zeta_0 r_c^5/1575 [MAN 3.27] and 2 pi rho^2 L_0 r_c^5/(315 T^2) [MAN 3.28], for any
/// exponent of the weight: what friction and conduction transport over their range.
double dissipative_viscosity(const FluidParameters& fluid, double density);
double dissipative_conductivity(const FluidParameters& fluid, double density);

/// The viscosity at a wavenumber, rho m/(k^2 int C dt) of the transverse velocity's normalised
/// autocorrelation C, from the linear Fokker-Planck equation of a particle among the mean of the
/// others (derived). Expanded in Hermite's polynomials of the velocity along k it is a chain whose
/// n-th member decays at (n + 1) w_0, but the first, which gets back what the others lose; so
///   int C dt = 1/(s(k) + k^2 V/(2 w_0 + 2 k^2 V/(3 w_0 + 3 k^2 V/(4 w_0 + ...)))),   V = k T/m,
/// s(k) = (rho/m) int zeta e_y^2 (1 - cos k x) d^3r. Tends to dissipative_viscosity() + rho k T/(2
/// w_0) for small wavenumbers.
double mean_field_viscosity(const FluidParameters& fluid, double density, double wavenumber);

/// The conductivity at a wavenumber in the same way: the n-th member of the chain of u times
/// Hermite's polynomials decays at n w_0 + w_q. Tends to dissipative_conductivity() + rho phi (k
/// T/m)/(w_0 + w_q): a particle carries energy only until it has conducted it away. That of the
/// kinetic energy, a share k/phi of it, is left out.
double mean_field_conductivity(const FluidParameters& fluid, double density, double wavenumber);

}  // namespace driftless::transport
