#pragma once

#include "experiments/flux/periodic_fluid.hpp"

namespace driftless::flux {

/// Transport coefficients that sums over pairs give, with the fluid's own g(r): the integrals of
/// theory, of which (rho/2) int f g 4 pi r^2 dr is the sum of f over pairs, per particle. All at
/// one temperature.
struct PairSums {
  double collision_rate = 0;  ///< w_0 = (rho/3m) int zeta g 4 pi r^2 dr
  double heat_rate = 0;       ///< rho int lambda g 4 pi r^2 dr / phi, at which a particle's
                              ///< temperature follows that of its neighbours
  double conductivity = 0;    ///< (2 pi rho^2/3) int lambda g r^4 dr, any heat form
  double viscosity = 0;       ///< (2 pi rho^2/15) int zeta g r^4 dr
};
/// Of the present positions, in the temperature given.
PairSums pair_sums(System& system, double temperature);
/// The same without structure, g = 1, for any weight exponent.
PairSums without_structure(const FluidParameters& fluid, double density, double temperature);

/// Conductivity of a fluid whose particles lose their velocity at the rate w_0 (derived): the
/// pairs' conduction, internal energy that diffuses, and kinetic energy. A particle's internal
/// energy is that of the temperature where it was, T(t) = int_0^infinity w_q exp(-w_q s) T(z(t -
/// s)) ds, so that it carries rho phi D_u with D_u = int_0^infinity <v(0) v(t)> exp(-w_q t) dt,
/// which is k T/(m (w_0 + w_q)) for an exponential; kinetic energy gives 5 rho k^2 T/(2 m 3 w_0).
struct Conductivity {
  double conduction = 0, internal = 0, kinetic = 0;
  double total() const { return conduction + internal + kinetic; }
};
Conductivity predicted_conductivity(const FluidParameters& fluid, double density,
                                    double temperature, const PairSums& sums);

/// A run in equilibrium that measures
///   "vacf": {"time", "value"}, the velocities' autocorrelation over its value at 0, components
///       averaged; its error at the first time of 1/e is that of "time_to_e";
///   "collision_time": its integral; "time_to_e": where it has fallen to 1/e;
///   "diffusion": the integral of the autocorrelation itself; "heat_diffusion": D_u, above;
///   "temperature": the kinetic one; "internal_temperature"; and the means of pair_sums():
///       "collision_rate", "heat_rate", "conduction", "pair_viscosity".
/// Errors of the first four are from `blocks` parts of the run, which should be longer than the
/// autocorrelation; those of the others count it. Throws StepFailure.
nlohmann::json run_in_equilibrium(const PeriodicFluid& fluid, double duration,
                                  std::size_t blocks = 12);

/// Viscosity from the decay of a shear wave, the longest along z, of velocities along x and y at a
/// quarter of a wave from each other and of amplitude `amplitude` sqrt(kT/m); each replica starts
/// from equilibrium. An estimate, from the scatter of replicas: "viscosity".
nlohmann::json run_shear_decay(const PeriodicFluid& fluid, double amplitude, std::size_t replicas,
                               double expected_viscosity);

}  // namespace driftless::flux
