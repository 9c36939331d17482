#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/deviations.hpp"
#include "experiments/judge/examinations.hpp"
#include "experiments/judge/limit_cells.hpp"
#include "experiments/judge/trade.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

// A normal variate is beyond `certain` errors on one side with this probability.
constexpr double certain_tail = 2.87e-7;

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& scene : limit_scenes(conditions)) {
    if (refusal(candidate.method(), scene.fluid)) continue;
    for (std::size_t step = 0; step < scene.time_steps.size(); ++step) {
      for (unsigned block = 0; block < scene.blocks; ++block) {
        const auto number = static_cast<unsigned>(step) * scene.blocks + block;
        const double time_step = scene.time_steps[step];
        all.push_back({part_name(scene, step, block), scene.cost_per_inverse_step / time_step,
                       [scene, candidate, time_step, number] {
                         return scene.run(candidate, time_step, number);
                       }});
      }
    }
    if (!scene.seconds_per_time) continue;
    all.push_back({timing_name(scene), 0.4, [scene, candidate] {
                     return json{{"seconds_per_time", scene.seconds_per_time(candidate)}};
                   }});
  }
  return all;
}

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

/// One observable in one scene.
struct Case {
  const LimitScene& scene;
  const LimitObservable& observable;
  const std::vector<LimitCell>& cells;

  std::string subject() const { return observable.words + ", " + scene.name; }
};

/// The finest time steps at which the method can be run: those of the limit.
std::vector<LimitPoint> points_of(const Case& asked) {
  constexpr std::size_t most = 4;
  std::vector<LimitPoint> points;
  for (auto cell = asked.cells.rbegin(); cell != asked.cells.rend(); ++cell) {
    const auto found = cell->value(asked.observable.name);
    if (!found || !cell->is_whole() || points.size() == most) continue;
    points.push_back({cell->time_step, found->value, found->error, found->degrees_of_freedom});
  }
  return points;
}

