#include "experiments/judge/stability_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>

#include "experiments/order_fit.hpp"
#include "experiments/statistics.hpp"
#include "integrators/integrator.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr std::string_view conduction_source = "Mackie et al. 1999, eq. 3.33";
constexpr std::string_view noise_source = "Mackie et al. 1999, eq. 3.34";

std::string most_frequent(const json& record) {
  std::map<std::string, int> counts;
  for (const auto& one : record) {
    if (const auto cause = one["cause"].get<std::string>(); !cause.empty()) ++counts[cause];
  }
  if (counts.empty()) return "";
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return counts.size() == 1
             ? most->first
             : fmt::format("{} ({} of {})", most->first, most->second, record.size());
}

std::string words(const Threshold& found) {
  if (found.none()) return fmt::format("none down to {:.2g}", found.shortest);
  if (!found.all_unstable) return fmt::format("{:.2g} or more", found.all_stable);
  return fmt::format("{:.2g} ({:.2g} to {:.2g})", *found.typical, found.all_stable,
                     *found.all_unstable);
}

/// Of steps stable up to the longest one tried only the lower end is known.
void put_numbers(const Threshold& found, Finding& finding) {
  finding.unit = "time";
  if (found.none()) return;
  finding.value = found.typical;
  finding.lower = found.all_stable;
  finding.upper = found.all_unstable;
}

/// "3, 10 and more" of the points for which `chosen` has words.
std::string listed(const StabilityAxis& axis, const std::vector<Threshold>& found,
                   const std::function<std::string(const Threshold&)>& chosen,
                   const char* separator) {
  std::string text;
  for (const auto& one : found) {
    const auto about = chosen(one);
    if (about.empty()) continue;
    text +=
        fmt::format("{}{:g}{}", text.empty() ? "" : separator, one.point.*axis.coordinate, about);
  }
  return text;
}

/// One axis in a few sentences: the range over the points where the largest stable step was found,
/// the points where all steps are stable, those where none is, and the causes.
Finding axis_finding(const StabilityAxis& axis, const std::vector<Threshold>& found) {
  Finding finding;
  finding.subject = fmt::format("largest stable step over {}", axis.name);
  const Threshold *least = nullptr, *most = nullptr;
  for (const auto& one : found) {
    if (!one.typical) continue;
    if (!least || *one.typical < *least->typical) least = &one;
    if (!most || *one.typical > *most->typical) most = &one;
  }
  const auto at = [&](const Threshold& one) {
    return fmt::format("{} at {:g}", words(one), one.point.*axis.coordinate);
  };
  std::string text =
      fmt::format("{} from {:g} to {:g}:", axis.title, found.front().point.*axis.coordinate,
                  found.back().point.*axis.coordinate);
  text[0] = static_cast<char>(std::toupper(text[0]));
  if (least) {
    put_numbers(*least, finding);
    text += fmt::format(" the largest stable step is {}{}.", at(*least),
                        most == least ? "" : ", " + at(*most));
  }
  const auto open = listed(
      axis, found,
      [](const Threshold& one) {
        if (one.none() || one.typical) return std::string();
        return fmt::format(" ({}{:.2g})", one.cause.empty() ? "" : "some seeds; all to ",
                           one.all_stable);
      },
      ", ");
  if (!open.empty()) text += " Stable up to the longest step tried at " + open + ".";
  const auto without = listed(
      axis, found,
      [](const Threshold& one) {
        return one.none() ? fmt::format(" (down to {:.2g})", one.shortest) : std::string();
      },
      ", ");
  if (!without.empty()) text += " No stable step at " + without + ".";
  const auto causes = listed(
      axis, found, [](const Threshold& one) { return one.cause.empty() ? "" : ": " + one.cause; },
      "; ");
  if (!causes.empty()) text += " Causes of failure at " + causes + ".";
  finding.verdict = without.empty() ? Verdict::reported : Verdict::fails;
  finding.sentence = text;
  return finding;
}

