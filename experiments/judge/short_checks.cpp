#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "experiments/judge/short_paths.hpp"
#include "experiments/judge/wide_system.hpp"
#include "model/initial.hpp"

namespace driftless::judge {
namespace {

constexpr double boltzmann = 0.5;  // phi/k = 24
constexpr std::uint64_t wide_steps = 6;

using Difference = std::optional<double>;

FluidParameters fluid_of(const Terms& terms) { return small_fluid(terms, boltzmann); }

/// The state after the usual number of steps.
State path(const Trial& trial, const FluidParameters& fluid, const State& start) {
  return run(trial.method, fluid, start, short_step, short_steps, trial.seed, trial.options);
}

State usual_path(const Trial& trial, const Terms& terms) {
  return path(trial, fluid_of(terms), small_state(fluid_of(terms)));
}

System small_system(const Trial& trial, const Terms& terms, State start) {
  return System(Fluid(fluid_of(terms)), small_box(), std::move(start), Noise(trial.seed, 0));
}

/// 0 for the same bits, and for these alone.
double apart(const Box& box, const State& a, const State& b) {
  if (same_bits(a, b)) return 0;
  if (a.id != b.id) return 1;
  return std::max(distance(box, a, b).largest(), std::numeric_limits<double>::denorm_min());
}

// ---- Conservation. -----------------------------------------------------------------------------

Difference momentum_change(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  State start = small_state(f);
  boost_frame({0.3, -0.2, 0.5}, start);
  const State end = path(trial, f, start);
  Vector change = Vector::Zero();
  for (std::size_t i = 0; i < start.size(); ++i) {
    change += f.mass * (end.velocity[i] - start.velocity[i]);
  }
  return change.norm();
}

/// What a bath takes and gives nobody claims to keep.
Difference energy_change(const Trial& trial, const Terms& terms) {
  if (terms.isothermal) return {};
  System system = small_system(trial, terms, small_state(fluid_of(terms)));
  const double before = system.total_energy();
  const auto integrator = trial.method.make(trial.options);
  run(*integrator, system, short_step, 1, short_steps + 1);
  return std::abs(system.total_energy() / before - 1);
}

Difference ideal_energy_change(const Trial& trial, const Terms& terms) {
  return terms.potential ? Difference() : energy_change(trial, terms);
}

Difference energy_change_with_potential(const Trial& trial, const Terms& terms) {
  return terms.potential ? energy_change(trial, terms) : Difference();
}

// ---- Repetition. -------------------------------------------------------------------------------

Difference repeated(const Trial& trial, const Terms& terms) {
  return apart(small_box(), usual_path(trial, terms), usual_path(trial, terms));
}

Difference with_another_seed(const Trial& trial, const Terms& terms) {
  const Trial other{trial.method, trial.options, trial.seed + 1};
  return distance(small_box(), usual_path(trial, terms), usual_path(other, terms)).velocity;
}

/// Goes on from half way with what `before` keeps, or without it.
State restarted(const Trial& trial, const Terms& terms, bool loaded) {
  System first = small_system(trial, terms, small_state(fluid_of(terms)));
  const auto before = trial.method.make(trial.options);
  run(*before, first, short_step, 1, short_steps / 2 + 1);
  System second = small_system(trial, terms, first.state());
  const auto after = trial.method.make(trial.options);
  if (loaded) after->load(before->save());
  run(*after, second, short_step, short_steps / 2 + 1, short_steps + 1);
  run(*before, first, short_step, short_steps / 2 + 1, short_steps + 1);
  State end = second.state();
  if (loaded && after->save() != before->save()) end.internal_energy[0] += 1;  // is to be seen
  return end;
}

bool keeps_something(const Trial& trial, const Terms& terms) {
  System system = small_system(trial, terms, small_state(fluid_of(terms)));
  const auto integrator = trial.method.make(trial.options);
  run(*integrator, system, short_step, 1, 2);
  return !integrator->save().empty();
}

Difference after_restart(const Trial& trial, const Terms& terms) {
  return apart(small_box(), restarted(trial, terms, true), usual_path(trial, terms));
}

Difference after_forgetting(const Trial& trial, const Terms& terms) {
  if (!keeps_something(trial, terms)) return {};
  return apart(small_box(), restarted(trial, terms, false), usual_path(trial, terms));
}

// ---- Threads and places in memory, in a box of many tiles. -------------------------------------

/// The wide system has terms of its own.
bool is_wide(const Terms& terms) {
  return terms.potential && (terms.isothermal || terms.heat == HeatForm::temperature);
}

FluidParameters wide_fluid_of(const Terms& terms) {
  auto f = wide_fluid(terms.closure);
  f.isothermal = terms.isothermal;
  if (f.isothermal) f.heat_form = HeatForm::none;
  return f;
}

State wide_path(const Trial& trial, const FluidParameters& f, const State& start,
                unsigned threads) {
  System system = wide_system(f, start, threads);
  const auto integrator = trial.method.make(trial.options);
  run(*integrator, system, short_step, 1, wide_steps + 1);
  return system.state();
}

Difference on_threads(const Trial& trial, const Terms& terms) {
  if (!is_wide(terms)) return {};
  const auto f = wide_fluid_of(terms);
  const State start = wide_state(f), alone = wide_path(trial, f, start, 1);
  return std::max(apart(wide_box(), wide_path(trial, f, start, 2), alone),
                  apart(wide_box(), wide_path(trial, f, start, 4), alone));
}

Difference restarted_on_threads(const Trial& trial, const Terms& terms) {
  if (!is_wide(terms)) return {};
  const auto f = wide_fluid_of(terms);
  const State start = wide_state(f);
  System first = wide_system(f, start, 1);
  const auto before = trial.method.make(trial.options);
  run(*before, first, short_step, 1, wide_steps / 2 + 1);
  System second = wide_system(f, first.state(), 3);
  const auto after = trial.method.make(trial.options);
  after->load(before->save());
  run(*after, second, short_step, wide_steps / 2 + 1, wide_steps + 1);
  return apart(wide_box(), second.state(), wide_path(trial, f, start, 1));
}

Difference stored_otherwise_in_tiles(const Trial& trial, const Terms& terms) {
  if (!is_wide(terms)) return {};
  const auto f = wide_fluid_of(terms);
  const State start = wide_state(f);
  const auto order = shuffled_places(start.size(), 12);
  return apart(wide_box(), wide_path(trial, f, in_order(start, order), 1),
               in_order(wide_path(trial, f, start, 1), order));
}

// ---- Symmetries. -------------------------------------------------------------------------------

Difference stored_otherwise(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  const State start = small_state(f);
  const auto order = shuffled_places(start.size(), 3);
  const State end = path(trial, f, in_order(start, order));
  const State expected = in_order(path(trial, f, start), order);
  return end.id == expected.id ? distance(small_box(), end, expected).largest() : 1;
}

/// Other ids are another order of pairs. Without fluctuations, where ids name no noise, that is all
/// they are.
Difference renamed(const Trial& trial, const Terms& terms) {
  const auto f = small_fluid(terms, 0);
  State other = small_state(f);
  const auto order = shuffled_places(other.size(), 3);
  for (std::size_t i = 0; i < order.size(); ++i) other.id[i] = static_cast<std::uint32_t>(order[i]);
  return distance(small_box(), path(trial, f, other), path(trial, f, small_state(f))).largest();
}

using Turn = Vector (*)(const Vector&);

Vector quarter_turn(const Vector& r) { return {-r[1], r[0], r[2]}; }
Vector exchanged_axes(const Vector& r) { return {r[1], r[2], r[0]}; }

State turned(Turn turn, State state) {
  for (auto& position : state.position) position = small_box().wrap(turn(position));
  for (auto& velocity : state.velocity) velocity = turn(velocity);
  return state;
}

template <Turn turn>
Difference after_turn(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  const State end = path(trial, f, turned(turn, small_state(f)));
  return distance(small_box(), end, turned(turn, usual_path(trial, terms))).largest();
}

Difference translated(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  const Vector shift(0.77, 1.31, -0.4);
  State moved = small_state(f);
  for (auto& position : moved.position) position += shift;
  State end = path(trial, f, moved);
  for (auto& position : end.position) position -= shift;
  return distance(small_box(), end, usual_path(trial, terms)).largest();
}

Difference boosted(double thermal_velocities, const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  const double thermal = std::sqrt(f.boltzmann * f.temperature / f.mass);
  const Vector boost = thermal_velocities * thermal * Vector(1.7, -0.9, 2.3).normalized();
  State moving = small_state(f);
  boost_frame(boost, moving);
  State end = path(trial, f, moving);
  boost_frame(-boost, end);
  for (auto& position : end.position) {
    position -= boost * (short_step * static_cast<double>(short_steps));
  }
  return distance(small_box(), end, usual_path(trial, terms)).largest();
}

// ---- Steps of no length, few particles. --------------------------------------------------------

Difference after_no_time(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  const State start = small_state(f);
  return apart(small_box(), run(trial.method, f, start, 0, 3, trial.seed, trial.options), start);
}

State first_particles(State state, std::size_t count) {
  state.position.resize(count);
  state.velocity.resize(count);
  state.internal_energy.resize(count);
  state.id.resize(count);
  return state;
}

Difference alone(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  const State start = first_particles(small_state(f), 1);
  State expected = start;
  expected.position[0] += start.velocity[0] * (short_step * static_cast<double>(short_steps));
  return distance(small_box(), path(trial, f, start), expected).largest();
}

/// Two particles that meet for long, and where they end.
struct Meeting {
  State start, end;
};

Meeting meeting(const Trial& trial, const Terms& terms) {
  const auto f = fluid_of(terms);
  State start = first_particles(small_state(f), 2);
  start.position = {Vector(1, 1, 1), Vector(1.3, 1.2, 1)};
  for (auto& velocity : start.velocity) velocity *= 0.1;
  return {start,
          run(trial.method, f, start, short_step, 10 * short_steps, trial.seed, trial.options)};
}

Difference momentum_of_two(const Trial& trial, const Terms& terms) {
  const auto [start, end] = meeting(trial, terms);
  return (end.velocity[0] + end.velocity[1] - start.velocity[0] - start.velocity[1]).norm();
}

Difference exchange_of_two(const Trial& trial, const Terms& terms) {
  const auto [start, end] = meeting(trial, terms);
  return distance(small_box(), end, start).velocity;
}

}  // namespace

ShortCheck boost_check(double thermal_velocities) {
  const std::string speed = fmt::format("{:g} thermal velocit{}", thermal_velocities,
                                        thermal_velocities == 1 ? "y" : "ies");
  return {"the same noise at " + speed,
          "Internal energies and relative motion are those at rest, in a frame at " + speed,
          "Internal energies or relative motion change in a frame at " + speed,
          Alike::to_rounding,
          [=](const Trial& trial, const Terms& terms) {
            return boosted(thermal_velocities, trial, terms);
          },
          [](const Method& method) { return method.galilean; }};
}

const std::vector<ShortCheck>& short_checks() {
  const auto ideal = [](const Method& method) { return method.energy_ideal == EnergyClaim::exact; };
  const auto with_potential = [](const Method& method) {
    return method.energy_with_potential == EnergyClaim::exact;
  };
  const auto any_order = [](const Method& method) { return method.order_independent; };
  using enum Alike;
  static const std::vector<ShortCheck> all = {
      {"momentum", "Momentum is conserved", "Momentum is not conserved", to_rounding,
       momentum_change},
      {"total energy without a potential", "Total energy is conserved without a potential",
       "Total energy is not conserved to rounding without a potential", to_rounding,
       ideal_energy_change, ideal, false},
      {"total energy with a potential", "Total energy is conserved with a potential",
       "Total energy is not conserved to rounding with a potential", to_rounding,
       energy_change_with_potential, with_potential, false},
      {"repetition", "A second run takes the same path", "A second run takes another path", in_bits,
       repeated},
      {"another seed", "Another seed takes another path", "Another seed changes nothing",
       not_at_all, with_another_seed},
      {"restart", "A restart half way takes the same path", "A restart half way changes the path",
       in_bits, after_restart},
      {"what is saved", "What is saved at a restart is needed",
       "What is saved at a restart has no effect", not_at_all, after_forgetting},
      {"threads", "2 and 4 threads take the path of one",
       "2 or 4 threads take another path than one", in_bits, on_threads},
      {"restart on other threads", "A restart on other threads takes the same path",
       "A restart on other threads changes the path", in_bits, restarted_on_threads},
      {"order of storage in tiles", "The order of storage does not matter in a box of many tiles",
       "The order of storage matters in a box of many tiles", in_bits, stored_otherwise_in_tiles},
      {"order of storage", "The order of storage does not matter", "The order of storage matters",
       to_rounding, stored_otherwise},
      {"order of pairs", "Other ids, and so another order of pairs, change nothing without noise",
       "Other ids, and so another order of pairs, change the path without noise", to_rounding,
       renamed, any_order, false},
      {"quarter turn", "A quarter turn turns the path", "A quarter turn changes the path",
       to_rounding, after_turn<quarter_turn>},
      {"exchanged axes", "Axes exchanged in a circle turn the path",
       "Axes exchanged in a circle change the path", to_rounding, after_turn<exchanged_axes>},
      {"translation", "A translation moves the path", "A translation changes the path", to_rounding,
       translated},
      {"step of 0", "A step of 0 changes nothing", "A step of 0 changes the state", in_bits,
       after_no_time},
      {"one particle", "A particle alone flies freely", "A particle alone does not fly freely",
       to_rounding, alone},
      {"momentum of two", "Two particles keep their momentum",
       "Two particles change their momentum", to_rounding, momentum_of_two},
      {"two particles", "Two particles act on each other", "Two particles do not act on each other",
       not_at_all, exchange_of_two},
  };
  return all;
}

}  // namespace driftless::judge
