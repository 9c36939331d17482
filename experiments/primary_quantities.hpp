#pragma once

namespace driftless::Primary {

/// Columns of Record::samples: averages over islands or particles at one time.
enum Quantity : int {
  kinetic,              ///< kinetic energy of an island
  kinetic_share,        ///< kinetic over kinetic plus internal energy of an island
  inverse_temperature,  ///< 1/theta
  energy_1,             ///< u - u_0, u_0 the exact mean where known, else 0
  energy_2,             ///< (u - u_0)^2
  energy_3,             ///< (u - u_0)^3
  potential,            ///< potential energy per particle
  virial,               ///< sum over pairs of r F
  squared_force,        ///< |grad_i Psi|^2
  laplacian,            ///< lap_i Psi
  count
};

}  // namespace driftless::Primary