/// The power of the estimate that the steps follow, in words, where the points say enough: four
/// that are spread over a factor of ten.
std::string exponent(const std::vector<Deviation>& points) {
  const auto [least, most] =
      std::minmax_element(points.begin(), points.end(),
                          [](const auto& a, const auto& b) { return a.time_step < b.time_step; });
  if (points.size() < 4 || most->time_step < 10 * least->time_step) return "";
  const auto fit = fit_order(points);
  if (!fit || fit->points < 4) return "";
  const double width = fit->error * student_quantile(static_cast<double>(fit->points) - 2, 0.025);
  return fmt::format(", and the steps follow it to the power {:.2f} ({:.2f} to {:.2f})", fit->order,
                     fit->order - width, fit->order + width);
}

/// How the steps from which on internal energies become negative follow an estimate of just that,
/// along an axis on which it changes.
std::optional<Finding> estimate_finding(const StabilityAxis& axis,
                                        const std::vector<Threshold>& found,
                                        std::optional<double> PositivityEstimates::*which,
                                        std::string_view source) {
  const auto negative = to_string(FailureCause::negative_internal_energy);
  std::vector<Deviation> points;
  double least = std::numeric_limits<double>::infinity(), most = 0, first = 0;
  bool changes = false;
  for (const auto& one : found) {
    const auto estimate = positivity_estimates(one.point).*which;
    if (!estimate) continue;
    if (first == 0) first = *estimate;
    changes = changes || *estimate != first;
    if (!one.typical || !one.cause.starts_with(negative)) continue;
    least = std::min(least, *one.typical / *estimate);
    most = std::max(most, *one.typical / *estimate);
    points.push_back({*estimate, *one.typical, (*one.all_unstable - one.all_stable) / 4});
  }
  if (points.empty() || !changes) return std::nullopt;
  Finding finding;
  finding.subject = fmt::format("against {} over {}", source, axis.name);
  finding.lower = least;
  finding.upper = most;
  const auto range = points.size() == 1 ? fmt::format("{:.2g}", least)
                                        : fmt::format("{:.2g} to {:.2g}", least, most);
  finding.sentence = fmt::format(
      "Over {} internal energies become negative from steps on that are {} times the estimate of "
      "{}",
      axis.name, range, source);
  finding.sentence += exponent(points) + ".";
  return finding;
}

Series estimate_line(const std::vector<Threshold>& found, const StabilityAxis& axis,
                     std::optional<double> PositivityEstimates::*which, std::string_view source) {
  Series line{std::string(source), {}, Marks::line};
  for (const auto& one : found) {
    if (const auto estimate = positivity_estimates(one.point).*which) {
      line.points.push_back({one.point.*axis.coordinate, *estimate});
    }
  }
  return line;
}

Series measured(std::string name, const StabilityAxis& axis, const std::vector<Threshold>& found) {
  Series series{std::move(name), {}};
  for (const auto& one : found) {
    if (!one.typical) continue;
    series.points.push_back(
        {one.point.*axis.coordinate, *one.typical, one.all_stable, *one.all_unstable});
  }
  return series;
}

Chart axis_chart(const StabilityAxis& axis, const std::vector<Threshold>& found) {
  Chart chart{fmt::format("Largest stable step against {}", axis.name),
              {std::string(axis.title), axis.coordinate != &StabilityPoint::repulsion},
              {"time step", true},
              {measured("measured: all seeds stable to all unstable", axis, found)}};
  Series open{"stable up to the longest step tried", {}}, none{"unstable down to the shortest", {}};
  for (const auto& one : found) {
    const double x = one.point.*axis.coordinate;
    if (one.none()) {
      none.points.push_back({x, one.shortest});
    } else if (!one.typical) {
      open.points.push_back({x, one.all_stable});
    }
  }
  for (auto& series :
       {open, none, estimate_line(found, axis, &PositivityEstimates::conduction, conduction_source),
        estimate_line(found, axis, &PositivityEstimates::noise, noise_source)}) {
    if (!series.points.empty()) chart.series.push_back(series);
  }
  return chart;
}

