#pragma once

#include <cstdint>
#include <vector>

#include "model/fluid.hpp"
#include "model/noise.hpp"
#include "model/pairs.hpp"
#include "model/state.hpp"

namespace driftless {

/// What a system has done so far; the cost of a method in units that no machine changes.
struct Counters {
  std::uint64_t pair_evaluations = 0;
  std::uint64_t random_numbers = 0;
  std::uint64_t solver_iterations = 0;
};

/// N particles of a fluid in a periodic box: the one interface through which integrators see the
/// model. Kernels say what a pair exchanges; how pairs are found, stored and visited is hidden
/// here.
class System {
 public:
  /// `frozen` particles keep their positions. Throws std::invalid_argument if the arrays differ in
  /// length, ids repeat, or the box is shorter than twice the range of the fluid.
  System(const Fluid& fluid, const Box& box, State state, const Noise& noise, bool frozen = false);

  const Fluid& fluid() const { return fluid_; }
  const Box& box() const { return box_; }
  const State& state() const { return state_; }
  const Motion& motion() const { return state_; }
  std::size_t size() const { return state_.size(); }
  bool frozen() const { return frozen_; }
  const Counters& counters() const { return counters_; }
  void count_solver_iteration() { ++counters_.solver_iterations; }

  /// Names the step whose noise the kernels see next.
  void set_step(std::uint64_t step) { noise_.set_step(step); }

  /// All pairs from the state as it stands: kernel(const Pair<double>&) -> Transfer<double>, summed
  /// per particle into `total`. `stage` (0 to 255) chooses one of a step's independent noises.
  template <class Kernel>
  void accumulate(Kernel&& kernel, Exchange& total, unsigned stage = 0);

  /// The same with a trial end of the step: kernel(const Pair& start, const TrialPair& end), both
  /// at the present positions and with the same noise. For implicit methods.
  template <class Kernel>
  void accumulate(const Motion& trial, Kernel&& kernel, Exchange& total, unsigned stage = 0);

  /// Pair after pair in the given order, each seeing the results of the ones before it:
  /// kernel(const Pair<V>&) -> Transfer<V>, applied at once. Throws StepFailure.
  template <class Kernel>
  void sweep(Kernel&& kernel, const Sweep& how = {});

  /// Adds an exchange to momenta and internal energies. Throws StepFailure.
  void apply(const Exchange& exchange);
  /// Replaces velocities and internal energies. Throws StepFailure.
  void set_motion(const Motion& motion);
  /// change(place, velocity, internal_energy) for every particle. Throws StepFailure.
  template <class Change>
  void update(Change&& change);

  /// Momenta += conservative force x duration, the forces of the present positions.
  void kick(double duration);
  /// Positions += velocity x duration; frozen particles stay.
  void move(double duration);

  /// Conservative force on each particle; computed once per set of positions.
  const std::vector<Vector>& conservative_force();
  /// Each particle's half of its pairs' potential energies; computed once per set of positions.
  const std::vector<double>& potential_shares();

  double kinetic_energy() const;
  double internal_energy() const;
  double potential_energy();
  double total_energy() { return kinetic_energy() + internal_energy() + potential_energy(); }
  Vector momentum() const;

  /// Visits every pair within the fluid's range: visit(const PairList::Geometry&).
  template <class Visit>
  void for_each_pair(Visit&& visit);

  /// Replaces the whole state (a restart, or particles taken out). Throws std::invalid_argument.
  void set_state(State state);

 private:
  PairList& up_to_date_pairs();
  PairList& pairs_with_noise(unsigned stage);
  Pair<double> pair_state(const PairList& pairs, std::size_t pair) const;
  static void add(const PairList::Geometry& geometry, const Transfer<double>& transfer,
                  Exchange& total);
  void renew_conservative();
  void check(const std::vector<std::uint32_t>& failed = {}) const;

