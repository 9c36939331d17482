#include "experiments/deviations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "experiments/statistics.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr double interval_tail = 0.025;  // beyond either end of a 95 % interval

bool is_distance(std::string_view name) { return name.ends_with("_distance"); }

/// The standard error as the cell's own runs give it.
PooledError own_error(const json& entry) {
  const double freedom = entry.value("degrees_of_freedom", std::numeric_limits<double>::infinity());
  return {entry["error"].get<double>() / student_factor(freedom), freedom};
}

/// |mean - exact| in the observable's unit of deviation, and what its error reaches with a
/// probability on either side. Distances are known by their squares.
struct Distance {
  double centre, reach;
  bool is_square;

  double ended(double end) const {
    const double size = std::max(0.0, end);
    return is_square ? std::sqrt(size) : size;
  }
  double value() const { return ended(centre); }
  double lower() const { return ended(centre - reach); }
  /// An unbiased square may be negative; what it may hide is counted from zero.
  double upper() const { return ended(std::max(0.0, centre) + reach); }
  double resolution() const { return ended(reach); }
};

Distance distance(std::string_view observable, const json& entry, const PooledError& error,
                  double tail) {
  const double mean = entry["mean"], exact = entry["exact"];
  const double reach = error.error * student_quantile(error.degrees_of_freedom, tail);
  if (is_distance(observable)) return {mean, reach, true};
  // A skewness may well be near zero; it is a number in units of one.
  const bool absolute = exact == 0 || observable.ends_with("_skewness");
  const double scale = absolute ? 1 : std::abs(exact);
  const double reference = entry.value("exact_error", 0.0) *
                           student_quantile(std::numeric_limits<double>::infinity(), tail);
  return {std::abs(mean - exact) / scale, std::hypot(reach, reference) / scale, false};
}

/// One observable in one cell.
struct Measured {
  const json* cell;
  json* entry;
  PooledError error;

  bool competes() const { return (*cell)["status"] == "ok" && (*entry)["status"] == "ok"; }
  bool is_alike() const {
    return competes() && !entry->value("replicas_disagree", false) && error.error > 0 &&
           std::isfinite(error.degrees_of_freedom);
  }
};

std::vector<Measured> measured(json& cells, const std::string& scene,
                               const std::string& observable) {
  std::vector<Measured> found;
  for (auto& cell : cells) {
    if (cell["scene"] != scene || !cell["observables"].contains(observable)) continue;
    auto& entry = cell["observables"][observable];
    if (!entry.contains("exact")) continue;
    found.push_back({&cell, &entry, own_error(entry)});
  }
  return found;
}

void pool(std::vector<Measured>& all) {
  std::vector<CellError> errors;
  for (const auto& one : all) {
    if (!one.is_alike()) continue;
    errors.push_back({one.error.error, one.error.degrees_of_freedom, (*one.cell)["time_step"]});
  }
  const auto pooled = pool_errors(errors);
  auto next = pooled.begin();
  for (auto& one : all) {
    if (one.is_alike()) one.error = *next++;
  }
}

void add_deviations(json& cells, const std::string& scene, const std::string& observable) {
  auto all = measured(cells, scene, observable);
  if (is_relative(observable)) pool(all);
  const auto competitors = static_cast<double>(
      std::count_if(all.begin(), all.end(), [](const auto& one) { return one.competes(); }));
  for (const auto& one : all) {
    json result = deviation(observable, *one.entry, one.error);
    if (one.competes()) {
      const double tail = std::min(interval_tail, (1 - bounds_level) / competitors);
      const Distance at_once = distance(observable, *one.entry, one.error, tail);
      result["bound"] = at_once.upper();
      result["resolution"] = at_once.resolution();
    }
    (*one.entry)["deviation"] = std::move(result);
  }
}

}  // namespace

bool is_relative(std::string_view observable) {
  return observable != "energy_drift" && !is_distance(observable);
}

json deviation(std::string_view observable, const json& entry, const PooledError& error) {
  const Distance found = distance(observable, entry, error, interval_tail);
  return {{"value", found.value()},
          {"lower", found.lower()},
          {"upper", found.upper()},
          {"below_noise", found.lower() == 0}};
}

void add_deviations(json& result) {
  for (const auto& scene : result["scenes"]) {
    std::set<std::string> observables;
    for (const auto& cell : result["cells"]) {
      if (cell["scene"] != scene["name"]) continue;
      for (const auto& [name, entry] : cell["observables"].items()) observables.insert(name);
    }
    for (const auto& observable : observables) {
      add_deviations(result["cells"], scene["name"], observable);
    }
  }
}

}  // namespace driftless
