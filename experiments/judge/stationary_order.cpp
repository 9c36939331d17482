#include "experiments/judge/stationary_order.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "experiments/judge/observed_order.hpp"
#include "experiments/judge/two_body/measure.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;
using two_body::Moment;

constexpr double phi_over_k = 10;
/// Relaxation times; each half of the one before. A law that is claimed exact is asked at one.
constexpr std::array<double, 5> steps = {0.8, 0.4, 0.2, 0.1, 0.05};

struct Case {
  FrictionClosure closure;
  bool conducts;

  std::string pairs() const {
    return fmt::format("closure {}, {} conduction", to_string(closure),
                       conducts ? "with" : "without");
  }
  std::string name() const { return "stationary, " + pairs(); }
  two_body::Bench bench() const {
    return two_body::make_bench(phi_over_k, closure,
                                conducts ? HeatForm::inverse_temperature : HeatForm::none);
  }
  /// Without conduction nothing moves the difference of a pair's internal energies.
  std::vector<Moment> moments() const {
    if (!conducts) return {two_body::kinetic};
    return {two_body::kinetic, two_body::difference_2};
  }
};

std::vector<Case> cases(const Method& method) {
  std::vector<Case> all;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const bool conducts : {false, true}) {
      const Case one{closure, conducts};
      if (!refusal(method, one.bench().fluid)) all.push_back(one);
    }
  }
  return all;
}

std::string words(Moment moment) {
  return moment == two_body::kinetic ? "kinetic energy's share" : "variance of u_i - u_j";
}

/// Deviations at one step.
json rung(const Candidate& candidate, const Conditions& conditions, const Case& tested,
          double time_step, std::size_t ensembles) {
  two_body::Schedule run;
  run.dt = time_step;
  run.measure = 32;
  run.ensembles = ensembles;
  // Rungs are to be independent of each other.
  run.pairs.seed = conditions.seed ^ static_cast<std::uint64_t>(std::lround(1e6 * time_step)) << 32;
  json record = {{"time_step", time_step}};
  try {
    const auto outcome = two_body::measure(
        tested.bench(), [&] { return candidate.make(); }, run);
    record["failed"] = outcome.failed_fraction;
    for (const auto& deviation : outcome.deviations) {
      record["deviations"].push_back({deviation.mean, deviation.error});
    }
  } catch (const StepFailure& failure) {
    record["failed"] = 1.0;
    record["cause"] = failure.what();
  }
  return record;
}

/// Beyond so many failed copies those left are no longer a fair sample.
constexpr double few_failures = 1e-3;

bool usable(const json& rung) {
  return rung["failed"].get<double>() <= few_failures && rung.contains("deviations");
}

Deviation deviation(const json& rung, Moment moment) {
  const auto& measured = rung["deviations"][moment];
  return {rung["time_step"], measured[0], measured[1]};
}

/// The steps of a method's ladder, the largest first.
std::vector<double> steps_of(const Method& method) {
  if (method.pair_law_exact) return {steps.front()};
  return {steps.begin(), steps.end()};
}

std::string part_name(const Case& tested, double time_step) {
  return fmt::format("{}, step {:g}", tested.name(), time_step);
}

/// What is known of a case, the largest step first.
std::vector<json> rungs_of(const Candidate& candidate, const Case& tested, const Records& records) {
  std::vector<json> rungs;
  for (const double time_step : steps_of(candidate.method())) {
    rungs.push_back(records.at(part_name(tested, time_step)));
  }
  return rungs;
}

std::vector<Deviation> deviations(const std::vector<json>& rungs, Moment moment) {
  std::vector<Deviation> all;
  for (const auto& rung : rungs) {
    if (usable(rung)) all.push_back(deviation(rung, moment));
  }
  return all;
}

/// Three steps in a row, as small as can be while a quarter of the largest one's deviation is still
/// well known.
std::vector<Deviation> near_the_limit(std::vector<Deviation> all) {
  const auto well_known = [](const Deviation& one) { return std::abs(one.value) > 60 * one.error; };
  while (all.size() > 3 && well_known(all[1])) all.erase(all.begin());
  if (all.size() > 3) all.resize(3);
  return all;
}

Finding broken(const std::string& subject, const std::vector<json>& rungs) {
  const auto& rung = rungs.back();
  return {
      subject, Verdict::not_resolved,
      fmt::format("No order is seen: at the step {:g} a share of {:.2g} of the copies failed{}.",
                  rung["time_step"].get<double>(), rung["failed"].get<double>(),
                  rung.contains("cause") ? " (" + rung["cause"].get<std::string>() + ")" : "")};
}

/// Of a method to which the law of pairs is exact there is no order.
Finding exact_law(const std::string& subject, const std::string& what, const Deviation& found) {
  auto finding = zero_finding(subject, found.value, found.error, 0.05);
  finding.claimed = true;
  finding.sentence = fmt::format(
      "At the step {:g} the {} is off its exact law by {:.2g} (95 % interval {:.2g} to {:.2g}), "
      "relative: the law is claimed to be exact at any step, so that there is no order.",
      found.time_step, what, found.value, *finding.lower, *finding.upper);
  return finding;
}

Finding conclude(const Candidate& candidate, const Case& tested, Moment moment,
                 const std::vector<json>& rungs) {
  const auto what = words(moment);
  const auto subject = fmt::format("{}: {}", tested.name(), what);
  const auto found = near_the_limit(deviations(rungs, moment));
  const Method& method = candidate.method();
  if (found.empty() || (found.size() < 2 && !method.pair_law_exact)) return broken(subject, rungs);
  if (method.pair_law_exact) return exact_law(subject, what, found[0]);
  return claimed_order({subject, "the deviation of the " + what + " from its exact law", found},
                       method.weak_order);
}

}  // namespace

std::vector<Part> stationary_parts(const Candidate& candidate, const Conditions& conditions) {
  const std::size_t ensembles = conditions.depth == Depth::quick ? 400 : 2400;
  std::vector<Part> parts;
  for (const auto& tested : cases(candidate.method())) {
    for (const double time_step : steps_of(candidate.method())) {
      const double cost = 2e-4 * static_cast<double>(ensembles) / time_step;
      parts.push_back({part_name(tested, time_step), cost,
                       [=] { return rung(candidate, conditions, tested, time_step, ensembles); }});
    }
  }
  return parts;
}

void conclude_stationary(const Candidate& candidate, const Records& records,
                         Conclusion& conclusion) {
  Chart chart{"Deviations of isolated pairs from their exact law",
              {"step, relaxation times", true},
              {"relative deviation", true},
              {}};
  for (const auto& tested : cases(candidate.method())) {
    const auto rungs = rungs_of(candidate, tested, records);
    for (const auto moment : tested.moments()) {
      conclusion.findings.push_back(conclude(candidate, tested, moment, rungs));
      chart.series.push_back(
          order_series(words(moment) + ", " + tested.pairs(), deviations(rungs, moment)));
    }
  }
  conclusion.charts.push_back(std::move(chart));
}

}  // namespace driftless::judge
