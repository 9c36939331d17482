#pragma once

#include <vector>

#include "model/pair_law.hpp"

namespace driftless {

struct Box;

/// The constitutive laws of a fluid: what pairs of its particles exchange per unit time. Functions
/// of a pair follow the laws of its kind (Pair::law); those of a distance or an energy alone are of
/// the first species and its pairs.
class Fluid {
 public:
  /// Throws std::invalid_argument naming the parameter, its value and the allowed range. If
  /// isothermal, the closure is `noise` and the heat capacity 1, so that bath_energy() has the
  /// bath's temperature and the laws below are those of the bath.
  explicit Fluid(const FluidParameters& parameters);

  const FluidParameters& parameters() const { return parameters_; }
  /// Whether any pair has it, those with the walls of a box included.
  bool has_repulsion() const { return has_repulsion_; }
  bool has_friction() const { return has_friction_; }
  bool has_conduction() const { return has_conduction_; }
  bool isothermal() const { return parameters_.isothermal; }
  /// What kernels see in the place of an internal energy in an isothermal fluid.
  double bath_energy() const { return internal_energy(parameters_.temperature); }
  /// Whether the repulsion depends on the temperatures (FluidParameters::thermal_repulsion). The
  /// functions of a distance or a pair below do not know of that part: System adds it.
  bool repulsion_follows_temperatures() const { return parameters_.thermal_repulsion != 0; }
  bool fluctuates() const { return parameters_.boltzmann > 0; }
  double boltzmann() const { return parameters_.boltzmann; }
  /// Whether the friction's noise of any pair, or the noise of anything, follows the internal
  /// energies: a method then needs what is noise-induced to be consistent.
  bool friction_noise_follows_energies() const {
    return fluctuates() && friction_noise_follows_energies_;
  }
  bool noise_follows_energies() const {
    return fluctuates() && (friction_noise_follows_energies_ || heat_noise_follows_energies_);
  }
  /// Whether the entropy of every particle is phi ln u.
  bool has_constant_heat_capacities() const;

  std::size_t species() const { return partners_.size(); }
  double mass(std::size_t species = 0) const { return partners_[species].mass; }
  const EquationOfState& equation_of_state(std::size_t species = 0) const {
    return partners_[species].state;
  }
  double reduced_mass() const { return laws_.front().reduced_mass(); }
  /// The laws of pairs of two species, i having the smaller id.
  const PairLaw& law(std::size_t species_i, std::size_t species_j) const {
    return laws_[species_i * species() + species_j];
  }
  /// The fluid with the laws of its particles and what a box surrounds it with. Throws
  /// std::invalid_argument if walls or field make no sense.
  Fluid within(const Box& box) const;
  /// The laws of a species and a wall (0 to 5: lower x, upper x, lower y, ...) or the field (6);
  /// null where there is none.
  const PairLaw* boundary_law(std::size_t boundary, std::size_t species) const {
    const std::size_t place = boundary * this->species() + species;
    return place < boundary_laws_.size() && boundary_laws_[place] ? &*boundary_laws_[place]
                                                                  : nullptr;
  }

  /// The largest range of the terms that act between particles; 0 if none does.
  double range() const;

  /// theta(u), temperature of a particle (ds/du = 1/theta).
  template <class V>
  V temperature(V internal_energy) const {
    return equation_of_state().temperature(internal_energy);
  }
  /// c(u) = du/dtheta.
  template <class V>
  V heat_capacity(V internal_energy) const {
    return 1 / equation_of_state().inverse_heat_capacity(internal_energy);
  }
  /// s(u), up to a constant.
  template <class V>
  V entropy(V internal_energy) const {
    return equation_of_state().entropy(internal_energy);
  }
  /// s(u + gain) - s(u), to rounding however small the gain; both energies must be above 0.
  template <class V>
  V entropy_gain(V internal_energy, V gain) const {
    return equation_of_state().entropy_gain(internal_energy, gain);
  }
  /// u(theta), the inverse of temperature().
  double internal_energy(double temperature) const {
    return equation_of_state().internal_energy(temperature);
  }

  template <class V>
  V friction_weight(V distance) const {
    return laws_.front().friction_weight(distance);
  }
  template <class V>
  V heat_weight(V distance) const {
    return laws_.front().heat_weight(distance);
  }
  template <class V>
  V repulsive_force(V distance) const {
    return laws_.front().repulsive_force(distance);
  }
  template <class V>
  V potential(V distance) const {
    return laws_.front().potential(distance);
  }
  double potential_laplacian(double distance) const {
    return laws_.front().potential_laplacian(distance);
  }
  /// Theta of two internal energies (Mackie et al. 2.37).
  template <class V>
  V mean_temperature(V u_i, V u_j) const {
    const V theta_i = temperature(u_i), theta_j = temperature(u_j);
    return 2 * theta_i * theta_j / (theta_i + theta_j);
  }

  /// The laws of a pair's kind; where none is named the first species'.
  template <class V>
  const PairLaw& of(const Pair<V>& pair) const {
    return pair.law ? *pair.law : laws_.front();
  }
  template <class V>
  double reduced_mass(const Pair<V>& pair) const {
    return of(pair).reduced_mass();
  }
  template <class V>
  V repulsive_force(const Pair<V>& pair) const {
    return of(pair).repulsive_force(pair.r);
  }
  template <class V>
  V potential(const Pair<V>& pair) const {
    return of(pair).potential(pair.r);
  }
  template <class V>
  V mean_temperature(const Pair<V>& pair) const {
    return of(pair).mean_temperature(pair);
  }
  template <class V>
  FrictionLaw<V> friction(const Pair<V>& pair) const {
    return of(pair).friction(pair);
  }
  template <class V>
  AmplitudeSlopes<V> friction_noise_slopes(const Pair<V>& pair) const {
    return of(pair).friction_noise_slopes(pair);
  }
  template <class V>
  ConductionLaw<V> conduction(const Pair<V>& pair) const {
    return of(pair).conduction(pair);
  }
  template <class V>
  V conductivity(const Pair<V>& pair) const {
    return of(pair).conductivity(pair);
  }
  template <class V>
  AmplitudeSlopes<V> heat_noise_slopes(const Pair<V>& pair) const {
    return of(pair).heat_noise_slopes(pair);
  }

 private:
  void add_partner(const SpeciesParameters& species);
  PairCoefficients coefficients(std::size_t species_i, std::size_t species_j) const;
  void note_terms(const PairLaw& law);
  void add_wall(const Box& box, std::size_t face);
  void add_field(const Box& box);

  FluidParameters parameters_;
  std::vector<Partner> partners_;  ///< of each species
  std::vector<PairLaw> laws_;      ///< of species i and j at i species() + j
  std::vector<std::optional<PairLaw>> boundary_laws_;
  bool has_repulsion_ = false, has_friction_ = false, has_conduction_ = false;
  bool friction_noise_follows_energies_ = false, heat_noise_follows_energies_ = false;
};

}  // namespace driftless
