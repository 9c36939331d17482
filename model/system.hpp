#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "model/boundary_contacts.hpp"
#include "model/cell_grid.hpp"
#include "model/fluid.hpp"
#include "model/kernel.hpp"
#include "model/noise.hpp"
#include "model/pair_pass.hpp"
#include "model/pairs.hpp"
#include "model/state.hpp"
#include "model/threads.hpp"

namespace driftless {

/// What a system has done so far; the cost of a method in units that no machine changes.
struct Counters {
  std::uint64_t pair_evaluations = 0;
  std::uint64_t random_numbers = 0;
  std::uint64_t solver_iterations = 0;
};

/// N particles of a fluid in a box: the one interface through which integrators see the model.
/// Kernels say what a pair exchanges; how pairs are found, stored and visited is hidden here. Walls
/// and a field are partners of infinite mass in pairs like any other, so that kernels need not know
/// of them; what they receive stands in Motion::surroundings. In an isothermal fluid every internal
/// energy of the state is 0 and stays so: kernels see Fluid::bath_energy() in its place, and what
/// they, exchanges and updates give to it the bath takes.
class System {
 public:
  /// `frozen` particles keep their positions. Throws std::invalid_argument if the arrays differ in
  /// length, ids repeat, a species is none of the fluid's, walls or field make no sense, or the box
  /// is shorter than twice the range of the fluid.
  System(const Fluid& fluid, const Box& box, State state, const Noise& noise, bool frozen = false);

  const Fluid& fluid() const { return fluid_; }
  const Box& box() const { return box_; }
  const State& state() const { return state_; }
  const Motion& motion() const { return state_; }
  std::size_t size() const { return state_.size(); }
  /// Mass of the particle at a place in the state.
  double mass(std::size_t place) const { return fluid_.mass(state_.species_of(place)); }
  const EquationOfState& equation_of_state(std::size_t place) const {
    return fluid_.equation_of_state(state_.species_of(place));
  }
  bool frozen() const { return frozen_; }
  const Counters& counters() const { return counters_; }
  void count_solver_iteration() { ++counters_.solver_iterations; }

  /// Names the step whose noise the kernels see next.
  void set_step(std::uint64_t step) { noise_.set_step(step); }

  /// Puts particles that are near each other side by side in storage, in which they drift apart as
  /// they move: threads then share less memory. Arrays in the order of storage from before are void
  /// unless they follow().
  Places order_storage();

  /// How many threads work on this system, if there is work for as many at once; results are the
  /// same bits for any number.
  void set_threads(unsigned count);

  /// Has the passes over pairs measured from now on, at the price of looking at the clock.
  void measure_passes();
  /// What they took so far, summed over threads.
  PassSeconds pass_seconds() const;

  /// All pairs from the state as it stands: kernel(const Pair<V>&) -> Transfer<V>, summed per
  /// particle into `total`. `stage` chooses one of a step's independent noises. Kernels
  /// are pure and called for lanes of pairs, on any thread; one that takes Pair<double> alone is
  /// called pair by pair.
  template <class Kernel>
  void accumulate(const Kernel& kernel, Exchange& total, Stage stage = {}) {
    accumulate(PairKernel::of(kernel), {}, total, stage);
  }

  /// The same with a trial end of the step: kernel(const Pair<V>& start, const TrialPair<V>& end),
  /// both at the present positions and with the same noise. For implicit methods.
  template <class Kernel>
  void accumulate(const Motion& trial, const Kernel& kernel, Exchange& total, Stage stage = {},
                  Rounds rounds = Rounds::one) {
    accumulate(PairKernel::of_trial(kernel), {&trial, nullptr}, total, stage, rounds);
  }

  /// The same with the trial end to which a change of the present motion leads; `total` may be what
  /// holds it. For methods whose second visit sees the outcome of the first.
  template <class Kernel>
  void accumulate(const Exchange& change, const Kernel& kernel, Exchange& total, Stage stage = {}) {
    accumulate(PairKernel::of_trial(kernel), {nullptr, &change}, total, stage);
  }

  /// Pair after pair in the given order, each seeing the results of the ones before it:
  /// kernel(const Pair<V>&) -> Transfer<V>, applied at once. Throws StepFailure.
  template <class Kernel>
  void sweep(const Kernel& kernel, const Sweep& how = {}) {
    sweep(PairKernel::of(kernel), how);
  }

  /// Adds a share of an exchange to momenta and internal energies. Throws StepFailure.
  void apply(const Exchange& exchange, double share = 1);
  /// Gives the surroundings their share of an exchange, or of the conservative forces over a
  /// duration: for who adds the particles' by update().
  void give_surroundings(const Exchange& exchange, double share);
  void give_surroundings(double duration);
  /// Replaces velocities and internal energies. Throws StepFailure.
  void set_motion(const Motion& motion);
  /// The same, and hands out those that were there. Throws StepFailure.
  void swap_motion(Motion& motion);
  /// change(place, velocity, internal_energy) for every particle, on any thread. Throws
  /// StepFailure.
  template <class Change>
  void update(Change&& change);

