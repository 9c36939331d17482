#pragma once

#include "model/initial.hpp"

/// The smallest system whose exact law is known: one isolated pair at a fixed distance.
namespace driftless::two_body {

/// One kind of pair, its particles at a fixed distance with the velocities along it.
struct Bench {
  Fluid fluid;
  double pair_distance;
  double energy;  ///< of a pair, kinetic plus internal

  MicrocanonicalLaw law() const { return microcanonical_law(fluid, Layout::pairs, 2); }
  /// k T at the reference temperature.
  double thermal_energy() const { return fluid.boltzmann() * fluid.parameters().temperature; }
};

/// The relative velocity relaxes at unit rate and u_i - u_j at `conduction_rate`, so that one unit
/// of time is one relaxation time. k, m, T, mu and Gamma^2 all differ from 1: a misplaced power
/// shows.
inline Bench make_bench(double phi_over_k, FrictionClosure closure, HeatForm form,
                        double conduction_rate = 1) {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.mass = 2.4;
  f.temperature = 1.3;
  f.heat_capacity = phi_over_k * f.boltzmann;
  f.friction_closure = closure;
  f.heat_form = form;
  const double distance = 0.4, weight = (1 - distance) * (1 - distance);
  f.friction = 0.5 * f.mass / weight;  // zeta w/mu = 1
  // d(u_i - u_j)/dt = -2 lambda w (u_i - u_j)/phi, lambda = L/T^2
  f.conduction = 0.5 * conduction_rate * f.heat_capacity / weight;
  if (form == HeatForm::inverse_temperature) f.conduction *= f.temperature * f.temperature;
  const Fluid fluid(f);
  const auto law = microcanonical_law(fluid, Layout::pairs, 2);
  return {fluid, distance, law.energy_at(f.temperature)};
}

/// What a pair is now: energies and relative velocity, the centre of mass's motion left out.
struct PairView {
  double velocity;  ///< (v_i - v_j).e
  double kinetic, u_i, u_j;

  double energy() const { return kinetic + u_i + u_j; }
};

}  // namespace driftless::two_body
