#include "experiments/cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftless {
namespace {

using nlohmann::json;

// Beyond this the replica started off equilibrium disagrees: with five observables compared, a
// chance of some 1 in 300,000 a cell.
constexpr double largest_agreeing_z = 5;

json curve_json(const Histogram& histogram) {
  json curve = {{"x", histogram.x}, {"density", histogram.density}, {"error", histogram.error}};
  if (!histogram.exact.empty()) curve["exact"] = histogram.exact;
  return curve;
}

std::string status_of(FailureCause cause) {
  switch (cause) {
    case FailureCause::non_finite:
    case FailureCause::energy_runaway:
      return "unstable";
    case FailureCause::negative_internal_energy:
      return "negative_internal_energy";
    case FailureCause::not_converged:
      return "not_converged";
  }
  throw std::logic_error("unknown failure cause");
}

/// Why an observable that relaxes with the kinetic or the internal energies is not to be trusted,
/// if so.
std::string unresolved_note(Relaxation relaxation, const PreparedScene& prepared,
                            const Study& study, const CellObservables& cell) {
  if (relaxation == Relaxation::none) return "";
  const bool internal = relaxation == Relaxation::internal_energy;
  if (!resolves(study, internal ? prepared.relaxation() : prepared.kinetic_relaxation())) {
    return fmt::format(
        "equilibration below 5 or measurement below 20 predicted relaxation times of the {} "
        "energies",
        internal ? "internal" : "kinetic");
  }
  if ((internal ? cell.largest_z : cell.kinetic_z) > largest_agreeing_z) {
    return "the replica started off equilibrium disagrees with the others";
  }
  return "";
}

json observable_json(const Observed& observed, const std::string& unresolved) {
  const auto& spec = observable_spec(observed.name);
  json entry = {{"mean", observed.value.mean},
                {"error", observed.value.error},
                {"effective_samples", observed.value.effective_samples},
                {"unit", spec.unit},
                {"status", "ok"}};
  if (observed.exact) {
    entry["exact"] = observed.exact->value;
    if (observed.exact->error > 0) entry["exact_error"] = observed.exact->error;
  }
  if (std::isfinite(observed.value.degrees_of_freedom)) {
    entry["degrees_of_freedom"] = observed.value.degrees_of_freedom;
  }
  if (observed.value.replicas_disagree) entry["replicas_disagree"] = true;
  if (const auto& limits = observed.interval) {
    entry["interval"] = {limits->first, limits->second};
  }
  if (!unresolved.empty()) {
    entry["status"] = "not_resolved";
    entry["note"] = unresolved;
  } else if (observed.value.replicas_disagree) {
    entry["note"] = "the error is from the scatter of the replicas, which exceeds that in time";
  }
  return entry;
}

json observables_of(const PreparedScene& prepared, const Study& study,
                    const CellObservables& cell) {
  json observables = json::object();
  for (const auto& observed : cell.observed) {
    // Too few survivors leave no error at all: then there is no measurement either.
    if (!std::isfinite(observed.value.mean) || !std::isfinite(observed.value.error)) continue;
    observables[std::string(observed.name)] = observable_json(
        observed,
        unresolved_note(observable_spec(observed.name).relaxation, prepared, study, cell));
  }
  return observables;
}

json mean_trace(const std::vector<Record>& records) {
  constexpr Eigen::Index points = 50;
  json trace = {{"time", json::array()}, {"energy", json::array()}};
  const Eigen::Index samples = records.front().energy.times.size();
  for (Eigen::Index n = 0; n < std::min(points, samples); ++n) {
    const Eigen::Index sample = (n + 1) * samples / std::min(points, samples) - 1;
    double sum = 0;
    for (const auto& record : records) sum += record.energy.energies[sample];
    trace["time"].push_back(records.front().energy.times[sample]);
    trace["energy"].push_back(sum / static_cast<double>(records.size()));
  }
  return trace;
}

json counts_of(const std::vector<ReplicaResult>& replicas) {
  Counters sum;
  std::uint64_t steps = 0;
  for (const auto& replica : replicas) {
    sum.pair_evaluations += replica.counters.pair_evaluations;
    sum.random_numbers += replica.counters.random_numbers;
    sum.solver_iterations += replica.counters.solver_iterations;
    steps += replica.steps;
  }
  const auto per_step = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(steps, 1));
  };
  return {{"pair_evaluations_per_step", per_step(sum.pair_evaluations)},
          {"random_numbers_per_step", per_step(sum.random_numbers)},
          {"solver_iterations_per_step", per_step(sum.solver_iterations)},
          {"steps", steps}};
}

