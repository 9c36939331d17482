#pragma once

#include "integrators/choice.hpp"
#include "integrators/relaxation.hpp"

namespace driftless {

/// Moves of a pair in one dimension, proposed as x' = x + drift + (k S)^{1/2} W and accepted with
/// the probability of Metropolis and Hastings against the pair's exact law exp{(s_i + s_j)/k}. All
/// is k times the usual, so that k = 0 is its limit and no special case:
///   k ln[rho' q(x|x')/(rho q(x'|x))]
///     = s_i' - s_i + s_j' - s_j + k W^2/2 - (x - x' - drift')^2/(2 S') + (k/2) ln(S/S')
/// with drift' and S' of the proposed state. `back` is x - x' - drift'.
template <class V>
V acceptance(const Fluid& fluid, const V& entropy_gain, const V& noise, const V& back,
             const V& spread, const V& spread_there) {
  using std::log;
  using std::max;
  const double k = fluid.boltzmann();
  const V s = max(spread, V(1e-300)), s_there = max(spread_there, V(1e-300));  // 0 where dt or w is
  return entropy_gain + 0.5 * k * noise * noise - back * back / (2 * s_there) +
         0.5 * k * log(s / s_there);
}

/// The transfer where `uniform` accepts it, otherwise none.
template <class V, class Condition>
Transfer<V> accepted(const Fluid& fluid, const Transfer<V>& transfer, const Condition& possible,
                     const V& acceptance, const V& uniform) {
  using std::log;
  return only_where(possible && fluid.boltzmann() * log(uniform) <= acceptance, transfer);
}

/// Whether both internal energies stay above 0, and gains with which it is safe to go on.
template <class V>
struct PossibleGains {
  decltype(V() > 0) possible;
  V i, j;

