#pragma once

#include <optional>
#include <vector>

#include "model/coefficient_law.hpp"
#include "model/equation_of_state.hpp"

namespace driftless {

/// Which of the two friction coefficients depends on the distance alone (theory of the closures:
/// Espanol 1997 for `noise`, Mackie, Bonet Avalos and Navas 1999, eq. 3.23, for `friction`).
enum class FrictionClosure { noise, friction };

/// Which heat coefficient depends on the distance alone: L of eq. 3.24 of Mackie et al. 1999
/// (`inverse_temperature`, flux L (1/theta_i - 1/theta_j)) or the conductivity lambda of Ripoll and
/// Ernst 2005 (`temperature`, flux lambda (theta_i - theta_j)).
enum class HeatForm { none, inverse_temperature, temperature };

/// A species beside the first one.
struct SpeciesParameters {
  double mass = 1;           ///< m > 0
  double heat_capacity = 1;  ///< phi > 0; without meaning in an isothermal fluid
  double heat_capacity_slope = 0;
  std::vector<StatePoint> equation_of_state = {};
  bool operator==(const SpeciesParameters&) const = default;
};

/// What pairs of two species have other than the fluid's coefficients.
struct PairParameters {
  unsigned a = 0, b = 0;  ///< numbers of the species, in any order; the first is 0
  std::optional<double> repulsion = {}, friction = {}, conduction = {};
  bool operator==(const PairParameters&) const = default;
};

/// Parameters of a fluid, all in program units: of DPDE, with internal energies, or of isothermal
/// DPD, where a bath takes their place. Mass and heat capacity are those of the first species.
struct FluidParameters {
  double boltzmann = 1;      ///< Boltzmann's constant k >= 0; 0 switches every fluctuation off
  double mass = 1;           ///< particle mass m > 0
  double temperature = 1;    ///< T > 0 at which `friction` is quoted; of the bath if isothermal
  double heat_capacity = 1;  ///< phi = du/dtheta > 0 of one particle (s = phi ln u)
  /// b >= 0 of a heat capacity phi + b (theta - T) (EquationOfState::linear_heat_capacity).
  double heat_capacity_slope = 0;
  /// Points of a tabulated u(theta) (EquationOfState::table), in place of the heat capacity; empty
  /// if there is none.
  std::vector<StatePoint> equation_of_state = {};
  double repulsion = 0;  ///< a of psi = (a r_c/2)(1 - r/r_c)^2 (Groot and Warren 1997)
  /// a_1 >= 0 of a repulsion that follows the temperatures of the pair [Soleymani, Ripoll, Gompper,
  /// Fedosov, J. Chem. Phys. 152, 064112 (2020)]: a + a_1 (theta_i + theta_j)/(2 T) takes the place
  /// of a between all particles, walls have none of it. Heat capacities have to be constant. theta
  /// is u/phi of the energy u that the entropy phi ln u is of; the internal energies of a State are
  /// eps = chi u then, chi = 1 + a_1 W/(phi T), W half the sum over the particle's pairs of
  /// (r_c/2)(1 - r/r_c)^2. With these the energy is that of a alone, and the temperature that
  /// friction, conduction and all observables know is eps/phi (results/
  /// temperature_dependent_repulsion.md derives it).
  double thermal_repulsion = 0;
  double repulsion_range = 1;
  double friction = 0;  ///< zeta_0 at temperature T, for either closure
  FrictionClosure friction_closure = FrictionClosure::noise;
  double friction_range = 1;
  double conduction = 0;  ///< L_0 for `inverse_temperature`, lambda_0 for `temperature`
  HeatForm heat_form = HeatForm::none;
  double heat_range = 1;
  double weight_exponent = 2;  ///< s of w(r) = (1 - r/r_c)^s, for friction and heat
  /// p of the power (theta_i theta_j/T^2)^(p/2) of the mean temperature that the coefficient which
  /// the closure, or the heat form, gives is multiplied by; walls share it. With p not 0 every
  /// noise amplitude follows the energies, that of the closure `noise` too.
  double friction_temperature_exponent = 0, conduction_temperature_exponent = 0;
  /// Any other factor in place of the power.
  CoefficientLaw friction_law = {}, conduction_law = {};
  /// Particles have no internal energy: friction and its noise exchange energy with a bath of the
  /// temperature T, Gamma^2 = 2 k T zeta with zeta = zeta_0 w(r) for either closure [Espanol,
  /// Warren, Europhys. Lett. 30, 191 (1995)]. Nothing conducts, and the heat capacity has no
  /// meaning.
  bool isothermal = false;
  std::vector<SpeciesParameters> further_species = {};
  /// Coefficients of pairs of species [Marsh, Coveney, J. Phys. A 31, 6561 (1998), section III];
  /// where none are given the fluid's hold.
  std::vector<PairParameters> pairs = {};

  bool has_repulsion() const { return repulsion != 0 || thermal_repulsion != 0; }
  bool has_friction() const { return friction != 0; }
  bool has_conduction() const { return heat_form != HeatForm::none && conduction != 0; }
  bool operator==(const FluidParameters&) const = default;
};

}  // namespace driftless
