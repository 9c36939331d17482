#pragma once

#include <cstdint>
#include <vector>

#include "model/fluid.hpp"
#include "model/noise.hpp"
#include "model/state.hpp"

namespace driftless {

/// How particles are placed: one fluid, or many isolated pairs each within range of its partner
/// alone (particles 2n and 2n+1), joined along the x axis.
enum class Layout { fluid, pairs };

/// How positions start; `pairs` are always placed on a lattice of pairs.
enum class Placement { random, lattice };

/// The exact microcanonical law of an isolated ideal system (centre of mass at rest): the kinetic
/// energy and the internal energies, as shares of their sum, are Dirichlet distributed with shapes
/// degrees/2 and a_i = phi_i/k + 1, whatever the masses. A fluid is one island of N particles with
/// 3(N-1) degrees; a system of isolated pairs has N/2 islands of 2 particles with the one degree
/// along the pair.
struct MicrocanonicalLaw {
  std::size_t islands = 1;
  std::size_t particles = 0;  ///< per island
  double degrees = 0;         ///< kinetic degrees of freedom per island
  double shape = 0;           ///< a = phi/k + 1 of the first species
  double boltzmann = 1;
  double excess_shape = 0;  ///< sum of a_i - a over the island's particles
  bool alike = true;        ///< whether all have the same a

  double total_shape() const {
    return 0.5 * degrees + static_cast<double>(particles) * shape + excess_shape;
  }
  /// Expectations at an island's energy e (kinetic plus internal). The internal temperature,
  /// 1/<1/theta>, is that of every species, the mean internal energy that of all particles; its
  /// variance and skewness are of particles that are all alike.
  double kinetic_temperature(double e) const { return e / (boltzmann * total_shape()); }
  double internal_temperature(double e) const { return e / (boltzmann * (total_shape() - 1)); }
  double kinetic_energy(double e) const { return 0.5 * e * degrees / total_shape(); }
  double internal_energy_mean(double e) const {
    return e * (shape + excess_shape / static_cast<double>(particles)) / total_shape();
  }
  double internal_energy_variance(double e) const;
  double internal_energy_skewness() const;
  /// The energy of an island at which kinetic_temperature(e) is the given one.
  double energy_at(double temperature) const { return boltzmann * total_shape() * temperature; }
};

/// Heat capacity of a particle of a species at the fluid's temperature.
double heat_capacity(const Fluid& fluid, std::size_t species = 0);

/// The law of `particles` particles of the fluid in a layout, `species` as in a State; boltzmann
/// must be above 0. All islands must have the species of the first one. Where the heat capacities
/// are not constant it is not exact: the law of the heat capacities at the fluid's temperature.
MicrocanonicalLaw microcanonical_law(const Fluid& fluid, Layout layout, std::size_t particles,
                                     const std::vector<std::uint8_t>& species = {});

/// A cubic box of the given number density; for `pairs` the smallest lattice on which every pair is
/// isolated, whatever the density.
Box make_box(const Fluid& fluid, Layout layout, std::size_t particles, double density,
             double pair_distance);

/// Positions (and ids 0..N-1) only; velocities and internal energies are zero.
State place(const Box& box, Layout layout, Placement placement, std::size_t particles,
            double pair_distance, const Noise& noise);

/// Draws velocities and internal energies from the exact law at `energy` per island (kinetic plus
/// internal): gamma variates of every particle's own shape and normal variates over the root of its
/// mass, the island's momentum removed, then all scaled together.
void draw_microcanonical(const Fluid& fluid, Layout layout, double energy, const Noise& noise,
                         State& state);

/// Draws velocities from the exact canonical law of an isothermal fluid at a temperature, the
/// centre of mass of every island at rest: Maxwell's, the island's momentum removed, so that its
/// kinetic energy over k T is Gamma(degrees/2) distributed. Internal energies are 0.
void draw_canonical(const Fluid& fluid, Layout layout, double temperature, const Noise& noise,
                    State& state);

/// The same energy per island, far from the law: every particle at one temperature and half of the
/// kinetic energy of equilibrium.
void draw_off_equilibrium(const Fluid& fluid, Layout layout, double energy, const Noise& noise,
                          State& state);

/// The same with a given kinetic energy per island.
void draw_alike(const Fluid& fluid, Layout layout, double energy, double kinetic,
                const Noise& noise, State& state);

/// Independent normal velocities of the given spread per component (along the pair for `pairs`) for
/// the first species, for others over the root of the relative mass, the island's momentum removed,
/// and all particles at one temperature.
void draw_given_spread(const Fluid& fluid, Layout layout, double spread, double temperature,
                       const Noise& noise, State& state);

/// Adds a uniform velocity.
void boost_frame(const Vector& velocity, State& state);

}  // namespace driftless
