#include "experiments/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "experiments/observables.hpp"
#include "experiments/order_fit.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr double tolerances[] = {0.01, 0.02, 0.05};
constexpr double rounding = 1e-12;  // a deviation below it has no order
const std::vector<std::string> equilibrium_parts = {"kinetic_temperature", "internal_temperature",
                                                    "internal_energy_variance"};

struct Candidate {
  std::string method;
  double time_step, cost, upper;
  bool consistent;
  json to_json() const {
    return {{"method", method}, {"time_step", time_step}, {"cost", cost}, {"upper", upper}};
  }
};

/// Each method's cheapest passing cell, cheapest first.
std::vector<Candidate> passing(const json& cells, const std::string& scene,
                               const std::string& observable, double tolerance) {
  std::map<std::string, Candidate> cheapest;
  for (const auto& cell : cells) {
    if (cell["scene"] != scene || !cell["cost"]["core_seconds_per_time"].is_number()) continue;
    const json upper = passing_bound(cell, observable);
    if (!upper.is_number() || upper.get<double>() > tolerance) continue;
    const Candidate candidate{method_label(cell), cell["time_step"],
                              cell["cost"]["core_seconds_per_time"], upper, cell["consistent"]};
    const auto [known, added] = cheapest.emplace(candidate.method, candidate);
    if (!added && candidate.cost < known->second.cost) known->second = candidate;
  }
  std::vector<Candidate> sorted;
  for (const auto& [method, candidate] : cheapest) sorted.push_back(candidate);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return sorted;
}

std::string subject(const std::string& observable) {
  if (observable == equilibrium_observable) {
    return "temperatures and the variance of the internal energy";
  }
  std::string words = observable;
  std::replace(words.begin(), words.end(), '_', ' ');
  return "the " + words;
}

/// What an answer rests on: the cheapest methods whose limit is the model, and the cheapest method
/// of another limit if that is cheaper still. Right in this study's equilibrium, it need not be
/// elsewhere.
struct Ranking {
  std::vector<Candidate> consistent;
  std::optional<Candidate> cheaper_inconsistent;

  explicit Ranking(const std::vector<Candidate>& passed) {
    for (const auto& candidate : passed) {
      if (candidate.consistent) {
        consistent.push_back(candidate);
      } else if (consistent.empty() && !cheaper_inconsistent) {
        cheaper_inconsistent = candidate;
      }
    }
  }
};

std::string sentence(const std::string& scene, const std::string& observable, double tolerance,
                     const Ranking& ranking) {
  std::string text = fmt::format("For {}, to have {} within {:g} %: ", scene, subject(observable),
                                 100 * tolerance);
  if (ranking.consistent.empty()) {
    text += "no method and step of this study is shown to be";
  } else {
    const auto& best = ranking.consistent.front();
    text +=
        fmt::format("{} at step {:g}, {:.3g} core-seconds per unit time, wrong by at most {:.2g} %",
                    best.method, best.time_step, best.cost, 100 * best.upper);
  }
  if (ranking.consistent.size() > 1) {
    const auto& next = ranking.consistent[1];
    text += fmt::format("; next {} at step {:g}, {:.2g} times the cost", next.method,
                        next.time_step, next.cost / ranking.consistent.front().cost);
  }
  if (const auto& other = ranking.cheaper_inconsistent) {
    text += fmt::format("; {} at step {:g} passes for {:.3g}, but its limit is not the model",
                        other->method, other->time_step, other->cost);
  }
  return text + ".";
}

