#pragma once

#include "model/fluid.hpp"
#include "model/state.hpp"

namespace driftless {

/// Largest local error of the reference, relative and absolute, per component of the state.
struct ReferenceTolerance {
  double relative = 1e-13;
  double absolute = 1e-15;
  /// Longest step as a share of the duration. The equations have kinks where pairs come into range;
  /// one between two evaluations goes unseen.
  double longest_step = 0.002;
};

/// Two solvers with nothing in common, each the other's check: the Adams methods of SUNDIALS CVODE
/// [Hindmarsh et al., ACM Trans. Math. Softw. 31, 363 (2005)] and the explicit Runge-Kutta pair
/// 5(4) of Dormand and Prince in SUNDIALS ARKODE [Reynolds et al., ACM Trans. Math. Softw. 49, 19
/// (2023)].
enum class ReferenceSolver { adams, runge_kutta };

/// The state after `duration` in the deterministic limit of the model, k = 0, where noise and what
/// it induces vanish together:
///   dr/dt = p/m,  dp/dt = F^C - zeta v e,  du/dt = 1/2 zeta v^2 + lambda (theta_j - theta_i).
/// and du/dt += u d(ln chi)/dt, F^C at the present energies, where the repulsion follows the
/// temperatures (FluidParameters::thermal_repulsion).
/// Total energy and momentum are conserved by the equations. Every method that claims to be
/// consistent converges to this as its step shrinks.
///
/// Pairs are found by a double loop, so it is for small systems. Positions go through the periodic
/// box without a jump and are wrapped at the end; `frozen` particles keep theirs. Ids and the order
/// of storage are those of `start`.
///
/// Throws std::invalid_argument if the fluid fluctuates (boltzmann is not 0), the duration is
/// negative or the box is shorter than twice the range; std::runtime_error naming the solver's
/// reason if it fails.
State reference_solution(const Fluid& fluid, const Box& box, const State& start, bool frozen,
                         double duration, const ReferenceTolerance& tolerance = {},
                         ReferenceSolver solver = ReferenceSolver::adams);

}  // namespace driftless
