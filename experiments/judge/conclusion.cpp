#include "experiments/judge/conclusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

void put(json& object, const char* key, const std::optional<double>& value) {
  if (value && std::isfinite(*value)) object[key] = *value;
}

json to_json(const Finding& finding) {
  json record = {{"subject", finding.subject},
                 {"verdict", to_string(finding.verdict)},
                 {"sentence", finding.sentence},
                 {"unit", finding.unit}};
  if (finding.claimed) record["claimed"] = *finding.claimed;
  put(record, "value", finding.value);
  put(record, "lower", finding.lower);
  put(record, "upper", finding.upper);
  put(record, "resolution", finding.resolution);
  return record;
}

json to_json(const Series& series) {
  json points = json::array();
  for (const auto& point : series.points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    json record = {{"x", point.x}, {"y", point.y}};
    put(record, "lower", point.lower);
    put(record, "upper", point.upper);
    points.push_back(record);
  }
  return {{"name", series.name},
          {"marks", series.marks == Marks::line ? "line" : "points"},
          {"points", points}};
}

json to_json(const Table& table) {
  json rows = json::array();
  for (const auto& row : table.rows) {
    json cells = json::array();
    for (const auto& cell : row) {
      if (const auto* number = std::get_if<double>(&cell)) {
        cells.push_back(std::isfinite(*number) ? json(*number) : json());
      } else {
        cells.push_back(std::get<std::string>(cell));
      }
    }
    rows.push_back(cells);
  }
  return {{"title", table.title}, {"columns", table.columns}, {"rows", rows}};
}

template <class Part>
json list(const std::vector<Part>& parts) {
  json all = json::array();
  for (const auto& part : parts) all.push_back(to_json(part));
  return all;
}

}  // namespace

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::fails:
      return "fails";
    case Verdict::not_resolved:
      return "not resolved";
    case Verdict::reported:
      return "reported";
    case Verdict::not_applicable:
      break;
  }
  return "not applicable";
}

Verdict overall(const Conclusion& conclusion) {
  for (const auto verdict :
       {Verdict::fails, Verdict::not_resolved, Verdict::holds, Verdict::reported}) {
    const bool found = std::any_of(conclusion.findings.begin(), conclusion.findings.end(),
                                   [&](const Finding& one) { return one.verdict == verdict; });
    if (found) return verdict;
  }
  return Verdict::not_applicable;
}

json to_json(const Axis& axis) {
  return {{"title", axis.title}, {"logarithmic", axis.logarithmic}};
}

json to_json(const Chart& chart) {
  json series = json::array();
  for (const auto& one : chart.series) series.push_back(to_json(one));
  return {
      {"title", chart.title}, {"x", to_json(chart.x)}, {"y", to_json(chart.y)}, {"series", series}};
}

json to_json(const Conclusion& conclusion) {
  return {{"verdict", to_string(overall(conclusion))},
          {"findings", list(conclusion.findings)},
          {"charts", list(conclusion.charts)},
          {"tables", list(conclusion.tables)}};
}

Finding zero_finding(std::string subject, double value, double error, double tolerance,
                     double degrees_of_freedom) {
  Finding finding;
  finding.subject = std::move(subject);
  finding.value = value;
  const double width = interval_quantile * student_factor(degrees_of_freedom) * error;
  finding.lower = value - width;
  finding.upper = value + width;
  const double rarely = 0.5 * std::erfc(certain / std::numbers::sqrt2);
  const double sure = std::isfinite(degrees_of_freedom)
                          ? student_quantile(degrees_of_freedom, rarely) * error
                          : certain * error;
  finding.resolution = sure;
  const bool known = std::isfinite(value) && std::isfinite(error);
  if (known && std::abs(value) > sure) {
    finding.verdict = Verdict::fails;
  } else {
    finding.verdict = known && sure <= tolerance ? Verdict::holds : Verdict::not_resolved;
  }
  return finding;
}

}  // namespace driftless::judge
