#pragma once

#include <vector>

#include "model/heat_slabs.hpp"
#include "model/system.hpp"

/// What heat crosses a plane, and by what.
namespace driftless::flux {

/// Energy that particles carry, by kind; a particle's potential energy is its half of its pairs'.
struct Carried {
  double internal = 0, kinetic = 0, potential = 0;
  double total() const { return internal + kinetic + potential; }
  Carried& operator+=(const Carried& other);
};

/// What crossed the border of a region, counted as energy that leaves it.
struct Crossed {
  Carried by_leaving;                ///< carried out, by particles that come from inside
  Carried by_entering;               ///< carried in, by particles that come from outside
  double leaving = 0, entering = 0;  ///< numbers of particles
  /// Brought out by what pairs exchange across the border: conduction and the work of their forces.
  double pairs = 0;
  /// Energy of the whole system that came out of nowhere in the steps (what a method does not
  /// keep).
  double created = 0;

  double carried() const { return by_leaving.total() - by_entering.total(); }
  double total() const { return carried() + pairs; }
};

/// Measures what crosses the two planes that bound a region, step by step, from the states before
/// and after alone: whatever the method does within its step.
///
/// Exact balance of a step (derived). With s_i = 1 inside and 0 outside, e_i the energy of a
/// particle and primes after the step, the energy of the region changes by
///   sum_i (s_i' e_i' - s_i e_i) = sum_i (s_i' - s_i) (e_i + e_i')/2 + sum_i (s_i + s_i')/2
///   (e_i' - e_i).
/// The first sum is what particles carry; the second is what the particles inside gain from their
/// pairs, wholly if they stay and half of it if they cross. The same sum over the outside is its
/// negative if the step keeps the total energy; their difference is `pairs`, their sum `created`.
class BorderFlux {
 public:
  /// Internal energies are counted from `reference` on: where as many particles leave as enter the
  /// zero of energy does not matter, but counted from their mean the numbers of particles that
  /// happen to cross add no noise.
  BorderFlux(int axis, const Slab& region, double reference = 0)
      : axis_(axis), region_(region), reference_(reference) {}

  /// Notes the state before a step.
  void before(System& system);
  /// Adds what crossed in the step.
  void after(System& system);

  /// What crossed since the last call.
  Crossed take();

  /// Energy of the particles inside, internal energies counted in the same way.
  double energy_inside(System& system) const;

 private:
  bool inside(const Vector& position) const { return region_.contains(position[axis_]); }
  Carried energy_of(System& system, std::size_t place) const;

  int axis_;
  Slab region_;
  double reference_;
  std::vector<Carried> energy_;  ///< by ids, which are 0 to N - 1, as below
  std::vector<char> inside_;
  Crossed crossed_;
};

/// Mean rates at which pairs across the border bring energy out of the region, by the fluid's laws
/// at the present state: without their noise, whose mean is zero for equal masses. Rates of the
/// model, whatever the method makes of them.
struct PairRates {
  double conduction = 0;
  /// Work F (v_i + v_j)/2 along a pair: what i gains of kinetic energy, of its half of the work on
  /// the two internal energies and of the pair's potential, and j loses.
  double work_of_friction = 0, work_of_repulsion = 0;
};
PairRates pair_rates(System& system, int axis, const Slab& region);

}  // namespace driftless::flux