json identity(const PreparedScene& prepared, const MethodChoice& choice, double time_step) {
  json record = {
      {"scene", prepared.scene().name},
      {"method", choice.name},
      {"options", to_json(choice.options)},
      {"time_step", time_step},
      {"consistent", is_consistent(*find_method(choice.name), choice.options, prepared.fluid())}};
  if (prepared.fluid().isothermal()) record["isothermal"] = true;
  return record;
}

}  // namespace

bool resolves(const Study& study, double relaxation_time) {
  const double rounding = 1 - 1e-12;
  return study.equilibrate >= 5 * relaxation_time * rounding &&
         study.measure >= 20 * relaxation_time * rounding;
}

std::string cell_status(const std::vector<ReplicaResult>& replicas) {
  for (const auto& replica : replicas) {
    if (replica.failure) return status_of(replica.failure->cause);
  }
  return "ok";
}

json cell_record(const PreparedScene& prepared, const Study& study, const MethodChoice& choice,
                 double time_step, const std::vector<ReplicaResult>& replicas) {
  std::vector<Record> records;
  std::vector<unsigned> survivors;
  json failures = json::array();
  for (const auto& replica : replicas) {
    if (const auto& failure = replica.failure) {
      failures.push_back({{"replica", failure->replica},
                          {"cause", to_string(failure->cause)},
                          {"step", failure->step},
                          {"time", failure->time}});
    } else {
      records.push_back(replica.record);
      survivors.push_back(replica.replica);
    }
  }
  const auto cell = evaluate(prepared, records, survivors);
  json record = identity(prepared, choice, time_step);
  record["status"] = cell_status(replicas);
  record["replicas"] = replicas.size();
  record["failed_replicas"] = failures.size();
  record["conditioned_on_survival"] = !failures.empty() && !records.empty();
  record["observables"] = observables_of(prepared, study, cell);
  record["failures"] = failures;
  if (cell.has_off_equilibrium) {
    record["off_equilibrium"] = {{"agrees", cell.largest_z <= largest_agreeing_z},
                                 {"largest_z", cell.largest_z},
                                 {"threshold", largest_agreeing_z},
                                 {"observable", cell.disagreeing}};
  }
  record["curves"] = json::object();
  if (!cell.momentum.x.empty()) record["curves"]["momentum"] = curve_json(cell.momentum);
  if (!cell.internal_energy.x.empty()) {
    record["curves"]["internal_energy"] = curve_json(cell.internal_energy);
  }
  if (!cell.radial_distribution.x.empty()) {
    record["curves"]["radial_distribution"] = curve_json(cell.radial_distribution);
  }
  if (!records.empty() && !prepared.fluid().isothermal()) {
    record["energy_trace"] = mean_trace(records);
  }
  record["cost"] = counts_of(replicas);
  return record;
}

json refused_cell(const PreparedScene& prepared, const MethodChoice& choice, double time_step,
                  const std::string& reason) {
  json record = identity(prepared, choice, time_step);
  record["status"] = "not_applicable";
  record["reason"] = reason;
  record["replicas"] = 0;
  record["failed_replicas"] = 0;
  record["conditioned_on_survival"] = false;
  record["observables"] = json::object();
  record["failures"] = json::array();
  record["curves"] = json::object();
  record["cost"] = counts_of({});
  return record;
}

}  // namespace driftless
