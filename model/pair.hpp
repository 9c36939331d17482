#pragma once

#include <cstdint>

#include "model/lanes.hpp"
#include "model/stage.hpp"

namespace driftless {

class PairLaw;

/// What a pair (i, j), id_i < id_j, sees of itself; vectors are projected on e = (r_i - r_j)/r.
/// V is double or a vector of lanes: kernels are pure functions, generic in V.
template <class V>
struct Pair {
  V r;           ///< distance
  V w_friction;  ///< weight w(r) of friction
  V w_heat;      ///< weight w(r) of conduction
  V v;           ///< relative velocity (v_i - v_j).e
  V u_i, u_j;    ///< internal energies
  V noise;       ///< standard normal variate of the friction; 0 where nothing fluctuates
  V heat_noise;  ///< standard normal variate of the conduction, independent of `noise`
  /// Uniform variates in (0, 1), independent of all else, for who decides by chance; drawn only
  /// where a sweep asks for them, 1 elsewhere.
  V uniform{1.0}, heat_uniform{1.0};
  const PairLaw* law = nullptr;  ///< of the pair's kind; null: the first species' (Fluid::of)
};

/// A pair's state at the end of an implicit step, beside the `Pair` at its start.
template <class V>
struct TrialPair : Pair<V> {
  V dv_i, dv_j;  ///< changes (v_i' - v_i).e and (v_j' - v_j).e since the start
};

/// What a pair exchanges: particle i receives momentum +momentum e and energy_i, particle j
/// momentum -momentum e and energy_j.
template <class V>
struct Transfer {
  V momentum{0.0};
  V energy_i{0.0};
  V energy_j{0.0};

  Transfer& operator+=(const Transfer& other) {
    momentum += other.momentum;
    energy_i += other.energy_i;
    energy_j += other.energy_j;
    return *this;
  }
};

template <class V>
Transfer(V) -> Transfer<V>;
template <class V>
Transfer(V, V, V) -> Transfer<V>;

/// A sweep's order of pairs or the reverse of it.
enum class SweepOrder { forward, reverse };

/// Which order that is: one that pairs far apart may share, given by where particles are and by
/// their ids; or ascending ids (i, then j), which takes longer. In a small box, of less than four
/// ranges along every side, the first is the second.
enum class SweepSequence { coloured, by_ids };

/// What a pair sees of the internal energies in a sweep: the results of the pairs before it, or
/// those at the start of the sweep, to which all changes are added at its end.
enum class SweepEnergies { fresh, frozen };

/// Whether who asks for a trial end comes again to the same noise: it is then kept, 16 bytes a
/// pair, instead of drawn anew, and in a small system the geometry of the pairs too.
enum class Rounds { one, several };

/// How a sweep goes over the pairs.
struct Sweep {
  SweepOrder order = SweepOrder::forward;
  SweepSequence sequence = SweepSequence::coloured;
  Stage stage = {};  ///< which of a step's independent noises the pairs see
  SweepEnergies energies = SweepEnergies::fresh;
  bool uniforms = false;  ///< whether the uniform variates are drawn
};

}  // namespace driftless
