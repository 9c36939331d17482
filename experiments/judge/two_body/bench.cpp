#include "experiments/judge/two_body/bench.hpp"

namespace driftless::two_body {

Bench make_bench(double phi_over_k, FrictionClosure closure, HeatForm form,
                 double conduction_rate) {
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

Bench make_isothermal_bench(double mass_ratio) {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.mass = 2.4;
  f.temperature = 1.3;
  f.isothermal = true;
  const double distance = 0.4, weight = (1 - distance) * (1 - distance);
  double reduced_mass = 0.5 * f.mass;
  if (mass_ratio != 1) {
    f.further_species = {{.mass = mass_ratio * f.mass}};
    reduced_mass = f.mass * mass_ratio / (1 + mass_ratio);
  }
  f.friction = reduced_mass / weight;  // zeta w/mu = 1
  return {Fluid(f), distance, 0.5 * f.boltzmann * f.temperature};
}

}  // namespace driftless::two_body
