#include "experiments/flux/border_flux.hpp"

namespace driftless::flux {

Carried& Carried::operator+=(const Carried& other) {
  internal += other.internal;
  kinetic += other.kinetic;
  potential += other.potential;
  return *this;
}

Carried BorderFlux::energy_of(System& system, std::size_t place) const {
  const State& state = system.state();
  return {state.internal_energy[place] - reference_,
          0.5 * system.mass(place) * state.velocity[place].squaredNorm(),
          system.potential_shares()[place]};
}

void BorderFlux::before(System& system) {
  energy_.resize(system.size());
  inside_.resize(system.size());
  const State& state = system.state();
  for (std::size_t i = 0; i < system.size(); ++i) {
    energy_[state.id[i]] = energy_of(system, i);
    inside_[state.id[i]] = inside(state.position[i]);
  }
}

void BorderFlux::after(System& system) {
  double gained_inside = 0, gained_outside = 0;
  const State& state = system.state();
  for (std::size_t i = 0; i < system.size(); ++i) {
    const Carried now = energy_of(system, i), &then = energy_[state.id[i]];
    const bool is_inside = inside(state.position[i]), was_inside = inside_[state.id[i]] != 0;
    const double gain = now.total() - then.total();
    const double share = 0.5 * ((is_inside ? 1 : 0) + (was_inside ? 1 : 0));
    gained_inside += share * gain;
    gained_outside += (1 - share) * gain;
    if (is_inside == was_inside) continue;
    const Carried mean{0.5 * (then.internal + now.internal), 0.5 * (then.kinetic + now.kinetic),
                       0.5 * (then.potential + now.potential)};
    (was_inside ? crossed_.by_leaving : crossed_.by_entering) += mean;
    ++(was_inside ? crossed_.leaving : crossed_.entering);
  }
  crossed_.pairs += 0.5 * (gained_outside - gained_inside);
  crossed_.created += gained_outside + gained_inside;
}

Crossed BorderFlux::take() {
  const Crossed crossed = crossed_;
  crossed_ = {};
  return crossed;
}

double BorderFlux::energy_inside(System& system) const {
  double sum = 0;
  for (std::size_t i = 0; i < system.size(); ++i) {
    if (inside(system.state().position[i])) sum += energy_of(system, i).total();
  }
  return sum;
}

namespace {

/// What the particles outside the region gain per unit time: of a pair on one side the gains
/// cancel.
template <class Kernel>
double gain_outside(System& system, int axis, const Slab& region, const Kernel& kernel) {
  Exchange rate;
  system.accumulate(kernel, rate);
  const State& state = system.state();
  double gain = 0;
  for (std::size_t i = 0; i < system.size(); ++i) {
    if (region.contains(state.position[i][axis])) continue;
    gain += rate.energy[i] + rate.momentum[i].dot(state.velocity[i]);
  }
  return gain;
}

/// Of the part of the repulsion that follows the temperatures each particle pays its own share.
double work_of_thermal_repulsion(System& system, int axis, const Slab& region) {
  const auto& strength = system.thermal_repulsion();
  if (strength.empty()) return 0;
  const State& state = system.state();
  double gain = 0;
  const auto outside = [&](std::size_t i) { return !region.contains(state.position[i][axis]); };
  system.for_each_pair([&](const System::Geometry& pair) {
    const double shape = pair.law->thermal_shape_force(pair.r);
    const double v_i = pair.e.dot(state.velocity[pair.i]), v_j = pair.e.dot(state.velocity[pair.j]);
    const double of_i = strength[pair.i] * shape, of_j = strength[pair.j] * shape;
    if (outside(pair.i)) gain += (of_i + of_j) * v_i - of_i * (v_i - v_j);
    if (outside(pair.j)) gain -= (of_i + of_j) * v_j + of_j * (v_i - v_j);
  });
  return gain;
}

}  // namespace

PairRates pair_rates(System& system, int axis, const Slab& region) {
  const Fluid& fluid = system.fluid();
  PairRates rates;
  if (fluid.has_conduction()) {
    rates.conduction = gain_outside(system, axis, region, [&](const auto& pair) {
      const auto law = fluid.conduction(pair);
      const auto heat = law.rate + law.induced;
      return Transfer{0 * heat, heat, -heat};
    });
  }
  const auto work_of = [](const auto& force, const auto& pair) {
    const auto paid = -0.5 * force * pair.v;
    return Transfer{force, paid, paid};
  };
  if (fluid.has_friction()) {
    rates.work_of_friction = gain_outside(system, axis, region, [&](const auto& pair) {
      const auto law = fluid.friction(pair);
      return work_of(-(law.friction + law.induced) * pair.v, pair);
    });
  }
  if (fluid.has_repulsion()) {
    rates.work_of_repulsion = gain_outside(system, axis, region, [&](const auto& pair) {
      return work_of(fluid.repulsive_force(pair), pair);
    });
    rates.work_of_repulsion += work_of_thermal_repulsion(system, axis, region);
  }
  return rates;
}

}  // namespace driftless::flux
