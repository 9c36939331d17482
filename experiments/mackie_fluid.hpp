#pragma once

#include "model/fluid.hpp"
#include "model/state.hpp"

/// The ideal fluid of [MAN], Mackie, Bonet Avalos, Navas, PCCP 1, 2039 (1999), section 3, and the
/// walls it meets, in the paper's units: lengths in sqrt(2 m k T_R)/zeta_0, times in m/zeta_0. In
/// program units m = zeta_0 = T_R = 1 and k = 1/2.
namespace driftless {

/// The paper's dimensionless numbers of a fluid; its density is 1, it has no repulsion.
struct MackieFluid {
  double B;      ///< k/phi
  double C;      ///< L_0/phi
  double range;  ///< r*
};

/// Of the equilibrium runs [MAN Fig. 1-3].
inline constexpr MackieFluid mackie_liquid{0.01, 17, 1.24};
inline constexpr double mackie_temperature = 1.1;  ///< of its walls
/// Of the convection roll [MAN Fig. 4-6].
inline constexpr MackieFluid mackie_gas{0.1, 0.001, 2};
inline constexpr double mackie_hot = 2.8, mackie_cold = 0.8;  ///< temperatures of its walls
inline constexpr double mackie_gravity = 0.01;

FluidParameters mackie_parameters(const MackieFluid& fluid);

/// The repulsion of a wall: psi(x) = (a r_w/2)(1 - x/r_w)^2; a = 0: a hard wall.
struct WallRepulsion {
  double strength = 0;  ///< a
  double range = 1;     ///< r_w
};

/// Of the walls of the equilibrium runs, as far as their friction reaches. Chosen here: the paper
/// does not tell.
inline constexpr WallRepulsion mackie_repulsion{1.8, 1.24};

/// A reservoir with the friction, conduction and range that two particles have.
Wall mackie_reservoir(const FluidParameters& fluid, double temperature,
                      const WallRepulsion& repulsion = {});

}  // namespace driftless
