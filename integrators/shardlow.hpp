#pragma once

#include "integrators/choice.hpp"
#include "integrators/relaxation.hpp"

namespace driftless {

/// What the methods of Shardlow's family leave open.
struct ShardlowChoices {
  /// Leave the noise-induced friction out.
  bool as_published = false;
  /// The exact Ornstein-Uhlenbeck update in place of Shardlow's half-implicit one.
  bool exponential = false;
  /// Temperatures of a sweep: fresh for every pair, or those at its start, as LAMMPS does.
  SweepEnergies temperatures = SweepEnergies::fresh;
  /// Pairs in an order that distant ones share, as in Larentzos et al., Comput. Phys. Commun. 185,
  /// 1987 (2014), or by ascending ids.
  SweepSequence sequence = SweepSequence::coloured;
};

/// The options of the choices, by the default of `update`.
inline std::vector<OptionSpec> shardlow_options(const std::string& update) {
  return {{"as_published", false, "leave the noise-induced friction out"},
          {"update", update, "of a pair's velocity: \"half-implicit\" or \"exponential\""},
          {"temperatures", std::string("fresh"), "in a sweep: \"fresh\" or \"frozen\""},
          {"order", std::string("coloured"), "of the pairs: \"coloured\" or, slower, \"ids\""}};
}

inline ShardlowChoices shardlow_choices(const Method& method, const Options& options) {
  const auto temperatures = choice(method, options, "temperatures", {"fresh", "frozen"});
  return {option<bool>(method, options, "as_published"),
          choice(method, options, "update", {"half-implicit", "exponential"}) == "exponential",
          temperatures == "frozen" ? SweepEnergies::frozen : SweepEnergies::fresh,
          choice(method, options, "order", {"coloured", "ids"}) == "ids" ? SweepSequence::by_ids
                                                                         : SweepSequence::coloured};
}

/// The pair update of Shardlow [SIAM J. Sci. Comput. 24, 1267 (2003)] with the pair's kinetic
/// energy change put back into its internal energies [Lisal, Brennan, Avalos, J. Chem. Phys. 135,
/// 204105 (2011)], coefficients frozen at the start of the update:
///   v1 = v + (1/mu) (-zeta v dt/2 + Gamma dt^{1/2} W/2)
///   v' = [v1 + Gamma dt^{1/2} W/(2 mu)] / (1 + zeta dt/(2 mu))
///   f = mu (v' - v),  u_i -= mu (v'^2 - v^2)/4,  u_j likewise
/// or, `exponential`, with v' from the exact solution at these coefficients. Freezing Gamma leaves
/// the noise-induced friction out: zeta is raised by it unless `as_published`.
template <class V>
Transfer<V> shardlow_friction(const Fluid& fluid, const Pair<V>& pair, double dt,
                              const ShardlowChoices& choices) {
  using std::sqrt;
  const double mu = fluid.reduced_mass(pair);
  const auto law = fluid.friction(pair);
  const V zeta = choices.as_published ? law.friction : law.friction + law.induced;
  if (choices.exponential) {
    return change_velocity(fluid, pair, ornstein_uhlenbeck(pair, zeta, law.noise_squared, mu, dt));
  }
  const V kick = sqrt(law.noise_squared * dt) * pair.noise;
  const V explicit_half = pair.v + (kick - zeta * pair.v * dt) / (2 * mu);
  const V v = (explicit_half + kick / (2 * mu)) / (1 + zeta * dt / (2 * mu));
  return change_velocity(fluid, pair, v - pair.v);
}

/// Without the noise-induced friction the limit is the model only where there is none.
inline bool shardlow_is_consistent(const Fluid& fluid, bool as_published) {
  return !(as_published && fluid.friction_noise_follows_energies());
}

/// Friction of a pair, then its conduction, at dt; in a reverse sweep the other way round.
template <class V>
Transfer<V> shardlow_exchange(const Fluid& fluid, const Pair<V>& pair, double dt, const Sweep& how,
                              const ShardlowChoices& choices) {
  return friction_and_conduction(
      fluid, pair, how,
      [&](const Pair<V>& seen) { return shardlow_friction(fluid, seen, dt, choices); },
      [&](const Pair<V>& seen) { return euler_conduction(fluid, seen, dt); });
}

/// All pairs one after the other over dt.
inline void shardlow_sweep(System& system, double dt, SweepOrder order, Stage stage,
                           const ShardlowChoices& choices) {
  const Fluid& fluid = system.fluid();
  const Sweep how{.order = order,
                  .sequence = choices.sequence,
                  .stage = stage,
                  .energies = choices.temperatures};
  system.sweep([&](const auto& pair) { return shardlow_exchange(fluid, pair, dt, how, choices); },
               how);
}

}  // namespace driftless