/// The same points, each with what all of them say of their errors: they cover the same simulated
/// time of the same system, which has the same fluctuations at all fine steps. What a step's own
/// few replicas say scatters by a factor of two and needs wide quantiles. Squares of distances are
/// kept as they are: their errors grow with them.
std::vector<LimitPoint> with_common_error(const Case& asked) {
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

constexpr std::size_t fewest_points = 3;

/// A scene in which too few steps can be run for any limit.
Finding unseen(const LimitScene& scene, const std::vector<LimitCell>& cells) {
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

bool can_be_run(const std::vector<LimitCell>& cells) {
  const auto whole = std::count_if(cells.begin(), cells.end(),
                                   [](const LimitCell& cell) { return cell.is_whole(); });
  return static_cast<std::size_t>(whole) >= fewest_points;
}

std::string sentence(const Case& asked, const Finding& finding, const Limit& limit, double error) {
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

Finding finding_of(const Case& asked, const Candidate& candidate, Depth depth) {
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
    finding.sentence = sentence(asked, finding, *limit, error);
  } else {
    finding.subject = asked.subject();
    finding.verdict = Verdict::not_resolved;
    finding.sentence = "Too few runs give an average with an error for a limit.";
  }
  finding.claimed = is_consistent(candidate.method(), candidate.choice.options, asked.scene.fluid);
  return finding;
}

/// A finding for each closure that the method refuses.
void add_refusals(const Candidate& candidate, const std::vector<LimitScene>& scenes,
                  Conclusion& conclusion) {
  std::set<std::string> told;
  for (const auto& scene : scenes) {
    const auto reason = refusal(candidate.method(), scene.fluid);
    if (!reason || !told.insert(*reason).second) continue;
    Finding finding;
    finding.subject =
        fmt::format("{} closure", to_string(scene.fluid.parameters().friction_closure));
    finding.verdict = Verdict::not_applicable;
    finding.sentence = *reason + ".";
    conclusion.findings.push_back(std::move(finding));
  }
}

Series deviations_by_step(std::string name, const Case& asked) {
  Series series{std::move(name), {}};
  const double scale = asked.observable.is_relative ? 100 : 1;
  for (const auto& point : points_of(asked)) {
    const double reach = point.error * student_quantile(point.degrees_of_freedom, 0.025) * scale;
    const double value = point.value * scale;
    series.points.push_back({point.time_step, value, value - reach, value + reach});
  }
  return series;
}

Chart empty_chart(Family family, const std::string& words) {
  return {words + " by time step, " + to_string(family),
          {"time step", true},
          {"deviation from the exact value, %"},
          {}};
}

/// What tells methods apart best: by heat capacity and closure for the ideal systems, by observable
/// for the soft fluid.
class Charts {
 public:
  void add(const Case& asked) {
    const auto family = asked.scene.family;
    const std::string& name = asked.observable.name;
    if (family == Family::soft ? !asked.observable.is_relative
                               : name != "internal_energy_variance") {
      return;
    }
    auto series = deviations_by_step(series_name(asked), asked);
    if (!series.points.empty()) chart(asked).series.push_back(std::move(series));
  }
  std::vector<Chart> take() && { return std::move(charts_); }

 private:
  static std::string series_name(const Case& asked) {
    const auto& f = asked.scene.fluid.parameters();
    const auto closure = to_string(f.friction_closure);
    if (asked.scene.family == Family::soft) {
      return fmt::format("{}, {} closure", asked.observable.words, closure);
    }
    const bool other = f.has_conduction() && f.heat_form != HeatForm::inverse_temperature;
    return fmt::format("{} closure, phi/k = {:g}{}", closure, f.heat_capacity / f.boltzmann,
                       other ? fmt::format(", {} form", to_string(f.heat_form)) : "");
  }

  Chart& chart(const Case& asked) {
    const bool soft = asked.scene.family == Family::soft;
    auto wanted = empty_chart(asked.scene.family, soft ? "averages" : asked.observable.words);
    const auto found = std::find_if(charts_.begin(), charts_.end(),
                                    [&](const Chart& c) { return c.title == wanted.title; });
    return found == charts_.end() ? charts_.emplace_back(std::move(wanted)) : *found;
  }

  std::vector<Chart> charts_;
};

/// Rows of the table of errors and costs.
void add_trade(const Case& asked, const Records& records, Table& table) {
  const auto timed = records.find(timing_name(asked.scene));
  if (timed == records.end()) return;
  const auto costs = timed->second["seconds_per_time"].get<std::vector<double>>();
  for (std::size_t step = 0; step < asked.cells.size(); ++step) {
    const auto& cell = asked.cells[step];
    const auto found = cell.value(asked.observable.name);
    if (!found || cell.failed > 0 || !(costs[step] > 0)) continue;
    const json entry = {{"mean", found->value},
                        {"exact", 0},
                        {"exact_error", cell.reference_error(asked.observable.name)}};
    const auto size =
        deviation(asked.observable.name, entry, {found->error, found->degrees_of_freedom});
    table.rows.push_back({asked.scene.name, asked.observable.name, cell.time_step, costs[step],
                          size["value"].get<double>(), size["lower"].get<double>(),
                          size["upper"].get<double>()});
  }
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  Conclusion conclusion;
  const auto scenes = limit_scenes(conditions);
  Charts charts;
  Table trade = empty_trade_table();
  for (const auto& scene : scenes) {
    if (refusal(candidate.method(), scene.fluid)) continue;
    const auto cells = limit_cells(scene, records);
    if (!can_be_run(cells)) {
      auto finding = unseen(scene, cells);
      finding.claimed = is_consistent(candidate.method(), candidate.choice.options, scene.fluid);
      conclusion.findings.push_back(std::move(finding));
      continue;
    }
    for (const auto& observable : limit_observables(scene.family)) {
      const Case asked{scene, observable, cells};
      conclusion.findings.push_back(finding_of(asked, candidate, conditions.depth));
      charts.add(asked);
      add_trade(asked, records, trade);
    }
  }
  add_refusals(candidate, scenes, conclusion);
  conclusion.charts = std::move(charts).take();
  if (!trade.rows.empty()) conclusion.tables.push_back(std::move(trade));
  return conclusion;
}

}  // namespace

const Examination limits{
    "limits",
    "Right in the limit of vanishing time steps",
    "Is every average of equilibrium right in the limit of vanishing time steps? Isolated pairs, "
    "the isolated ideal fluid with and without conduction and a soft fluid are run at four time "
    "steps, each observable's deviation from its exact value (for the soft fluid: from that of a "
    "Monte Carlo chain, whose error counts) is extrapolated to step zero by the parabola through "
    "the three finest steps, whatever order is claimed; by how much the coarsest one, as a point "
    "of "
    "a cubic, would move the limit counts as an error too. A deviation beyond five standard errors "
    "fails. "
    "Where five errors are more than 1 % of a temperature, 3 % of a variance or 0.05 of a skewness "
    "(at depth quick five times as much), or than a distance of 0.009 between distributions "
    "(that of two variances 10 % apart), nothing is resolved. A step at which over one in twenty "
    "runs fails does not count.",
    parts,
    conclude,
};

}  // namespace driftless::judge