void add_row(const Threshold& found, Table& table) {
  const auto number = [](const std::optional<double>& value) -> std::variant<std::string, double> {
    if (value) return *value;
    return std::string();
  };
  const auto estimates = positivity_estimates(found.point);
  table.rows.push_back({name_of(found.point), words(found),
                        found.none() ? std::variant<std::string, double>(std::string())
                                     : found.all_stable / collision_time(found.point),
                        found.cause, number(estimates.conduction), number(estimates.noise)});
}

}  // namespace

Threshold threshold(const StabilityPoint& point, double shortest, const json& record) {
  Threshold result{point, record[0]["stable"], 0.0, 0.0, most_frequent(record), shortest};
  for (const auto& one : record) {
    const double stable = one["stable"];
    result.all_stable = std::min(result.all_stable, stable);
    if (!one.contains("unstable")) {
      result.all_unstable = result.typical = std::nullopt;
    }
    if (!result.all_unstable) continue;
    const double unstable = one["unstable"];
    result.all_unstable = std::max(*result.all_unstable, unstable);
    *result.typical += 0.5 * std::log(stable * unstable) / static_cast<double>(record.size());
  }
  if (result.none()) result.all_unstable = result.typical = std::nullopt;
  if (result.typical) result.typical = std::exp(*result.typical);
  return result;
}

std::string name_of(const StabilityPoint& point) {
  std::string name;
  for (const auto& axis : stability_axes()) {
    const double value = point.*axis.coordinate;
    if (value == StabilityPoint{}.*axis.coordinate) continue;
    name += fmt::format("{}{} = {:g}", name.empty() ? "" : ", ", axis.name, value);
  }
  return name.empty() ? "base" : name;
}

Finding base_finding(const Threshold& found, FrictionClosure closure) {
  Finding finding;
  finding.subject = "largest stable step, base";
  finding.verdict = found.none() ? Verdict::fails : Verdict::reported;
  put_numbers(found, finding);
  finding.sentence = fmt::format(
      "In the base fluid, of the closure {}, whose particles collide every {:.2g}, the largest "
      "stable step is {}{}.",
      to_string(closure), collision_time(found.point), words(found),
      found.cause.empty() ? "" : "; beyond it: " + found.cause);
  return finding;
}

void conclude_axis(const StabilityAxis& axis, const std::vector<Threshold>& found,
                   Conclusion& conclusion) {
  conclusion.findings.push_back(axis_finding(axis, found));
  for (const auto& [which, source] :
       {std::pair{&PositivityEstimates::conduction, conduction_source},
        std::pair{&PositivityEstimates::noise, noise_source}}) {
    if (auto against = estimate_finding(axis, found, which, source)) {
      conclusion.findings.push_back(std::move(*against));
    }
  }
  conclusion.charts.push_back(axis_chart(axis, found));
}

Chart map_chart(const StabilityAxis& axis, const StabilityAxis& other,
                const std::vector<std::vector<Threshold>>& curves) {
  Chart chart{fmt::format("Largest stable step over {} and {}", axis.name, other.name),
              {std::string(axis.title), true},
              {"time step", true},
              {}};
  for (const auto& curve : curves) {
    const double value = curve.front().point.*other.coordinate;
    chart.series.push_back(measured(fmt::format("{} = {:g}", other.title, value), axis, curve));
  }
  return chart;
}

Table threshold_table(const std::vector<Threshold>& found) {
  Table table{"Largest stable steps and what happens beyond them",
              {"fluid", "step: typical (all seeds stable to all unstable)",
               "all stable, in collision times", "cause", std::string(conduction_source),
               std::string(noise_source)},
              {}};
  for (const auto& one : found) add_row(one, table);
  return table;
}

}  // namespace driftless::judge
