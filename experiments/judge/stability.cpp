#include <algorithm>
#include <cmath>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/stability_report.hpp"
#include "experiments/judge/stability_search.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

struct StabilityPlan {
  unsigned seeds = 6;
  double factor = 1.2;           ///< within which a step is found
  double shortest = 1.0 / 1000;  ///< step that is tried, in collision times
};

StabilityPlan plan_of(const Conditions& conditions) {
  if (conditions.depth == Depth::full) return {20, 1.1, 1.0 / 10000};
  return {};
}

StepRange step_range(const StabilityPoint& point, const StabilityPlan& plan) {
  const double time = collision_time(point);
  return {plan.shortest * time, time / 32, 10 * time, plan.factor};
}

/// The closure that the method is built for, `noise` rather than `friction`.
FrictionClosure closure_of(const Method& method) {
  const auto& closures = method.closures;
  const bool noise =
      std::find(closures.begin(), closures.end(), FrictionClosure::noise) != closures.end();
  return noise || closures.empty() ? FrictionClosure::noise : closures.front();
}

const std::vector<double>& values(const StabilityAxis& axis, Depth depth) {
  return depth == Depth::full ? axis.full : axis.quick;
}

StabilityPoint point_on(const StabilityAxis& axis, double value, StabilityPoint point = {}) {
  point.*axis.coordinate = value;
  return point;
}

/// The axes that are also varied together.
const StabilityAxis& heat_capacity_axis() { return stability_axes()[0]; }
const StabilityAxis& conduction_axis() { return stability_axes()[2]; }
StabilityPoint point_on_map(double heat_capacity, double conduction) {
  return point_on(conduction_axis(), conduction, point_on(heat_capacity_axis(), heat_capacity));
}

/// Every point once: the axes through the base, at depth full also heat capacity and conduction
/// together.
std::vector<StabilityPoint> points(Depth depth) {
  std::vector<StabilityPoint> all;
  const auto add = [&](const StabilityPoint& point) {
    if (std::find(all.begin(), all.end(), point) == all.end()) all.push_back(point);
  };
  for (const auto& axis : stability_axes()) {
    for (const double value : values(axis, depth)) add(point_on(axis, value));
  }
  if (depth == Depth::quick) return all;
  for (const double heat_capacity : heat_capacity_axis().quick) {
    for (const double conduction : conduction_axis().quick) {
      add(point_on_map(heat_capacity, conduction));
    }
  }
  return all;
}

json search(const Candidate& candidate, const StabilityPoint& point, const Conditions& conditions) {
  const auto plan = plan_of(conditions);
  const auto& method = candidate.method();
  json found = json::array();
  for (unsigned replica = 0; replica < plan.seeds; ++replica) {
    const auto start = stability_start(point, closure_of(method), conditions.seed, replica);
    bool negative = false;
    const auto failure = [&](double step) {
      auto cause = instability(method, candidate.choice.options, start, step);
      negative = negative || cause == to_string(FailureCause::negative_internal_energy);
      return cause;
    };
    const auto bracket = find_bracket(failure, step_range(point, plan));
    json record = {{"stable", bracket.stable}, {"cause", bracket.cause}, {"negative", negative}};
    if (std::isfinite(bracket.unstable)) record["unstable"] = bracket.unstable;
    found.push_back(record);
    if (bracket.stable == 0) break;  // without a step for one seed there is none for all
  }
  return found;
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> all;
  const Fluid base(stability_fluid({}, closure_of(candidate.method())));
  if (refusal(candidate.method(), base)) return all;
  const double cost = conditions.depth == Depth::full ? 10 : 1;
  for (const auto& point : points(conditions.depth)) {
    all.push_back({name_of(point), cost, [candidate, point, conditions] {
                     return search(candidate, point, conditions);
                   }});
  }
  return all;
}

bool never_negative(const Records& records) {
  for (const auto& [name, record] : records) {
    for (const auto& one : record) {
      if (one["negative"].get<bool>()) return false;
    }
  }
  return true;
}

Finding positivity() {
  Finding finding;
  finding.subject = "positivity";
  finding.verdict = Verdict::holds;
  finding.sentence =
      "No internal energy became negative in any fluid at any step tried, whatever the estimates "
      "of Mackie et al.";
  return finding;
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  const auto closure = closure_of(candidate.method());
  if (const auto reason = refusal(candidate.method(), Fluid(stability_fluid({}, closure)))) {
    return {{{"largest stable step", Verdict::not_applicable, *reason + "."}}};
  }
  const auto plan = plan_of(conditions);
  const auto look_up = [&](const StabilityPoint& point) {
    return threshold(point, step_range(point, plan).lowest, records.at(name_of(point)));
  };
  Conclusion conclusion;
  conclusion.findings.push_back(base_finding(look_up({}), closure));
  if (never_negative(records)) conclusion.findings.push_back(positivity());
  for (const auto& axis : stability_axes()) {
    std::vector<Threshold> found;
    for (const double value : values(axis, conditions.depth)) {
      found.push_back(look_up(point_on(axis, value)));
    }
    conclude_axis(axis, found, conclusion);
  }
  if (conditions.depth == Depth::full) {
    std::vector<std::vector<Threshold>> curves;
    for (const double conduction : conduction_axis().quick) {
      auto& curve = curves.emplace_back();
      for (const double heat_capacity : heat_capacity_axis().quick) {
        curve.push_back(look_up(point_on_map(heat_capacity, conduction)));
      }
    }
    conclusion.charts.push_back(map_chart(heat_capacity_axis(), conduction_axis(), curves));
  }
  std::vector<Threshold> all;
  for (const auto& point : points(conditions.depth)) all.push_back(look_up(point));
  conclusion.tables.push_back(threshold_table(all));
  return conclusion;
}

}  // namespace

const Examination stability{
    "stability", "Stability at the extremes",
    "How large may the step be, and what happens beyond? 125 particles start from the exact law "
    "and run for 20 collision times, 100 steps at least. A run is stable if no step fails, total "
    "energy never changes by as much as it was, and over the last half kinetic and internal energy "
    "have, on average, the values of the exact law to 20 %: a run that is bounded but has wrong "
    "temperatures is of no use. Steps go up by factors of two until a run is not stable, then the "
    "logarithm is bisected, for each of several seeds; reported are the typical step and, in "
    "brackets, the largest at which every seed is stable and the smallest at which none is. The "
    "base fluid is ideal: k = m = T = 1, ranges 1, phi/k = 60, zeta_0 = 4.5, L_0 = phi, density 3; "
    "one quantity is varied at a time, L_0/phi staying what it is when the heat capacity changes. "
    "Steps above ten collision times are not tried. Nothing is claimed of stability; `fails` says "
    "that no stable step was found. The estimates of Mackie et al. tell from which step on "
    "internal energies may become negative; their C is L_0/(phi T^2), their B is k/phi.",
    parts, conclude};

}  // namespace driftless::judge