json answer(const json& cells, const std::string& scene, const std::string& observable,
            double tolerance) {
  const Ranking ranking(passing(cells, scene, observable, tolerance));
  json entry = {{"scene", scene},
                {"observable", observable},
                {"tolerance", tolerance},
                {"method", nullptr},
                {"time_step", nullptr},
                {"cost", nullptr},
                {"upper", nullptr},
                {"runner_up", nullptr},
                {"cheaper_inconsistent", nullptr},
                {"sentence", sentence(scene, observable, tolerance, ranking)}};
  if (!ranking.consistent.empty()) entry.update(ranking.consistent.front().to_json());
  if (ranking.consistent.size() > 1) entry["runner_up"] = ranking.consistent[1].to_json();
  if (const auto& other = ranking.cheaper_inconsistent) {
    entry["cheaper_inconsistent"] = other->to_json();
  }
  return entry;
}

std::vector<std::string> names_of(const json& records) {
  std::vector<std::string> names;
  for (const auto& record : records) names.push_back(record["name"]);
  return names;
}

/// A tolerance in percent means little for a drift or the distance of two distributions.
bool is_relative(std::string_view name) {
  return name != "energy_drift" && !name.ends_with("_distance");
}

/// The observables that some cell of a scene has a deviation for, in the order of their list.
std::vector<std::string> judged_observables(const json& cells, const std::string& scene) {
  std::set<std::string> known;
  for (const auto& cell : cells) {
    if (cell["scene"] != scene) continue;
    for (const auto& [name, entry] : cell["observables"].items()) {
      if (entry.contains("deviation")) known.insert(name);
    }
  }
  std::vector<std::string> names;
  const auto has = [&](const std::string& name) { return known.contains(name); };
  if (std::all_of(equilibrium_parts.begin(), equilibrium_parts.end(), has)) {
    names.emplace_back(equilibrium_observable);
  }
  for (const auto& spec : observable_specs()) {
    if (has(std::string(spec.name))) names.emplace_back(spec.name);
  }
  return names;
}

json orders_of(const json& cells, const std::string& scene, const std::string& observable) {
  std::map<std::string, std::vector<Deviation>> deviations;
  for (const auto& cell : cells) {
    if (cell["scene"] != scene || cell["status"] != "ok") continue;
    const auto& observables = cell["observables"];
    if (!observables.contains(observable)) continue;
    const auto& entry = observables[observable];
    if (!entry.contains("deviation") || entry["status"] != "ok") continue;
    const auto& deviation = entry["deviation"];
    const double value = deviation["value"], lower = deviation["lower"], upper = deviation["upper"];
    if (deviation["below_noise"] || value < rounding) continue;
    deviations[method_label(cell)].push_back(
        {cell["time_step"], value, (upper - lower) / (2 * 1.96)});
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

std::string method_label(const json& cell) {
  std::string text = cell["method"];
  for (const auto& [name, value] : cell["options"].items()) {
    text +=
        fmt::format(", {} {}", name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

json passing_bound(const json& cell, const std::string& observable) {
  if (cell["status"] != "ok") return nullptr;
  const auto bound = [&](const std::string& name) -> json {
    const auto& observables = cell["observables"];
    if (!observables.contains(name)) return nullptr;
    const auto& entry = observables[name];
    if (entry["status"] != "ok" || !entry.contains("deviation")) return nullptr;
    return entry["deviation"]["upper"];
  };
  if (observable != equilibrium_observable) return bound(observable);
  double worst = 0;
  for (const auto& part : equilibrium_parts) {
    const json upper = bound(part);
    if (!upper.is_number()) return nullptr;
    worst = std::max(worst, upper.get<double>());
  }
  return worst;
}

void add_answers(json& result) {
  result["orders"] = json::array();
  result["answers"] = json::array();
  for (const auto& scene : names_of(result["scenes"])) {
    for (const auto& observable : judged_observables(result["cells"], scene)) {
      for (auto& order : orders_of(result["cells"], scene, observable)) {
        result["orders"].push_back(std::move(order));
      }
      if (!is_relative(observable)) continue;
      for (const double tolerance : tolerances) {
        result["answers"].push_back(answer(result["cells"], scene, observable, tolerance));
      }
    }
  }
}

}  // namespace driftless
