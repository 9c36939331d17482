#include "experiments/judge/frame_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/conclusion.hpp"
#include "experiments/order_fit.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {

std::string speed_words(double speed) {
  return fmt::format("{:g} thermal velocit{}", speed, speed == 1 ? "y" : "ies");
}

const std::vector<FrameAverage>& frame_averages_asked() {
  static const std::vector<FrameAverage> all = {
      {"kinetic_temperature", "kinetic temperature", 0.1},
      {"internal_temperature", "internal temperature", 0.02},
      {"internal_energy_variance", "variance of u", 0.5}};
  return all;
}

namespace {

using nlohmann::json;

/// Spreads of internal energies up to here are rounding, amplified over that time.
constexpr double kept = 1e-9;

/// A speed's record at one step.
const json& at_speed(const json& change, double speed) {
  const auto& all = change.at("speeds");
  return *std::find_if(all.begin(), all.end(),
                       [&](const json& one) { return one.at("speed") == speed; });
}

std::string failed_words(const json& record) {
  if (record["failed"] == 0) return "";
  return fmt::format("; {} of {} runs failed, the first at time {:.3g} ({})",
                     record["failed"].get<unsigned>(), record["runs"].get<unsigned>(),
                     record["time"].get<double>(), record["cause"].get<std::string>());
}

/// How the spread of wrong internal energies follows the step: at order 0 it stays.
std::string scaling_words(const std::vector<json>& changes, double speed) {
  std::vector<Deviation> spreads;
  for (const auto& change : changes) {
    const auto& record = at_speed(change, speed);
    if (!record.contains("spread")) continue;
    const double spread = record["spread"];
    const double numbers = record["energies"];
    spreads.push_back({change["time_step"], spread, spread / std::sqrt(2 * numbers)});
  }
  const auto fit = fit_order(spreads);
  if (!fit) return "the order of this in the step is not resolved";
  const double width = interval_quantile * fit->error;
  return fmt::format("this is of order {:.2f} ({:.2f} to {:.2f}) in the step{}", fit->order,
                     fit->order - width, fit->order + width,
                     fit->order - width < 0.1 ? " and does not vanish with it" : "");
}

std::string change_words(const json& record, const Finding& finding, double speed, double step) {
  return fmt::format(
      "In a frame at {} internal energies are wrong by {:.2g} % of their mean (root mean square) "
      "after {:g} time units at step {:g}, and the internal temperature changes by {:.2g} % "
      "({:.2g} "
      "to {:.2g} %) per unit time against rest",
      speed_words(speed), 100 * record["spread"].get<double>(), changes_after, step,
      100 * *finding.value, 100 * *finding.lower, 100 * *finding.upper);
}

}  // namespace

Finding frame_change_finding(const Method& method, const std::vector<json>& changes, double speed) {
  const auto& finest = changes.back();
  const auto& record = at_speed(finest, speed);
  Finding finding;
  finding.subject = "rate of change of the internal temperature at " + speed_words(speed);
  finding.unit = "1/time";
  finding.claimed = method.galilean;
  if (!record.contains("rate")) {
    const bool moving_alone = record["failed"] > 0;
    finding.verdict = moving_alone ? Verdict::fails : Verdict::not_resolved;
    finding.sentence = fmt::format("In a frame at {} there is no end to compare{}.",
                                   speed_words(speed), failed_words(record));
    return finding;
  }
  const auto& rate = record["rate"];
  const double value = rate["value"], spread = record["spread"];
  const double width =
      interval_quantile * student_factor(rate["degrees_of_freedom"]) * rate["error"].get<double>();
  finding.value = value;
  finding.lower = value - width;
  finding.upper = value + width;
  finding.resolution = kept;
  if (spread < kept) {
    finding.verdict = Verdict::holds;
    finding.sentence = fmt::format(
        "In a frame at {} internal energies are those at rest after {:g} time units, to {:.1g} of "
        "their mean.",
        speed_words(speed), changes_after, spread);
    return finding;
  }
  finding.verdict = Verdict::fails;
  finding.sentence =
      fmt::format("{}; {}{}.", change_words(record, finding, speed, finest["time_step"]),
                  scaling_words(changes, speed), failed_words(record));
  return finding;
}

namespace {

/// Where too few runs come to their end both at rest and in the moving frame.
Finding no_average(const FrameAverage& average, const json& rest, const json& moving) {
  const bool moving_alone = moving["failed"] > rest["failed"];
  Finding finding;
  finding.verdict = moving_alone ? Verdict::fails : Verdict::not_resolved;
  finding.sentence = fmt::format(
      "There is no long average of the {} {}{}.", average.words,
      moving_alone ? "in a frame at " + speed_words(moving["speed"]) : "at rest to compare with",
      failed_words(moving_alone ? moving : rest));
  return finding;
}

}  // namespace

std::optional<FrameRatio> frame_ratio(const FrameAverage& average, const json& rest,
                                      const json& moving) {
  std::vector<double> differences;
  double base = 0;
  for (std::size_t run = 0; run < rest[average.key].size(); ++run) {
    const auto &a = rest[average.key][run], &b = moving[average.key][run];
    if (a.is_null() || b.is_null()) continue;
    base += a.get<double>();
    differences.push_back(b.get<double>() - a.get<double>());
  }
  const auto all =
      Eigen::ArrayXd::Map(differences.data(), static_cast<Eigen::Index>(differences.size()));
  const double n = static_cast<double>(differences.size());
  if (n < 2) return {};
  base /= n;
  const double variance = (all - all.mean()).square().sum() / (n - 1);
  return FrameRatio{all.mean() / base, std::sqrt(variance / n) / base, n - 1};
}

Finding frame_average_finding(const Method& method, const FrameAverage& average, const json& rest,
                              const json& moving) {
  const double speed = moving["speed"], step = moving["time_step"];
  Finding finding;
  if (const auto ratio = frame_ratio(average, rest, moving)) {
    finding = zero_finding("", ratio->difference, ratio->error, average.tolerance,
                           ratio->degrees_of_freedom);
    finding.sentence = fmt::format(
        "In a frame at {} the {} differs from that at rest by {:.2g} % ({:.2g} to {:.2g} %) in "
        "long runs at step {:g}{}.",
        speed_words(speed), average.words, 100 * ratio->difference, 100 * *finding.lower,
        100 * *finding.upper, step, failed_words(moving));
  } else {
    finding = no_average(average, rest, moving);
  }
  finding.subject = fmt::format("{} at {}, step {:g}", average.words, speed_words(speed), step);
  finding.claimed = method.galilean;
  return finding;
}

}  // namespace driftless::judge
