#include "experiments/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/answer_words.hpp"
#include "experiments/deviations.hpp"
#include "experiments/observables.hpp"
#include "experiments/order_fit.hpp"
#include "experiments/statistics.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr double rounding = 1e-12;  // a deviation below it has no order
const std::vector<std::string> equilibrium_parts = {"kinetic_temperature", "internal_temperature",
                                                    "internal_energy_variance"};

bool is_isothermal(const json& cell) { return cell.value("isothermal", false); }

std::vector<std::string> parts_of(const json& cell, const std::string& observable) {
  if (observable != equilibrium_observable) return {observable};
  return is_isothermal(cell) ? std::vector{equilibrium_parts.front()} : equilibrium_parts;
}

/// The largest `key` of a cell's deviations in an observable's parts, if it has all of them.
std::optional<double> largest(const json& cell, const std::string& observable, const char* key) {
  double result = 0;
  for (const auto& part : parts_of(cell, observable)) {
    const auto entry = cell["observables"].find(part);
    if (entry == cell["observables"].end() || !entry->contains("deviation")) return std::nullopt;
    const auto number = (*entry)["deviation"].find(key);
    if (number == (*entry)["deviation"].end()) return std::nullopt;
    result = std::max(result, number->get<double>());
  }
  return result;
}

using SceneCells = std::vector<const json*>;

SceneCells cells_of(const json& result, const std::string& scene) {
  SceneCells cells;
  for (const auto& cell : result["cells"]) {
    if (cell["scene"] == scene) cells.push_back(&cell);
  }
  return cells;
}

/// What there is to choose from, and the choice while nothing is chosen yet.
struct Field {
  Choice empty;
  std::vector<Candidate> candidates;  ///< compared, with a known cost
};

Field field_of(const SceneCells& cells, const std::string& scene, const std::string& observable) {
  Field field{{scene, observable, {}, std::nullopt, 0, std::nullopt, false, false}, {}};
  auto& [choice, candidates] = field;
  bool any_ran = false, any_exact = false;
  for (const json* cell : cells) {
    choice.isothermal = choice.isothermal || is_isothermal(*cell);
    any_ran = any_ran || (*cell)["status"] == "ok";
    any_exact = any_exact || largest(*cell, observable, "value");
    const auto bound = largest(*cell, observable, "bound");
    const auto least = largest(*cell, observable, "resolution");
    if (!bound || !least) continue;
    ++choice.cells_compared;
    choice.resolution = std::min(choice.resolution.value_or(*least), *least);
    const auto cost = cell->value("cost", json::object()).value("core_seconds_per_time", json());
    if (!cost.is_number()) continue;
    candidates.push_back(
        {method_label(*cell), (*cell)["time_step"], cost, *bound, (*cell)["consistent"]});
  }
  choice.lacks_exact_value = any_ran && !any_exact;
  return field;
}

/// The best cell of every method that `allows` one.
template <class Allows, class Better>
Choice choose(const Field& field, Allows&& allows, Better&& better) {
  std::map<std::string, Candidate> best;
  for (const auto& candidate : field.candidates) {
    if (!allows(candidate)) continue;
    const auto [known, added] = best.emplace(candidate.method, candidate);
    if (!added && better(candidate, known->second)) known->second = candidate;
  }
  std::vector<Candidate> sorted;
  for (const auto& [method, candidate] : best) sorted.push_back(candidate);
  std::stable_sort(sorted.begin(), sorted.end(), better);
  Choice choice = field.empty;
  for (auto& candidate : sorted) {
    if (candidate.consistent) {
      choice.ranked.push_back(std::move(candidate));
    } else if (choice.ranked.empty() && !choice.better_inconsistent) {
      choice.better_inconsistent = std::move(candidate);
    }
  }
  return choice;
}

