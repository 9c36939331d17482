#include "experiments/judge/energy_ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>

#include "experiments/energy_drift.hpp"
#include "experiments/judge/conclusion.hpp"
#include "experiments/order_fit.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double sample_every = 0.04;
/// Velocities and places forget within it that the start knew nothing of the step.
constexpr double settle = 0.48;
/// Relative changes of total energy up to here are rounding.
constexpr double kept = 1e-10;
/// A system that has gained more of its energy drifts otherwise than it would at its temperature.
constexpr double much_changed = 0.1;

struct Trace {
  std::vector<double> times, energies;
};

json drift_of(const std::vector<Trace>& traces, double particles, double thermal) {
  std::vector<EnergyTrace> all;
  for (const auto& trace : traces) {
    const auto count = static_cast<Eigen::Index>(trace.times.size());
    all.push_back({Eigen::VectorXd::Map(trace.times.data(), count),
                   Eigen::VectorXd::Map(trace.energies.data(), count)});
  }
  const auto found = energy_drift(all);
  const double unit = particles * thermal, walk = particles * thermal * thermal;
  return {{"drift", {{"value", found.slope.mean / unit}, {"error", found.slope.error / unit}}},
          {"walk", {{"value", found.walk.value / walk}, {"error", found.walk.error / walk}}}};
}

/// What is measured of the drift or the walk.
struct Quantity {
  const char* key;
  const char* words;
  const char* unit;
};
constexpr Quantity drift = {"drift", "mean drift", "kT"};
constexpr Quantity walk = {"walk", "random walk", "(kT)^2"};

/// "0.13 +- 0.02 kT per particle and unit time at step 0.01".
std::string size_words(const Quantity& what, const Deviation& one) {
  return fmt::format("{:.2g} +- {:.1g} {} per particle and unit time at step {:g}", one.value,
                     interval_quantile * one.error, what.unit, one.time_step);
}

/// Those that an order can be seen in: sure, of one sign, and of systems that their drift has not
/// yet changed much.
std::vector<Deviation> usable(const std::vector<Deviation>& found,
                              const std::vector<double>& changes) {
  const auto sureness = [](const Deviation& one) { return std::abs(one.value) / one.error; };
  std::vector<Deviation> sure;
  double surest = 0, sign = 0;
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (changes[n] > much_changed || !(sureness(found[n]) > 3)) continue;
    sure.push_back(found[n]);
    if (sureness(found[n]) < surest) continue;
    surest = sureness(found[n]);
    sign = found[n].value;
  }
  std::erase_if(sure, [&](const Deviation& one) { return one.value * sign < 0; });
  return sure;
}

/// The order in the step, or the sizes that do not give one.
Finding order_finding(const std::string& name, const Quantity& what,
                      const std::vector<json>& rungs) {
  std::vector<Deviation> found;
  std::vector<double> changes;
  for (const auto& rung : rungs) {
    if (!rung.contains(what.key)) continue;
    const auto& one = rung[what.key];
    found.push_back({rung["time_step"], one["value"], one["error"]});
    changes.push_back(rung["largest_change"]);
  }
  Finding finding;
  finding.subject = fmt::format("order of the {} of energy, {}", what.words, name);
  const auto fit = fit_order(usable(found, changes));
  if (found.empty()) {
    finding.sentence =
        fmt::format("{}: too few runs came to their end for a {} of energy.", name, what.words);
  } else if (!fit || !std::isfinite(fit->error)) {
    finding.sentence = fmt::format(
        "{}: the {} of energy stands out of the noise at too few steps for an order; "
        "it is {}.",
        name, what.words, size_words(what, found.front()));
  } else {
    const double width = interval_quantile * fit->error;
    finding.value = fit->order;
    finding.lower = fit->order - width;
    finding.upper = fit->order + width;
    finding.sentence = fmt::format(
        "{}: the {} of energy is of order {:.2f} ({:.2f} to {:.2f}) in the step; it is {}.", name,
        what.words, fit->order, *finding.lower, *finding.upper, size_words(what, found.back()));
  }
  return finding;
}

}  // namespace