  /// Momenta += conservative force x duration, the forces of the present positions (and energies).
  void kick(double duration);
  /// Positions += velocity x duration, reflected where walls stand; frozen particles stay. Where
  /// the repulsion follows the temperatures internal energies follow, eps' = eps chi(r')/chi(r): it
  /// is u that motion without friction leaves alone.
  void move(double duration) { move_along(state_.velocity, duration); }
  /// The same along other velocities than the present ones, which walls turn round all the same:
  /// for a method that moves with the velocities of a step's start when it has those of its end.
  void move_along(const std::vector<Vector>& velocity, double duration);

  /// Conservative force on each particle; computed once per set of positions, and of internal
  /// energies where the repulsion follows the temperatures.
  const std::vector<Vector>& conservative_force();
  /// Each particle's half of its pairs' potential energies, and all of those at walls and in a
  /// field; computed once per set of positions.
  const std::vector<double>& potential_shares();

  /// Each particle's share a_1 theta/(2 T) in the strength of its pairs' repulsion, theta =
  /// eps/(phi chi), and its chi (FluidParameters::thermal_repulsion). Empty if no repulsion follows
  /// the temperatures.
  const std::vector<double>& thermal_repulsion();
  const std::vector<double>& energy_factors();

  double kinetic_energy() const;
  double internal_energy() const;
  double potential_energy();
  double total_energy() { return kinetic_energy() + internal_energy() + potential_energy(); }
  Vector momentum() const;
  /// What fluid and surroundings have together, which is what is kept.
  double energy_with_surroundings() { return total_energy() + total(state_.surroundings).energy; }
  Vector momentum_with_surroundings() const {
    return momentum() + total(state_.surroundings).momentum;
  }

  /// A pair as it lies.
  struct Geometry {
    std::uint32_t i, j;  ///< places in the state, id[i] < id[j]
    Vector e;            ///< (r_i - r_j)/r
    double r, w_friction, w_heat;
    const PairLaw* law;  ///< of the pair's kind
  };
  /// Visits every pair within the fluid's range: visit(const Geometry&).
  void for_each_pair(FunctionReference<void(const Geometry&)> visit);

  /// Replaces the whole state (a restart, or particles taken out). Throws std::invalid_argument.
  void set_state(State state);

