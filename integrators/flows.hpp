#pragma once

#include <cmath>

#include "model/system.hpp"

/// The pieces that methods share, in the notation of the papers: a pair's exchange over dt.
namespace driftless {

/// Explicit Euler-Maruyama exchange of friction and its noise, second-order terms averaged:
/// f = -(zeta + induced) v dt + Gamma dt^{1/2} W, and each internal energy receives half of
/// (zeta + induced) v^2 dt - Gamma^2 dt/(2 mu) - v Gamma dt^{1/2} W.
template <class V>
Transfer<V> euler_friction(const Fluid& fluid, const Pair<V>& pair, double dt) {
  using std::sqrt;
  const auto law = fluid.friction(pair);
  const V drag = (law.friction + law.induced) * pair.v * dt;
  const V kick = sqrt(law.noise_squared * dt) * pair.noise;
  const V heat =
      0.5 * (pair.v * (drag - kick) - law.noise_squared * dt / (2 * fluid.reduced_mass(pair)));
  return {kick - drag, heat, heat};
}

/// Explicit Euler-Maruyama exchange of heat: i receives q, j gives it,
/// q = (lambda (theta_j - theta_i) + induced) dt + Lambda dt^{1/2} W_q.
template <class V>
Transfer<V> euler_conduction(const Fluid& fluid, const Pair<V>& pair, double dt) {
  using std::sqrt;
  const auto law = fluid.conduction(pair);
  const V heat = (law.rate + law.induced) * dt + sqrt(law.noise_squared * dt) * pair.heat_noise;
  return {V(0), heat, -heat};
}

/// What an impulse f of a pair takes from its internal energies if its work is that at the midpoint
/// velocity, (v + v')/2: each pays half.
template <class V>
Transfer<V> midpoint_work(const V& f, const Pair<V>& start, const TrialPair<V>& end) {
  const V work = 0.25 * f * (start.v + end.v);
  return {V(0), -work, -work};
}

/// The same for a conservative impulse, whose work whoever has the potential energy pays.
template <class V>
Transfer<V> conservative_work(const Fluid& fluid, const V& f, const Pair<V>& start,
                              const TrialPair<V>& end) {
  const V work = 0.5 * f * (start.v + end.v);
  const PairLaw& law = fluid.of(start);
  return {V(0), -law.potential_share_i() * work, -law.potential_share_j() * work};
}

/// The transfer where a condition holds, otherwise none.
template <class V, class Condition>
Transfer<V> only_where(const Condition& condition, const Transfer<V>& transfer) {
  return {select(condition, transfer.momentum, V(0)), select(condition, transfer.energy_i, V(0)),
          select(condition, transfer.energy_j, V(0))};
}

/// The transfer that changes the relative velocity by dv, the pair's kinetic energy change taken
/// from both internal energies in equal parts: exact in momentum and energy for any dv.
template <class V>
Transfer<V> change_velocity(const Fluid& fluid, const Pair<V>& pair, const V& dv) {
  const V momentum = fluid.reduced_mass(pair) * dv;
  const V heat = -0.25 * momentum * (2 * pair.v + dv);
  return {momentum, heat, heat};
}

/// Every exchange of a pair over dt from the state as it stands, conservative force included; what
/// the fluid does not have costs nothing.
template <class V>
Transfer<V> euler_exchange(const Fluid& fluid, const Pair<V>& pair, double dt) {
  Transfer<V> total;
  if (fluid.has_repulsion()) total.momentum += fluid.repulsive_force(pair) * dt;
  if (fluid.has_friction()) total += euler_friction(fluid, pair, dt);
  if (fluid.has_conduction()) total += euler_conduction(fluid, pair, dt);
  return total;
}

/// Euler-Maruyama for all pairs from the state at t, with the Euler move r' = r + v dt.
inline void euler_maruyama_step(System& system, double dt, Exchange& exchange) {
  const Fluid& fluid = system.fluid();
  system.accumulate([&](const auto& pair) { return euler_exchange(fluid, pair, dt); }, exchange);
  system.move(dt);
  system.apply(exchange);
}

/// The pair as it stands after an exchange, for the next flow of the same pair.
template <class V>
Pair<V> after(const Fluid& fluid, Pair<V> pair, const Transfer<V>& transfer) {
  pair.v += transfer.momentum / fluid.reduced_mass(pair);
  pair.u_i += transfer.energy_i;
  pair.u_j += transfer.energy_j;
  return pair;
}

/// Two exchanges of a pair, the second from the state that the first one leaves (or, with frozen
/// temperatures, from the same one); in a reverse sweep the other way round.
template <class V, class First, class Second>
Transfer<V> one_after_the_other(const Fluid& fluid, const Pair<V>& pair, const Sweep& how,
                                First&& first, Second&& second) {
  const auto next = [&](const Transfer<V>& done) {
    return how.energies == SweepEnergies::frozen ? pair : after(fluid, pair, done);
  };
  if (how.order == SweepOrder::forward) {
    auto total = first(pair);
    return total += second(next(total));
  }
  auto total = second(pair);
  return total += first(next(total));
}

/// Friction of a pair, then its conduction, as far as the fluid has them; in a reverse sweep the
/// other way round.
template <class V, class Friction, class Conduction>
Transfer<V> friction_and_conduction(const Fluid& fluid, const Pair<V>& pair, const Sweep& how,
                                    Friction&& friction, Conduction&& conduction) {
  return one_after_the_other(
      fluid, pair, how,
      [&](const Pair<V>& seen) { return fluid.has_friction() ? friction(seen) : Transfer<V>{}; },
      [&](const Pair<V>& seen) {
        return fluid.has_conduction() ? conduction(seen) : Transfer<V>{};
      });
}

/// Velocity Verlet with the conservative forces alone.
inline void velocity_verlet(System& system, double dt) {
  system.kick(dt / 2);
  system.move(dt);
  system.kick(dt / 2);
}

}  // namespace driftless
