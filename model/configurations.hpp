#pragma once

#include <cstdint>

#include "model/noise.hpp"
#include "model/system.hpp"

namespace driftless {

/// Samples the positions of a fluid with a potential by hybrid Monte Carlo [Duane et al., Phys.
/// Lett. B 195, 216 (1987)]: short velocity-Verlet paths from fresh momenta, accepted or refused so
/// that the law of positions is exact whatever the length of a path's stride. No thermostat and no
/// integrator under test is involved, so its averages are references for all of them. Where the
/// repulsion follows the temperatures, both laws below have the factor prod chi_i^-(phi_i/k + 1)
/// that remains of the internal energies (FluidParameters::thermal_repulsion), Psi is the potential
/// without that part, and paths follow the force of the mean energies.
class ConfigurationChain {
 public:
  /// Starts from positions in `state`; the numbers drawn follow `noise` alone.
  ConfigurationChain(const Fluid& fluid, const Box& box, State state, const Noise& noise);

  /// One path accepted whatever it does: away from a start (a lattice) so unlike the fluid that the
  /// strides' error would refuse every path out of it. Belongs before the paths that count.
  void relax();
  /// One path towards the canonical law exp(-Psi/kT) at the fluid's temperature.
  void advance_canonical();
  /// One path towards the microcanonical law (E - Psi)^(A-1): what remains of the Dirichlet law of
  /// kinetic and internal energies, of total shape A, when these are integrated out.
  void advance_microcanonical(double energy, double total_shape);

  /// The system at the present configuration, with auxiliary velocities and no internal energies.
  System& system() { return system_; }
  /// Share of the paths accepted so far.
  double acceptance() const { return static_cast<double>(accepted_) / static_cast<double>(paths_); }

 private:
  /// `log_weight` of a potential energy, up to a constant.
  template <class LogWeight>
  void advance(LogWeight&& log_weight);
  void kick(double duration);
  /// -sum of (phi_i/k + 1) ln chi_i.
  double log_of_factors();

  System system_;
  Noise noise_;
  std::uint64_t paths_ = 0, accepted_ = 0;
};

/// Sums over pairs, and over walls and a field, that belong to a configuration.
struct ConfigurationSums {
  double potential = 0;      ///< Psi, without what follows the temperatures
  double virial = 0;         ///< sum over pairs of r F, walls left out
  double squared_force = 0;  ///< sum over particles of |F_i|^2
  /// Sum over particles of the Laplacian of Psi at r_i, with what follows the temperatures: at
  /// constant u, as the force is.
  double laplacian = 0;
};
ConfigurationSums configuration_sums(System& system);

}  // namespace driftless
