#include "integrators/methods.hpp"
#include "integrators/predicted_verlet.hpp"

namespace driftless {

/// Plain velocity Verlet with all forces and heats in it, as LAMMPS runs energy-conserving DPD
/// without splitting (DPDE-VV) [Larentzos et al., Comput. Phys. Commun. 185, 1987 (2014)]: forces,
/// noise included, are computed once a step, after the move, from the velocities and internal
/// energies that are half a step on, and serve two half steps: the scheme of predicted_verlet.hpp
/// at lambda = 1/2. Conserves momentum; energy in the mean only, to O(dt).
const Method velocity_verlet_dpde = {
    .name = "velocity-verlet",
    .title = "Velocity Verlet with all forces (DPDE-VV)",
    .reference = "Larentzos et al., Comput. Phys. Commun. 185, 1987 (2014); LAMMPS, DPD-REACT",
    .conserves = "momentum; energy in the mean, to first order",
    .isothermal = true,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<PredictedVerlet>(0.5);
    }};

}  // namespace driftless