Choice cheapest_of(const Field& field, double tolerance) {
  return choose(
      field, [&](const Candidate& candidate) { return candidate.bound <= tolerance; },
      [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
}

json to_json(const Candidate& candidate) {
  return {{"method", candidate.method},
          {"time_step", candidate.time_step},
          {"cost", candidate.cost},
          {"upper", candidate.bound}};
}

json answer(const Field& field, double tolerance) {
  const Choice choice = cheapest_of(field, tolerance);
  json entry = {{"scene", choice.scene},
                {"observable", choice.observable},
                {"tolerance", tolerance},
                {"level", bounds_level},
                {"cells_compared", choice.cells_compared},
                {"resolution", nullptr},
                {"method", nullptr},
                {"time_step", nullptr},
                {"cost", nullptr},
                {"upper", nullptr},
                {"runner_up", nullptr},
                {"cheaper_inconsistent", nullptr},
                {"sentence", tolerance_sentence(choice, tolerance)}};
  if (choice.resolution) entry["resolution"] = *choice.resolution;
  if (!choice.ranked.empty()) entry.update(to_json(choice.ranked.front()));
  if (choice.ranked.size() > 1) entry["runner_up"] = to_json(choice.ranked[1]);
  if (const auto& other = choice.better_inconsistent) {
    entry["cheaper_inconsistent"] = to_json(*other);
  }
  return entry;
}

/// Whether an observable is one of a scene at all: those of internal energies are not where there
/// are none.
bool is_of_scene(const SceneCells& cells, const std::string& observable) {
  return observable == equilibrium_observable ||
         std::any_of(cells.begin(), cells.end(), [&](const json* cell) {
           return !is_isothermal(*cell) || (*cell)["observables"].contains(observable);
         });
}

json orders_of(const SceneCells& cells, const std::string& scene, const std::string& observable) {
  std::map<std::string, std::vector<Deviation>> deviations;
  for (const json* record : cells) {
    const json& cell = *record;
    if (cell["status"] != "ok") continue;
    const auto& observables = cell["observables"];
    if (!observables.contains(observable)) continue;
    const auto& entry = observables[observable];
    if (!entry.contains("deviation") || entry["status"] != "ok") continue;
    const auto& deviation = entry["deviation"];
    const double value = deviation["value"], lower = deviation["lower"], upper = deviation["upper"];
    if (deviation["below_noise"] || value < rounding) continue;
    deviations[method_label(cell)].push_back(
        {cell["time_step"], value, (upper - lower) / (2 * interval_quantile)});
  }
  json orders = json::array();
  for (const auto& [method, points] : deviations) {
    const auto fit = fit_order(points);
    if (!fit) continue;
    orders.push_back({{"scene", scene},
                      {"method", method},
                      {"observable", observable},
                      {"order", fit->order},
                      {"error", fit->error},
                      {"points", fit->points}});
  }
  return orders;
}

}  // namespace

const std::vector<double>& answer_tolerances() {
  static const std::vector<double> all = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};
  return all;
}

Choice cheapest_within(const json& result, const std::string& scene, const std::string& observable,
                       double tolerance) {
  return cheapest_of(field_of(cells_of(result, scene), scene, observable), tolerance);
}

Choice most_accurate_within(const json& result, const std::string& scene,
                            const std::string& observable, double budget) {
  return choose(
      field_of(cells_of(result, scene), scene, observable),
      [&](const Candidate& candidate) { return candidate.cost <= budget; },
      [](const Candidate& a, const Candidate& b) { return a.bound < b.bound; });
}

std::vector<std::string> judged_observables(const json& result) {
  std::set<std::string> known;
  for (const auto& cell : result["cells"]) {
    for (const auto& [name, entry] : cell["observables"].items()) {
      if (entry.contains("deviation")) known.insert(name);
    }
  }
  std::vector<std::string> names = {equilibrium_observable};
  for (const auto& spec : observable_specs()) {
    if (known.contains(std::string(spec.name))) names.emplace_back(spec.name);
  }
  return names;
}

std::string method_label(const json& cell) {
  std::string text = cell["method"];
  for (const auto& [name, value] : cell["options"].items()) {
    text +=
        fmt::format(", {} {}", name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

std::optional<WorstDeviation> worst_deviation(const json& cell, const std::string& observable) {
  const auto value = largest(cell, observable, "value"), bound = largest(cell, observable, "bound");
  if (!value || !bound) return std::nullopt;
  return WorstDeviation{*value, *bound};
}

void add_answers(json& result) {
  add_deviations(result);
  result["orders"] = json::array();
  result["answers"] = json::array();
  const auto observables = judged_observables(result);
  for (const auto& record : result["scenes"]) {
    const std::string scene = record["name"];
    const SceneCells cells = cells_of(result, scene);
    for (const auto& observable : observables) {
      if (!is_of_scene(cells, observable)) continue;
      for (auto& order : orders_of(cells, scene, observable)) {
        result["orders"].push_back(std::move(order));
      }
      const Field field = field_of(cells, scene, observable);
      for (const double tolerance : answer_tolerances()) {
        result["answers"].push_back(answer(field, tolerance));
      }
    }
  }
}

}  // namespace driftless
