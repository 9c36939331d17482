#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>

#include "experiments/judge/limit_scenes.hpp"
#include "experiments/replica.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/timing.hpp"

// Fluids of few particles - the exact law holds for any number - in many replicas. Their friction
// is such that kinetic energy relaxes in one unit of time, and conduction such that it moves
// internal energy half as fast: where u relaxes slowly, equilibrium costs long runs.
namespace driftless::judge {
namespace {

using nlohmann::json;

/// A scene with its schedule.
struct Plan {
  Family family;
  Study study;  ///< of one scene, with the replicas of a block
  unsigned blocks = 1;
  double seconds_per_step = 0;
  std::uint64_t seed = 1;

  const Scene& scene() const { return study.scenes.front(); }
  unsigned runs() const {
    return study.replicas * blocks * static_cast<unsigned>(study.time_steps.size());
  }
};

/// The scene of a plan, prepared once however many parts ask for it, and kept as long as the
/// program runs.
const PreparedScene& prepared(const Plan& plan) {
  struct Entry {
    std::once_flag once;
    std::unique_ptr<PreparedScene> scene;
  };
  static std::mutex mutex;
  static std::map<std::string, Entry> entries;
  Entry* entry;
  {
    const std::lock_guard lock(mutex);
    entry = &entries[fmt::format("{} {} {}", to_json(plan.scene()).dump(), plan.seed, plan.runs())];
  }
  // The last replica of a prepared scene starts off equilibrium: one more than are run.
  std::call_once(entry->once, [&] {
    entry->scene = std::make_unique<PreparedScene>(plan.scene(), plan.seed, plan.runs() + 1);
  });
  return *entry->scene;
}

bool is_relative(Family family, std::string_view name) {
  for (const auto& known : limit_observables(family)) {
    if (known.name == name) return known.is_relative;
  }
  return false;
}

/// What a block of replicas found, as deviations from the exact values.
json observables_record(const Plan& plan, const std::vector<Record>& records,
                        const std::vector<unsigned>& replicas) {
  json result = json::object();
  for (const auto& observed : evaluate(prepared(plan), records, replicas).observed) {
    if (!observed.exact) continue;
    const double exact = observed.exact->value;
    const double scale = is_relative(plan.family, observed.name) ? std::abs(exact) : 1;
    const auto& found = observed.value;
    if (!std::isfinite(found.mean) || !std::isfinite(found.error)) continue;
    json entry = {{"value", (found.mean - exact) / scale},
                  {"error", found.error / student_factor(found.degrees_of_freedom) / scale},
                  {"reference_error", observed.exact->error / scale}};
    if (std::isfinite(found.degrees_of_freedom)) {
      entry["degrees_of_freedom"] = found.degrees_of_freedom;
    }
    result[std::string(observed.name)] = entry;
  }
  return result;
}

json run(const Plan& plan, const Candidate& candidate, double time_step, unsigned number) {
  std::vector<Record> records;
  std::vector<unsigned> survivors;
  json result = {{"runs", plan.study.replicas}};
  for (unsigned n = 0; n < plan.study.replicas; ++n) {
    const unsigned replica = number * plan.study.replicas + n;
    auto one = run_replica(prepared(plan), plan.study, candidate.choice, time_step, replica);
    if (const auto& failure = one.failure) {
      if (!result.contains("failure")) {
        result["failure"] = {
            {"cause", to_string(failure->cause)}, {"step", failure->step}, {"time", failure->time}};
      }
    } else {
      records.push_back(std::move(one.record));
      survivors.push_back(replica);
    }
  }
  result["failed"] = plan.study.replicas - records.size();
  result["observables"] = observables_record(plan, records, survivors);
  return result;
}

std::vector<double> seconds_per_time(const Plan& plan, const Candidate& candidate) {
  std::vector<TimedCell> cells;
  for (const double time_step : plan.study.time_steps) {
    cells.push_back({&prepared(plan), &candidate.choice, time_step});
  }
  std::vector<double> costs;
  for (const auto& cost : time_cells(cells)) {
    costs.push_back(cost.seconds / plan.study.time_steps[costs.size()]);
  }
  return costs;
}

/// Steps h, h/2, h/4 and h/16 for the limit, whose error is then mostly that of the finest step's
/// value, not much more of it, at less cost than by further halving; before them coarser ones, from
/// `factor` h on, which cost next to nothing and tell whether a method could be run with them.
std::vector<double> steps_from(double coarsest, int factor) {
  std::vector<double> steps;
  for (; factor > 1; factor /= 2) steps.push_back(coarsest * factor);
  for (const int divisor : {1, 2, 4, 16}) steps.push_back(coarsest / divisor);
  return steps;
}

constexpr unsigned fewest_replicas = 4;
constexpr unsigned full_blocks = 10;

/// Five relaxation times of the internal energies, then twenty with samples; as many replicas as a
/// block has seconds for, at all time steps together.
void schedule_within(Plan& plan, double seconds) {
  auto& study = plan.study;
  study.sample_every = study.time_steps.front();
  const double relaxation =
      std::max(relaxation_time(plan.scene()), kinetic_relaxation_time(plan.scene()));
  const auto whole = [&](double time) {
    return std::ceil(time / study.sample_every) * study.sample_every;
  };
  study.equilibrate = whole(5 * relaxation);
  study.measure = whole(20 * relaxation);
  double steps = 0;
  for (const double time_step : study.time_steps) {
    steps += (study.equilibrate + study.measure) / time_step;
  }
  const double replicas = seconds / (steps * plan.seconds_per_step);
  study.replicas = std::max(fewest_replicas, static_cast<unsigned>(std::lround(replicas)));
}

/// Depth quick spends `seconds`, depth full so many times as much in blocks that can be resumed.
void schedule(Plan& plan, double seconds, double full_effort, const Conditions& conditions) {
  const bool quick = conditions.depth == Depth::quick;
  plan.blocks = quick ? 1 : full_blocks;
  schedule_within(plan, quick ? seconds : seconds * full_effort / full_blocks);
}

/// By what depth quick resolves, depth full needs so many times its effort for five errors to stay
/// within the tolerances. Without conduction there are few independent internal energies.
double ideal_full_effort(double phi_over_k, bool conducts) {
  if (phi_over_k > 50) return conducts ? 8 : 60;
  if (phi_over_k > 10) return conducts ? 12 : 30;
  return conducts ? 32 : 20;
}

double weight_volume(const FluidParameters& fluid) {
  return 2 * std::numbers::pi / 15 * std::pow(fluid.friction_range, 3);
}

/// k, m and T differ from 1: a misplaced power shows.
FluidParameters ideal_parameters(double phi_over_k, FrictionClosure closure, bool conducts,
                                 double density) {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.mass = 2;
  f.temperature = 1.5;
  f.heat_capacity = phi_over_k * f.boltzmann;
  f.friction_closure = closure;
  const double weight = density * weight_volume(f);
  f.friction = 1.5 * f.mass / weight;
  if (!conducts) return f;
  f.heat_form = HeatForm::inverse_temperature;
  f.conduction = 0.5 * f.heat_capacity * f.temperature * f.temperature / weight;
  return f;
}

Plan ideal(double phi_over_k, FrictionClosure closure, bool conducts,
           const Conditions& conditions) {
  Scene scene;
  scene.density = 2;
  // Without conduction u takes 4 a/3 times as long to relax as the kinetic energy: few particles,
  // so that there is time for some replicas.
  const bool slow = !conducts && phi_over_k > 10;
  scene.particles = slow ? 50 : 100;
  scene.fluid = ideal_parameters(phi_over_k, closure, conducts, scene.density);
  scene.name = fmt::format("ideal fluid, {} closure, {} conduction, phi/k = {:g}",
                           to_string(closure), conducts ? "with" : "without", phi_over_k);
  Plan plan{conducts ? Family::conducting : Family::not_conducting,
            {},
            1,
            slow ? 8e-6 : 1.6e-5,
            conditions.seed};
  plan.study.scenes = {scene};
  // The less internal energy there is, the sooner a step's noise is larger.
  const double coarsest = phi_over_k > 50 ? 0.2 : phi_over_k > 10 ? 0.1 : 0.05;
  plan.study.time_steps = conducts ? steps_from(coarsest, 4) : steps_from(2 * coarsest, 2);
  schedule(plan, conducts ? 6 : 5, ideal_full_effort(phi_over_k, conducts), conditions);
  return plan;
}

Plan soft(FrictionClosure closure, const Conditions& conditions) {
  Scene scene = find_preset("soft-fluid")->scene;
  scene.particles = 200;
  auto& f = scene.fluid;
  f.friction_closure = closure;
  // Internal energies relax in half a unit of time, about as fast as the structure.
  f.conduction =
      2 * f.heat_capacity * f.temperature * f.temperature / (scene.density * weight_volume(f));
  scene.name = fmt::format("soft fluid, {} closure, phi/k = {:g}", to_string(closure),
                           f.heat_capacity / f.boltzmann);
  Plan plan{Family::soft, {}, 1, 6e-5, conditions.seed};
  plan.study.scenes = {scene};
  plan.study.time_steps = steps_from(0.04, 2);
  schedule(plan, 8, 20, conditions);
  return plan;
}

LimitScene limit_scene(const Plan& plan) {
  const auto& study = plan.study;
  LimitScene scene{plan.family,
                   plan.scene().name,
                   Fluid(plan.scene().fluid),
                   study.time_steps,
                   plan.blocks,
                   plan.seconds_per_step * (study.equilibrate + study.measure) * study.replicas,
                   {}};
  scene.run = [plan](const Candidate& candidate, double time_step, unsigned number) {
    return run(plan, candidate, time_step, number);
  };
  scene.seconds_per_time = [plan](const Candidate& candidate) {
    return seconds_per_time(plan, candidate);
  };
  return scene;
}

}  // namespace

std::vector<LimitScene> fluid_limit_scenes(const Conditions& conditions) {
  std::vector<LimitScene> all;
  for (const bool conducts : {true, false}) {
    for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
      for (const double phi_over_k : {100.0, 20.0, 5.0}) {
        all.push_back(limit_scene(ideal(phi_over_k, closure, conducts, conditions)));
      }
    }
  }
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    all.push_back(limit_scene(soft(closure, conditions)));
  }
  return all;
}

}  // namespace driftless::judge