  Fluid fluid_;
  Box box_;
  State state_;
  Noise noise_;
  bool frozen_;
  PairList pairs_;
  Counters counters_;
  std::uint64_t positions_version_ = 1;
  std::uint64_t conservative_version_ = 0;
  std::vector<Vector> force_;
  std::vector<double> potential_share_;
};

inline Pair<double> System::pair_state(const PairList& pairs, std::size_t pair) const {
  const auto& g = pairs.geometry(pair);
  const auto& normals = pairs.normals(pair);
  return {g.r,
          g.w_friction,
          g.w_heat,
          (state_.velocity[g.i] - state_.velocity[g.j]).dot(g.e),
          state_.internal_energy[g.i],
          state_.internal_energy[g.j],
          normals.friction,
          normals.heat};
}

inline void System::add(const PairList::Geometry& g, const Transfer<double>& transfer,
                        Exchange& total) {
  const Vector momentum = transfer.momentum * g.e;
  total.momentum[g.i] += momentum;
  total.momentum[g.j] -= momentum;
  total.energy[g.i] += transfer.energy_i;
  total.energy[g.j] += transfer.energy_j;
}

template <class Kernel>
void System::accumulate(Kernel&& kernel, Exchange& total, unsigned stage) {
  const PairList& pairs = pairs_with_noise(stage);
  total.reset(size());
  for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
    add(pairs.geometry(pair), kernel(pair_state(pairs, pair)), total);
  }
  counters_.pair_evaluations += pairs.size();
}

template <class Kernel>
void System::accumulate(const Motion& trial, Kernel&& kernel, Exchange& total, unsigned stage) {
  const PairList& pairs = pairs_with_noise(stage);
  total.reset(size());
  for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
    const auto& g = pairs.geometry(pair);
    const Pair<double> start = pair_state(pairs, pair);
    TrialPair<double> end{start, 0, 0};
    end.dv_i = (trial.velocity[g.i] - state_.velocity[g.i]).dot(g.e);
    end.dv_j = (trial.velocity[g.j] - state_.velocity[g.j]).dot(g.e);
    end.v = start.v + (end.dv_i - end.dv_j);
    end.u_i = trial.internal_energy[g.i];
    end.u_j = trial.internal_energy[g.j];
    add(g, kernel(start, end), total);
  }
  counters_.pair_evaluations += pairs.size();
}

template <class Kernel>
void System::sweep(Kernel&& kernel, const Sweep& how) {
  const PairList& pairs = pairs_with_noise(how.stage);
  const double inverse_mass = 1 / fluid_.mass();
  std::vector<std::uint32_t> failed;
  std::vector<double> end;
  if (how.energies == SweepEnergies::frozen) end = state_.internal_energy;
  auto& energies = how.energies == SweepEnergies::frozen ? end : state_.internal_energy;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const std::size_t pair = how.order == SweepOrder::forward ? n : pairs.size() - 1 - n;
    const auto& g = pairs.geometry(pair);
    Pair<double> seen = pair_state(pairs, pair);
    if (how.uniforms) {
      const auto uniforms = noise_.pair_uniforms(state_.id[g.i], state_.id[g.j], how.stage);
      seen.uniform = uniforms.friction;
      seen.heat_uniform = uniforms.heat;
      counters_.random_numbers += 2;
    }
    const Transfer<double> transfer = kernel(seen);
    const Vector change = transfer.momentum * inverse_mass * g.e;
    state_.velocity[g.i] += change;
    state_.velocity[g.j] -= change;
    double& u_i = energies[g.i];
    double& u_j = energies[g.j];
    u_i += transfer.energy_i;
    u_j += transfer.energy_j;
    // A later pair could lift an energy above zero again: a fault in passing is a fault.
    if (u_i <= 0) failed.push_back(g.i);
    if (u_j <= 0) failed.push_back(g.j);
  }
  if (how.energies == SweepEnergies::frozen) state_.internal_energy = std::move(end);
  counters_.pair_evaluations += pairs.size();
  check(failed);
}

template <class Change>
void System::update(Change&& change) {
  for (std::size_t i = 0; i < size(); ++i) {
    change(i, state_.velocity[i], state_.internal_energy[i]);
  }
  check();
}

template <class Visit>
void System::for_each_pair(Visit&& visit) {
  const PairList& pairs = up_to_date_pairs();
  for (std::size_t pair = 0; pair < pairs.size(); ++pair) visit(pairs.geometry(pair));
}

}  // namespace driftless
