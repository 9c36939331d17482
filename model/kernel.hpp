#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

#include "model/lanes.hpp"
#include "model/pair.hpp"

namespace driftless {

/// What kernels see of many pairs and what they answer, quantity by quantity. The arrays of one
/// object are parts of one piece of memory, each padded to whole lanes of any processor.
struct PairArrays {
  const PairLaw* law;  ///< of all these pairs
  bool common_laws;  ///< whether kernels meet no laws but common ones, the first species' included
  double *r, *w_friction, *w_heat, *v, *u_i, *u_j, *noise, *heat_noise, *uniform, *heat_uniform;
  double *trial_v, *trial_u_i, *trial_u_j, *trial_dv_i, *trial_dv_j;
  double *momentum, *energy_i, *energy_j;  ///< the answer
  double *e_x, *e_y, *e_z;

  /// The pair, or the lanes of pairs, from place n on.
  template <class V>
  Pair<V> pair(std::size_t n) const {
    return {load<V>(r + n),
            load<V>(w_friction + n),
            load<V>(w_heat + n),
            load<V>(v + n),
            load<V>(u_i + n),
            load<V>(u_j + n),
            load<V>(noise + n),
            load<V>(heat_noise + n),
            load<V>(uniform + n),
            load<V>(heat_uniform + n),
            law};
  }
  template <class V>
  TrialPair<V> trial_pair(std::size_t n) const {
    TrialPair<V> end{pair<V>(n), load<V>(trial_dv_i + n), load<V>(trial_dv_j + n)};
    end.v = load<V>(trial_v + n);
    end.u_i = load<V>(trial_u_i + n);
    end.u_j = load<V>(trial_u_j + n);
    return end;
  }
  template <class V>
  void answer(std::size_t n, const Transfer<V>& transfer) const {
    store(transfer.momentum, momentum + n);
    store(transfer.energy_i, energy_i + n);
    store(transfer.energy_j, energy_j + n);
  }

 private:
  template <class V>
  static V load(const double* from) {
    if constexpr (std::is_same_v<V, double>) {
      return *from;
    } else {
      return V::load(from);
    }
  }
  static void store(double value, double* to) { *to = value; }
  template <class V>
  static void store(const V& values, double* to) {
    values.store(to);
  }
};

/// A kernel of any type, run over arrays of pairs: in lanes, or one by one if it takes no lanes.
class PairKernel {
 public:
  /// kernel(const Pair<V>&) -> Transfer<V>
  template <class Kernel>
  static PairKernel of(const Kernel& kernel) {
    return {&kernel, run_all<Kernel>};
  }
  /// kernel(const Pair<V>& start, const TrialPair<V>& end) -> Transfer<V>
  template <class Kernel>
  static PairKernel of_trial(const Kernel& kernel) {
    return {&kernel, run_all_trials<Kernel>};
  }

  /// The answers for the pairs [from, to); to whole lanes beyond.
  void run(const PairArrays& arrays, std::size_t from, std::size_t to) const {
    run_(kernel_, arrays, from, to);
  }

 private:
  using Run = void (*)(const void*, const PairArrays&, std::size_t, std::size_t);
  PairKernel(const void* kernel, Run how) : kernel_(kernel), run_(how) {}
  template <class V>
  static constexpr std::size_t width() {
    if constexpr (std::is_same_v<V, double>) {
      return 1;
    } else {
      return V::count();
    }
  }

  template <class Kernel>
  static void run_all(const void* called, const PairArrays& arrays, std::size_t from,
                      std::size_t to) {
    const auto& kernel = *static_cast<const Kernel*>(called);
    if constexpr (!std::is_invocable_v<Kernel, Pair<Lanes>>) {
      loop<double>(kernel, arrays, from, to);
    } else if (arrays.common_laws) {
      loop<CommonLanes>(kernel, arrays, from, to);
    } else {
      loop<Lanes>(kernel, arrays, from, to);
    }
  }
  template <class Kernel>
  static void run_all_trials(const void* called, const PairArrays& arrays, std::size_t from,
                             std::size_t to) {
    const auto& kernel = *static_cast<const Kernel*>(called);
    if constexpr (!std::is_invocable_v<Kernel, Pair<Lanes>, TrialPair<Lanes>>) {
      loop_of_trials<double>(kernel, arrays, from, to);
    } else if (arrays.common_laws) {
      loop_of_trials<CommonLanes>(kernel, arrays, from, to);
    } else {
      loop_of_trials<Lanes>(kernel, arrays, from, to);
    }
  }

  // Flattened: a kernel is made of small functions, and the loop around it is hot. Not inlined: the
  // loops would compete for registers.
  template <class V, class Kernel>
  [[gnu::flatten, gnu::noinline]] static void loop(const Kernel& kernel, const PairArrays& arrays,
                                                   std::size_t from, std::size_t to) {
    for (std::size_t n = from; n < to; n += width<V>()) {
      arrays.answer<V>(n, kernel(arrays.pair<V>(n)));
    }
  }
  template <class V, class Kernel>
  [[gnu::flatten, gnu::noinline]] static void loop_of_trials(const Kernel& kernel,
                                                             const PairArrays& arrays,
                                                             std::size_t from, std::size_t to) {
    for (std::size_t n = from; n < to; n += width<V>()) {
      arrays.answer<V>(n, kernel(arrays.pair<V>(n), arrays.trial_pair<V>(n)));
    }
  }

  const void* kernel_;
  Run run_;
};

}  // namespace driftless
