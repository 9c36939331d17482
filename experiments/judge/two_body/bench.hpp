#pragma once

#include "model/initial.hpp"

/// The smallest system whose exact law is known: one isolated pair at a fixed distance.
namespace driftless::two_body {

/// One kind of pair, its particles at a fixed distance with the velocities along it; of a fluid of
/// two species one of each.
struct Bench {
  Fluid fluid;
  double pair_distance;
  double energy;  ///< of a pair, kinetic plus internal

  double reduced_mass() const { return fluid.law(0, fluid.species() - 1).reduced_mass(); }
  MicrocanonicalLaw law() const { return microcanonical_law(fluid, Layout::pairs, 2); }
  /// k T at the reference temperature.
  double thermal_energy() const { return fluid.boltzmann() * fluid.parameters().temperature; }
};

/// The relative velocity relaxes at unit rate and u_i - u_j at `conduction_rate`, so that one unit
/// of time is one relaxation time. k, m, T, mu and Gamma^2 all differ from 1: a misplaced power
/// shows.
Bench make_bench(double phi_over_k, FrictionClosure closure, HeatForm form,
                 double conduction_rate = 1);

/// A pair with a bath in the place of internal energies, whose relative velocity relaxes at unit
/// rate; its energy is the mean kinetic one, k T/2. With a mass ratio other than 1 the second
/// particle is of another species, that many times as heavy.
Bench make_isothermal_bench(double mass_ratio = 1);

/// What a pair is now: energies and relative velocity, the centre of mass's motion left out.
struct PairView {
  double velocity;  ///< (v_i - v_j).e
  double kinetic, u_i, u_j;

  double energy() const { return kinetic + u_i + u_j; }
};

}  // namespace driftless::two_body
