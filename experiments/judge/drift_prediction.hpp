#pragma once

#include "model/system.hpp"

namespace driftless::judge {

/// What theory says of the energy drift of methods that conserve energy but for a Verlet step, and
/// whose friction leaves the exact law as it is, per particle, in k T per unit of time and fourth
/// power of the step:
///   dE/dt = (h^4/kT) 1/2 sum over pairs < Gamma^2 (A_ij H_2)^2 >,
/// A_ij = e.(d/dp_i - d/dp_j) along the pair, h^2 H_2 the leading difference between the energy
/// that a Verlet step keeps and the energy,
///   H_2 = v^T Psi'' v/12 - sum |F_i|^2/24m  for kick, move, kick,
///   H_2 = -v^T Psi'' v/24 + sum |F_i|^2/12m for move, kick, move, a quarter of the drift.
/// Friction changes H_2 behind the Verlet step's back, and what it takes from it comes back as
/// energy [the shadow work of Sivak, Chodera, Crooks, Phys. Rev. X 3, 011007 (2013)]. Holds for
/// weak friction and small steps.
struct DriftPrediction {
  double kick_move_kick = 0;
  double move_kick_move = 0;
};

/// The average over velocities of the prediction, which is exact in them, at the positions as they
/// are. The matrix Psi'' is dense: 8 (3N)^2 bytes.
DriftPrediction predicted_drift(System& system);

}  // namespace driftless::judge
