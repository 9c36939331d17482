#include "experiments/judge/limit_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

// A normal variate is beyond `certain` errors on one side with this probability.
constexpr double certain_tail = 2.87e-7;
constexpr double suspicious = 3;  // errors
constexpr std::size_t fewest_points = 3;

/// A deviation as people write it, with its sign or without.
std::string signed_amount(double value, const LimitObservable& observable) {
  if (!observable.is_relative) return fmt::format("{:+.2g}", value);
  const double percent = 100 * value;
  return std::abs(percent) < 100 ? fmt::format("{:+.2g} %", percent)
                                 : fmt::format("{:+.0f} %", percent);
}
std::string amount(double value, const LimitObservable& observable) {
  return signed_amount(std::abs(value), observable).substr(1);
}
double root(double square) { return std::sqrt(std::max(0.0, square)); }

std::string text_of_failure(const LimitCell& cell) {
  std::string text = fmt::format("{:g} of {:g} runs failed at the step {:g}", cell.failed,
                                 cell.runs, cell.time_step);
  if (cell.failure.is_null()) return text;
  text += fmt::format(" ({}", cell.failure["cause"].get<std::string>());
  if (cell.failure.contains("step")) {
    text +=
        fmt::format(", the first in step {} at time {:.3g}",
                    cell.failure["step"].get<std::uint64_t>(), cell.failure["time"].get<double>());
  }
  return text + ")";
}

/// The same points, each with what all of them say of their errors: they cover the same simulated
/// time of the same system, which has the same fluctuations at all fine steps. What a step's own
/// few replicas say scatters by a factor of two and needs wide quantiles. Squares of distances are
/// kept as they are: their errors grow with them.
std::vector<LimitPoint> with_common_error(const LimitCase& asked) {
  auto points = points_of(asked);
  if (asked.observable.is_square) return points;
  double sum = 0, freedom = 0;
  for (const auto& point : points) {
    if (!std::isfinite(point.degrees_of_freedom)) return points;
    sum += point.degrees_of_freedom * point.error * point.error;
    freedom += point.degrees_of_freedom;
  }
  for (auto& point : points) {
    point.error = std::sqrt(sum / freedom);
    point.degrees_of_freedom = freedom;
  }
  return points;
}

std::string sentence(const LimitCase& asked, const Finding& finding, const Limit& limit,
                     double error) {
  const auto& seen = asked.observable;
  std::string text;
  if (seen.is_square) {
    text = fmt::format(
        "In the limit of vanishing steps {} is away from the exact one by {:.2g} "
        "(root of the squared Cramer-von Mises distance, 95 % interval {:.2g} to "
        "{:.2g})",
        seen.words, root(*finding.value), root(*finding.lower), root(*finding.upper));
  } else {
    text = fmt::format(
        "In the limit of vanishing steps {} deviates from its exact value by {} "
        "(95 % interval {} to {})",
        seen.words, signed_amount(*finding.value, seen), signed_amount(*finding.lower, seen),
        signed_amount(*finding.upper, seen));
  }
  const double resolution = seen.is_square ? root(*finding.resolution) : *finding.resolution;
  if (finding.verdict == Verdict::fails) {
    text +=
        fmt::format(", {:.1f} standard errors: it is not right", std::abs(*finding.value) / error);
  } else {
    if (std::abs(*finding.value) > suspicious * error) text += ", which is suspicious";
    text += fmt::format("; {} or more would have been certain", amount(resolution, seen));
  }
  if (limit.model_error > limit.error) {
    text += "; most of the error is that of the extrapolation itself";
  }
  for (auto cell = asked.cells.rbegin(); cell != asked.cells.rend(); ++cell) {
    if (cell->failed > 0) return text + "; " + text_of_failure(*cell) + ".";
  }
  return text + ".";
}

}  // namespace

std::vector<LimitPoint> points_of(const LimitCase& asked) {
  constexpr std::size_t most = 4;
  std::vector<LimitPoint> points;
  for (auto cell = asked.cells.rbegin(); cell != asked.cells.rend(); ++cell) {
    const auto found = cell->value(asked.observable.name);
    if (!found || !cell->is_whole() || points.size() == most) continue;
    points.push_back({cell->time_step, found->value, found->error, found->degrees_of_freedom});
  }
  return points;
}

Finding limit_finding(const LimitCase& asked, Depth depth) {
  const auto limit = limit_at_zero(with_common_error(asked));
  Finding finding;
  if (limit) {
    // The quantile that few degrees of freedom ask for, as so much larger an error.
    const double widened =
        limit->error * student_quantile(limit->degrees_of_freedom, certain_tail) / certain;
    const double reference = asked.cells.back().reference_error(asked.observable.name);
    const double error = std::hypot(widened, limit->model_error, reference);
    const auto& seen = asked.observable;
    const double tolerance = depth == Depth::quick ? seen.quick_tolerance : seen.tolerance;
    finding = zero_finding(asked.subject(), limit->value, error, tolerance);
    // Not certain, yet too far off for saying that it is right.
    const bool hint = std::abs(limit->value) > suspicious * error;
    if (hint && finding.verdict == Verdict::holds) finding.verdict = Verdict::not_resolved;
    finding.sentence = sentence(asked, finding, *limit, error);
  } else {
    finding.subject = asked.subject();
    finding.verdict = Verdict::not_resolved;
    finding.sentence = "Too few runs give an average with an error for a limit.";
  }
  return finding;
}

bool can_be_run(const std::vector<LimitCell>& cells) {
  const auto whole = std::count_if(cells.begin(), cells.end(),
                                   [](const LimitCell& cell) { return cell.is_whole(); });
  return static_cast<std::size_t>(whole) >= fewest_points;
}

Finding unseen_finding(const LimitScene& scene, const std::vector<LimitCell>& cells) {
  Finding finding;
  finding.subject = "every observable, " + scene.name;
  finding.verdict = Verdict::not_resolved;
  std::string failures;
  for (const auto& cell : cells) {
    if (!cell.is_whole()) failures = text_of_failure(cell);
  }
  finding.sentence =
      fmt::format("No limit can be seen in the {}: fewer than {} time steps can be run; {}.",
                  scene.name, fewest_points, failures);
  return finding;
}

}  // namespace driftless::judge
