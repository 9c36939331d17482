#pragma once

#include "integrators/metropolis.hpp"

namespace driftless {

/// The update of a pair's relative velocity of Peters [Europhys. Lett. 66, 311 (2004)], kT being k
/// Theta of the pair as it stands [Pastewka, Kauzlaric, Greiner, Korvink, Phys. Rev. E 73, 037701
/// (2006)] and the kinetic energy change put back into the internal energies:
///   v' = v - (a dt/mu) v + (b dt^{1/2}/mu) W,  b^2 = 2 k Theta a (1 - a dt/(2 mu))
/// with a = zeta, scheme I (needs zeta dt < 2 mu: beyond, the square root ends the step), or
/// a dt = mu (1 - e^{-zeta dt/mu}), scheme II, which is the exact Ornstein-Uhlenbeck solution.
/// Both keep Maxwell's law at a fixed Theta. As Theta is not fixed, zeta is raised by what is
/// noise-induced, and 2 k Theta zeta stands for Gamma^2.
template <class V>
Transfer<V> peters_friction(const Fluid& fluid, const Pair<V>& pair, double dt, bool exponential) {
  using std::sqrt;
  const double mu = fluid.reduced_mass(pair);
  const auto law = fluid.friction(pair);
  const V zeta = law.friction + law.induced;
  if (exponential) {
    return change_velocity(fluid, pair, ornstein_uhlenbeck(pair, zeta, law.noise_squared, mu, dt));
  }
  const V x = zeta * dt / mu;
  const V kick = sqrt(law.noise_squared * dt * (1 - x / 2)) * pair.noise;
  return change_velocity(fluid, pair, kick / mu - x * pair.v);
}

/// What decides over a new velocity in lowe_andersen_friction.
enum class Resampling { exact, maxwell };

/// With probability p = 1 - e^{-rate zeta dt/mu} the pair forgets its relative velocity [Lowe,
/// Europhys. Lett. 47, 145 (1999)], its kinetic energy change going into the internal energies.
/// The energies e_i = u_i + mu v^2/4 and e_j likewise that the pair would have at v = 0 stay what
/// they are, so zeta, and with it p, are taken there.
///   `exact`    v' from the pair's law exp{[s(e_i - mu v'^2/4) + s(e_j - mu v'^2/4)]/k}: a normal
///              variate of variance k Theta(e_i, e_j)/mu, accepted by Metropolis; leaves the law
///              exact, with O(k/phi) refusals, and energies above 0
///   `maxwell`  v' normal of variance k Theta/mu at the energies before, as one would for a bath:
///              the law is off by O(k/phi), whatever dt
/// In an isothermal fluid both are the jumps of Lowe 1999, exact in law.
template <class V>
Transfer<V> lowe_andersen_friction(const Fluid& fluid, const Pair<V>& pair, double dt, double rate,
                                   Resampling resampling) {
  using std::max;
  using std::sqrt;
  const double mu = fluid.reduced_mass(pair), k = fluid.boltzmann();
  Pair<V> rest = pair;
  const double share = fluid.isothermal() ? 0 : 0.25 * mu;  // a bath's energy is what it is
  rest.u_i += share * pair.v * pair.v;
  rest.u_j += share * pair.v * pair.v;
  const V x = rate * fluid.friction(rest).friction * dt / mu;
  const V probability = x * mean_decay(x);
  const Pair<V>& bath = resampling == Resampling::exact ? rest : pair;
  const V spread = fluid.mean_temperature(bath) / mu;
  const V v = sqrt(k * spread) * pair.noise;
  const auto transfer = change_velocity(fluid, pair, v - pair.v);
  const auto jumps = pair.uniform < probability;
  if (resampling == Resampling::maxwell || fluid.isothermal()) return only_where(jumps, transfer);
  const PossibleGains<V> gains(pair, transfer);
  const V ratio = entropy_gain(fluid, pair, gains) + (v * v - pair.v * pair.v) / (2 * spread);
  // A uniform variate below p is p times another one.
  const V uniform = pair.uniform / max(probability, V(1e-300));
  return accepted(fluid, transfer, jumps && gains.possible, ratio, uniform);
}

}  // namespace driftless