 private:
  /// A trial end of a step, if there is one: as it is, or by what leads to it.
  struct TrialEnd {
    const Motion* motion = nullptr;
    const Exchange* change = nullptr;
  };
  void accumulate(const PairKernel& kernel, const TrialEnd& trial, Exchange& total, Stage stage,
                  Rounds rounds = Rounds::one);
  void sweep(const PairKernel& kernel, const Sweep& how);
  void sweep_groups(PairPass& pass, const GroupedPairs& grouped, const PassParticles& particles,
                    const PairKernel& kernel, const Sweep& how, std::vector<std::uint32_t>& failed);
  void sweep_chunk(PairPass& pass, const GroupedPairs& grouped, std::size_t first,
                   std::size_t count, const PassParticles& particles, const PairKernel& kernel,
                   const Sweep& how, std::vector<std::uint32_t>& failed);
  void sweep_contacts(PairPass& pass, const BoundaryContacts::Group& group,
                      const PassParticles& particles, const PairKernel& kernel, const Sweep& how,
                      std::vector<std::uint32_t>& failed);
  /// Hands particles the motion that a sweep has left; false if one of them is not sound.
  bool take_motion(std::size_t begin, std::size_t end);
  void note_failed(const PairPass& pass, std::size_t from, std::size_t to,
                   std::vector<std::uint32_t>& failed) const;
  /// Makes cells, blocks and memory for as many particles and threads as there are.
  void cut_cells();
  /// follow(), in all threads.
  template <class Value>
  void bring_along(const Places& places, std::vector<Value>& values) const;
  void find_pairs();
  bool has_pairs() const { return pairs_version_ == positions_version_; }
  static constexpr auto nothing_to_prepare = [](std::size_t, std::size_t) {};
  /// Before pairs and contacts are found anew: memory, and then two phases of as many tasks as
  /// there are threads, with prepare(begin, end) for parts of the particles as soon as their order
  /// is known.
  void begin_search();
  void sort_particles(std::size_t phase, std::size_t task,
                      FunctionReference<void(std::size_t, std::size_t)> prepare);
  using PairAnswer = FunctionReference<void(PairPass&, PairBlock&, std::size_t, std::size_t)>;
  using ContactAnswer = FunctionReference<void(PairPass&, std::size_t, std::size_t)>;
  /// Sums what pairs, found before if they are not known, exchange, per particle: answer(pass,
  /// block, first, count) has the pass find it for a part of a block's pairs, after prepare(begin,
  /// end) for parts of the particles in the order of cells; and at_boundary(pass, boundary, count)
  /// for contacts with boundaries, if there is any.
  void sum(Exchange& total, PairAnswer answer,
           FunctionReference<void(std::size_t, std::size_t)> prepare = nothing_to_prepare,
           const ContactAnswer* at_boundary = nullptr);
  /// visit(pass, block, first, count) when the pass has taken a part of a block's pairs, of one
  /// kind and no more than stay in the cache.
  void for_each_run(PairPass& pass, PairBlock& block, PairAnswer visit);
  void visit_pairs(const PairPass& pass, std::size_t count,
                   FunctionReference<void(const Geometry&)> visit) const;
  /// answer(pass, boundary, count) when the pass has taken a part of a group of contacts.
  void for_each_contact_run(PairPass& pass, const BoundaryContacts::Group& group,
                            ContactAnswer answer);
  /// Leaves nothing behind of a visit that a kernel has broken off.
  void forget_sums();
  /// Hands particles their sums.
  void scatter_sums(Exchange& total, std::size_t begin, std::size_t end) const;
  /// Leaves zeros where there are no internal energies.
  void drop_if_isothermal(std::vector<double>& energies) const;
  void drop_if_isothermal(Surroundings& surroundings) const;
  /// Brings a position that a wall has been passed on the way to back inside, and turns the
  /// velocity round.
  Vector reflect(Vector position, std::size_t place, Surroundings& received);
  void check_species() const;
  /// Whether this noise of all pairs is kept.
  bool is_kept(Stage stage);
  /// Has a pass work in what is kept of a block.
  void work_in_kept(PairPass& pass, PairBlock& block, std::size_t first, Stage stage) const;
  bool keeps_geometry() const;
  void make_room(std::vector<Quadruple>& gathered) const;
  void gather_motion(const Motion& motion, std::vector<Quadruple>& gathered, std::size_t begin,
                     std::size_t end) const;
  void gather_trial(const TrialEnd& trial, std::size_t begin, std::size_t end);
  void count_visit(bool noise, bool uniforms);
  void renew_conservative();
  /// The factors chi of the present positions, and the force with what follows the temperatures.
  void renew_factors();
  void renew_thermal_force();
  /// Internal energies at the present positions from those that went with these factors.
  void follow_factors(const std::vector<double>& before);
  void for_each_particle(FunctionReference<void(std::size_t, std::size_t)> body) const {
    threads_.ranges(size(), body);
  }
  /// Whether a particle's velocity and internal energy are those of a particle.
  bool is_sound(std::size_t place) const {
    const double u = state_.internal_energy[place];
    const bool has_energy = u > 0 && u < std::numeric_limits<double>::infinity();
    return (has_energy || fluid_.isothermal()) &&
           std::isfinite(state_.velocity[place].squaredNorm());
  }
  void check() const;
  /// Throws for the particles that are not sound and for others, given by ids, whose energies were
  /// below zero in passing.
  [[noreturn]] void throw_failure(std::vector<std::uint32_t> in_passing = {}) const;

  Fluid fluid_;
  Box box_;
  State state_;
  Noise noise_;
  bool frozen_;
  unsigned wanted_threads_ = 1;
  Threads threads_;
  CellGrid cells_;
  PairBlocks pairs_;
  BoundaryContacts contacts_;
  std::vector<PairPass> passes_;  ///< one for each thread
  Counters counters_;
  bool measured_ = false;
  bool summing_ = false;  ///< whether the sums are in use, or a kernel has left them so
  std::uint64_t positions_version_ = 1;
  std::uint64_t pairs_version_ = 0;
  std::uint64_t conservative_version_ = 0;
  /// In the order of cells, and then by the numbers of the contacts' other sides.
  std::vector<Quadruple> motion_, trial_, frozen_motion_, sums_;
  std::vector<Quadruple> received_;  ///< in a sweep, by the contacts' other sides
  Exchange conservative_;            ///< forces, and shares in potential energies
  // Where the repulsion follows the temperatures.
  std::uint64_t energies_version_ = 1;
  std::uint64_t factors_version_ = 0;
  std::uint64_t thermal_positions_version_ = 0, thermal_energies_version_ = 0;
  std::vector<double> energy_factor_, thermal_repulsion_;
  Exchange thermal_;  ///< forces, all of them; and memory
};

template <class Change>
void System::update(Change&& change) {
  std::atomic<bool> sound = true;
  ++energies_version_;
  for_each_particle([&](std::size_t begin, std::size_t end) {
    bool all = true;
    for (std::size_t i = begin; i < end; ++i) {
      change(i, state_.velocity[i], state_.internal_energy[i]);
      if (fluid_.isothermal()) state_.internal_energy[i] = 0;
      all = all & is_sound(i);
    }
    if (!all) sound = false;
  });
  if (!sound) throw_failure();
}

}  // namespace driftless