  PossibleGains(const Pair<V>& pair, const Transfer<V>& transfer)
      : possible(pair.u_i + transfer.energy_i > 0 && pair.u_j + transfer.energy_j > 0),
        i(select(possible, transfer.energy_i, V(0))),
        j(select(possible, transfer.energy_j, V(0))) {}
};

/// s_i' - s_i + s_j' - s_j, and what rounding may have taken from it. Without fluctuations small
/// moves are accepted by a hair, and rounding would refuse some of them.
template <class V>
V entropy_gain(const Fluid& fluid, const Pair<V>& pair, const PossibleGains<V>& gains) {
  using std::abs;
  const PairLaw& law = fluid.of(pair);
  const V i = law.entropy_gain_i(pair, gains.i), j = law.entropy_gain_j(pair, gains.j);
  return i + j + 1e-14 * (abs(i) + abs(j));
}

/// Drift and S = variance/k of a proposal.
template <class V>
struct Proposal {
  V drift, spread;
};

/// A pair's relative velocity over dt by the Ornstein-Uhlenbeck process at the energies of `pair`
/// [Stoltz, J. Comput. Phys. 340, 451 (2017)]: alpha = e^{-x}, x = zeta dt/mu,
///   v' = alpha v + (k S)^{1/2} W,  S = (Theta/mu)(1 - alpha^2)
template <class V>
Proposal<V> friction_proposal(const Fluid& fluid, const Pair<V>& pair, double dt) {
  const double mu = fluid.reduced_mass(pair);
  const V x = fluid.friction(pair).friction * dt / mu;
  const V mean = fluid.mean_temperature(pair);
  return {-x * mean_decay(x) * pair.v, mean / mu * 2 * x * mean_decay(2 * x)};
}

/// A move of one coordinate of a pair, accepted against the pair's exact law; internal energies
/// never fall below 0.
///   propose(pair)    -> Proposal of the coordinate's change
///   exchange(change) -> Transfer that makes it
template <class V, class Propose, class ExchangeOf>
Transfer<V> metropolis_move(const Fluid& fluid, const Pair<V>& pair, const V& noise,
                            const V& uniform, Propose&& propose, ExchangeOf&& exchange) {
  using std::sqrt;
  const Proposal<V> there = propose(pair);
  const V change = there.drift + sqrt(fluid.boltzmann() * there.spread) * noise;
  const Transfer<V> transfer = exchange(change);
  const PossibleGains<V> gains(pair, transfer);
  const Proposal<V> back = propose(after(fluid, pair, {transfer.momentum, gains.i, gains.j}));
  const V ratio = acceptance(fluid, entropy_gain(fluid, pair, gains), noise, -change - back.drift,
                             there.spread, back.spread);
  return accepted(fluid, transfer, gains.possible, ratio, uniform);
}

/// Friction of a pair over dt, proposed by friction_proposal: exact in law at any dt.
/// O(dt^{3/2} k/phi) of the moves are refused where Gamma is constant. Where it depends on the
/// energies, the refusals, now O(dt^{1/2} k/phi), make the noise-induced friction, and rates
/// converge no faster than that.
template <class V>
Transfer<V> metropolis_friction(const Fluid& fluid, const Pair<V>& pair, double dt) {
  return metropolis_move(
      fluid, pair, pair.noise, pair.uniform,
      [&](const Pair<V>& seen) { return friction_proposal(fluid, seen, dt); },
      [&](const V& change) { return change_velocity(fluid, pair, change); });
}

/// How conduction is proposed.
enum class ConductionProposal { euler, exponential };

/// The option `conduction_proposal` of a method.
inline ConductionProposal conduction_proposal_choice(const Method& method, const Options& options) {
  const auto word = choice(method, options, "conduction_proposal", {"euler", "exponential"});
  return word == "euler" ? ConductionProposal::euler : ConductionProposal::exponential;
}

/// Heat from j to i over dt; `euler`:
///   drift = (lambda (theta_j - theta_i) + induced) dt,  S = 2 lambda theta_i theta_j dt
/// or `exponential`, with y = lambda c dt, c = 1/c_i + 1/c_j of the heat capacities, alpha =
/// e^{-y}:
///   drift = (1 - alpha)(theta_j - theta_i)/c,  S = theta_i theta_j (1 - alpha^2)/c
/// Stoltz 2017 has the first; it is refused ever more often as y grows. The second (derived) solves
/// the linear relaxation of theta_j - theta_i and is refused in O(k/phi) of the cases at most.
template <class V>
Proposal<V> conduction_proposal(const Fluid& fluid, const Pair<V>& pair, double dt,
                                ConductionProposal kind) {
  const PairLaw& law = fluid.of(pair);
  const V theta_i = law.temperature_i(pair), theta_j = law.temperature_j(pair);
  const V lambda = fluid.conductivity(pair);
  if (kind == ConductionProposal::euler) {
    const auto heat = law.conduction(pair);
    return {(heat.rate + heat.induced) * dt, 2 * lambda * theta_i * theta_j * dt};
  }
  const V c = law.inverse_heat_capacities(pair);
  const V y = lambda * c * dt;
  return {lambda * dt * mean_decay(y) * (theta_j - theta_i),
          2 * lambda * dt * mean_decay(2 * y) * theta_i * theta_j};
}

/// Conduction of a pair over dt: exact in law at any dt.
template <class V>
Transfer<V> metropolis_conduction(const Fluid& fluid, const Pair<V>& pair, double dt,
                                  ConductionProposal kind) {
  return metropolis_move(
      fluid, pair, pair.heat_noise, pair.heat_uniform,
      [&](const Pair<V>& seen) { return conduction_proposal(fluid, seen, dt, kind); },
      [](const V& heat) {
        return Transfer<V>{V(0), heat, -heat};
      });
}

/// Friction of a pair, then its conduction, over dt; in a reverse sweep the other way round.
template <class V>
Transfer<V> metropolis_exchange(const Fluid& fluid, const Pair<V>& pair, double dt,
                                ConductionProposal kind, const Sweep& how) {
  return friction_and_conduction(
      fluid, pair, how, [&](const Pair<V>& seen) { return metropolis_friction(fluid, seen, dt); },
      [&](const Pair<V>& seen) { return metropolis_conduction(fluid, seen, dt, kind); });
}

}  // namespace driftless
