#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "experiments/judge/drift_findings.hpp"
#include "experiments/judge/examinations.hpp"
#include "experiments/statistics.hpp"

/// The law of the energy drift (see drift_prediction.hpp) in a soft fluid without conduction.
namespace driftless::judge {
namespace {

using nlohmann::json;
using Setting = DriftSetting;
using Measured = MeasuredDrift;

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  const auto& method = candidate.method();
  if (method.energy_with_potential == EnergyClaim::exact || drift_refusal(method)) return {};
  std::vector<Part> all;
  for (const auto& setting : drift_settings(conditions.depth)) {
    all.push_back({setting.name(), drift_cost(setting, conditions.depth),
                   [=] { return run_drift(candidate, conditions, setting); }});
  }
  return all;
}

// ---- conclusions

template <class Wanted>
std::vector<Measured> those(const std::vector<Measured>& all, Wanted&& wanted) {
  std::vector<Measured> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [&](const Measured& one) { return wanted(one.setting); });
  return some;
}

std::vector<Measured> along_steps(const std::vector<Measured>& all, double capacity,
                                  double friction = usual_friction) {
  return those(all, [=](const Setting& setting) {
    return setting.heat_capacity == capacity && setting.friction == friction && !setting.brief;
  });
}

std::vector<Measured> along_frictions(const std::vector<Measured>& all) {
  return those(all, [](const Setting& setting) {
    return setting.heat_capacity == usual_capacity && setting.time_step == usual_step;
  });
}

std::vector<Measured> of_brief_runs(const std::vector<Measured>& all) {
  return those(all, [](const Setting& setting) { return setting.brief; });
}

Series series_of(const std::string& name, const std::vector<Measured>& all,
                 double (*variable)(const Setting&)) {
  Series series{name, {}};
  for (const auto& one : all) {
    series.points.push_back({variable(one.setting), one.drift,
                             one.drift - interval_quantile * one.error,
                             one.drift + interval_quantile * one.error});
  }
  return series;
}

Series theory_of(const std::string& name, const std::vector<Measured>& all,
                 double (*variable)(const Setting&), double Measured::*theory) {
  Series series{name, {}, Marks::line};
  for (const auto& one : all) series.points.push_back({variable(one.setting), one.*theory});
  return series;
}

double step_of(const Setting& setting) { return setting.time_step; }
double friction_of(const Setting& setting) { return setting.friction; }

std::vector<Chart> charts(const std::vector<Measured>& all) {
  const auto large = along_steps(all, usual_capacity), small = along_steps(all, small_capacity);
  const auto frictional = along_frictions(all);
  const Axis drift = {"energy drift, kT per particle and unit of time", true};
  return {
      {"Energy drift against step",
       {"time step", true},
       drift,
       {series_of(fmt::format("phi/k = {:g}", usual_capacity), large, step_of),
        series_of(fmt::format("phi/k = {:g}", small_capacity), small, step_of),
        series_of(fmt::format("phi/k = {:g}, brief", usual_capacity), of_brief_runs(all), step_of),
        theory_of("theory: kick, move, kick", large, step_of, &Measured::kick_move_kick),
        theory_of("theory: move, kick, move", large, step_of, &Measured::move_kick_move)}},
      {fmt::format("Energy drift against friction at step {:g}", usual_step),
       {"friction", true},
       drift,
       {series_of(fmt::format("phi/k = {:g}", usual_capacity), frictional, friction_of),
        theory_of("theory: kick, move, kick", frictional, friction_of, &Measured::kick_move_kick),
        theory_of("theory: move, kick, move", frictional, friction_of,
                  &Measured::move_kick_move)}}};
}

/// A method without parts, and why.
Conclusion without_drift(const Candidate& candidate) {
  Finding finding;
  finding.subject = "energy drift";
  finding.verdict = Verdict::not_applicable;
  const auto refused = drift_refusal(candidate.method());
  finding.sentence =
      refused ? *refused : "The method conserves energy to rounding, with a potential too.";
  return {{finding}};
}

std::vector<Finding> failures(const Conditions& conditions, const Records& records) {
  std::vector<Finding> findings;
  for (const auto& setting : drift_settings(conditions.depth)) {
    const auto found = records.find(setting.name());
    if (found == records.end() || found->second["failures"].empty()) continue;
    const auto& causes = found->second["failures"];
    findings.push_back({setting.name(), Verdict::reported,
                        fmt::format("{} of {} runs broke, the first by: {}.", causes.size(),
                                    drift_replicas(), causes[0].get<std::string>())});
  }
  return findings;
}

Conclusion every_run_broke(const Conditions& conditions, const Records& records) {
  Conclusion conclusion;
  conclusion.findings = failures(conditions, records);
  conclusion.findings.insert(
      conclusion.findings.begin(),
      {"energy drift", Verdict::not_resolved,
       "In every setting over a quarter of the runs broke: there is no drift to speak of."});
  return conclusion;
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  if (records.empty()) return without_drift(candidate);
  const Method& method = candidate.method();
  const bool by_verlet_alone = method.energy_ideal == EnergyClaim::exact;
  const bool theory_applies = by_verlet_alone && method.pair_law_exact;
  const auto all = measured_drifts(conditions.depth, records);
  if (all.empty()) return every_run_broke(conditions, records);
  const auto large = along_steps(all, usual_capacity), small = along_steps(all, small_capacity);
  const auto still = along_steps(all, usual_capacity, 0);
  Conclusion conclusion;
  conclusion.findings = {
      sign_finding(all, theory_applies),
      power_finding(fmt::format("power of the step, phi/k = {:g}", usual_capacity), "the step",
                    large, step_of, 4, theory_applies),
      power_finding(fmt::format("power of the step, phi/k = {:g}", small_capacity), "the step",
                    small, step_of, 4, theory_applies),
      power_finding("power of the friction", "the friction", along_frictions(all), friction_of, 1,
                    false),
      frictionless_finding(along_frictions(all)),
      power_finding("power of the step without friction", "the step, without friction", still,
                    step_of, 4, false),
      brief_finding(of_brief_runs(all)),
      prefactor_finding(large),
      fluctuation_finding(all, theory_applies)};
  if (by_verlet_alone) {
    conclusion.findings.push_back(bias_finding(large, small, method.pair_law_exact));
  }
  for (auto& finding : failures(conditions, records)) conclusion.findings.push_back(finding);
  conclusion.charts = charts(all);
  return conclusion;
}

}  // namespace

const Examination drift = {
    "drift", "Law of the energy drift",
    "How does the total energy of a soft fluid (a = 25, density 3, closure noise, no conduction) "
    "drift? For methods whose friction keeps energy and the exact law, theory says that the drift "
    "is the Verlet step's alone: positive, of fourth order in the step, with a variance of 2 kT "
    "times the mean, and in proportion to a weak friction; its size is worked out from "
    "configurations, without any integrator. Such methods are held to it; of the others the same "
    "numbers are reported, and of all the power of the friction, which is not weak here. Methods "
    "whose friction keeps energy but not the law are fitted with a further term of third order in "
    "the step and first in k/phi. Brief runs of small steps measure methods that heat up too fast "
    "for the usual ones. Where at most a quarter of a setting's runs break, the others are what is "
    "measured.",
    parts, conclude};

}  // namespace driftless::judge