ShareInterval share_interval(unsigned seen, unsigned of) {
  const double k = seen, n = of;
  using boost::math::beta_distribution;
  using boost::math::quantile;
  return {seen == 0 ? 0 : quantile(beta_distribution<>(k, n - k + 1), 0.025),
          seen == of ? 1 : quantile(beta_distribution<>(k + 1, n - k), 0.975)};
}

json energy_rung(const Candidate& candidate, const PreparedScene& scene, unsigned runs,
                 double time_step, double duration) {
  const auto stride = static_cast<std::uint64_t>(std::llround(sample_every / time_step));
  const auto samples = static_cast<std::uint64_t>(std::llround(duration / sample_every));
  std::vector<Trace> traces;
  std::vector<Failure> failures;
  double largest = 0;
  for (unsigned run = 0; run < runs; ++run) {
    Trace trace;
    double start = 0;
    const auto watch = [&](System& system, double time) {
      const double energy = system.total_energy();
      if (time == 0) start = energy;
      largest = std::max(largest, std::abs(energy / start - 1));
      if (time < settle) return;
      trace.times.push_back(time);
      trace.energies.push_back(energy);
    };
    const auto failure = run_isolated(candidate, scene, run, Vector::Zero(), time_step,
                                      samples * stride, stride, watch);
    if (failure) {
      failures.push_back(*failure);
    } else {
      traces.push_back(std::move(trace));
    }
  }
  json record = failures_record(runs, failures);
  record["time_step"] = time_step;
  record["duration"] = duration;
  record["largest_change"] = largest;
  if (traces.size() >= 2 && largest > kept) {
    const double particles = static_cast<double>(scene.scene().particles);
    record.update(drift_of(traces, particles, scene.energy_unit()));
  }
  return record;
}

std::vector<Finding> energy_findings(const std::string& name, const std::vector<json>& rungs) {
  double largest = 0;
  bool ended = false;
  for (const auto& rung : rungs) {
    largest = std::max(largest, rung["largest_change"].get<double>());
    ended = ended || rung["failed"] < rung["runs"];
  }
  if (!ended || largest > kept) {
    return {order_finding(name, drift, rungs), order_finding(name, walk, rungs)};
  }
  Finding finding;
  finding.subject = fmt::format("total energy, {}", name);
  finding.value = largest;
  finding.sentence =
      fmt::format("{}: total energy is kept to rounding, its largest relative change is {:.1g}.",
                  name, largest);
  return {finding};
}

Finding positivity_finding(const std::string& name, const std::vector<json>& rungs) {
  Finding finding;
  finding.subject = fmt::format("positivity, {}", name);
  std::string shares, first;
  for (const auto& rung : rungs) {
    const unsigned failed = rung["failed"], runs = rung["runs"];
    const auto interval = share_interval(failed, runs);
    shares += fmt::format(
        "{}{} of {} at step {:g} ({:.0f} to {:.0f} %{})", shares.empty() ? "" : ", ", failed, runs,
        rung["time_step"].get<double>(), 100 * interval.lower, 100 * interval.upper,
        failed == 0
            ? ""
            : fmt::format(", {} by a negative internal energy", rung["negative"].get<unsigned>()));
    if (failed > 0 && first.empty()) {
      first = fmt::format("; the first by {} at time {:.3g}", rung["cause"].get<std::string>(),
                          rung["time"].get<double>());
    }
    // The finest step's is the value.
    finding.value = static_cast<double>(failed) / runs;
    finding.lower = interval.lower;
    finding.upper = interval.upper;
  }
  finding.sentence = fmt::format("{}: runs of {:g} time units that failed: {}{}.", name,
                                 rungs.at(0)["duration"].get<double>(), shares, first);
  return finding;
}

}  // namespace driftless::judge
