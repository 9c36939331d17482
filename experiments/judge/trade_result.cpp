#include "experiments/judge/trade_result.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "experiments/deviations.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

double normal_quantile(double tail) {
  return student_quantile(std::numeric_limits<double>::infinity(), tail);
}

/// Whether no finding of the method's limits in a scene says otherwise.
bool is_consistent(const json& method, const std::string& scene) {
  const auto& findings = method["conclusions"]["limits"]["findings"];
  return std::all_of(findings.begin(), findings.end(), [&](const json& finding) {
    if (!finding["subject"].get<std::string>().ends_with(", " + scene)) return true;
    return finding["claimed"] == true && finding["verdict"] != "fails";
  });
}

/// A point's deviation, with bounds that hold for `competitors` cells at once.
json deviation_of(const json& point, const std::string& observable, double competitors) {
  const double tail = std::min(0.025, (1 - bounds_level) / competitors);
  const double widening = normal_quantile(tail) / interval_quantile;
  const double value = point["error"], upper = point["upper"];
  json record = {{"value", value}, {"lower", point["lower"]}, {"upper", upper}};
  // Distances are known by their squares.
  if (observable.ends_with("_distance")) {
    const double reach = widening * (upper * upper - value * value);
    record["bound"] = std::sqrt(value * value + reach);
    record["resolution"] = std::sqrt(reach);
  } else {
    const double reach = widening * (upper - value);
    record["bound"] = value + reach;
    record["resolution"] = reach;
  }
  return record;
}

}  // namespace

json trade_as_result(const json& judgement) {
  json result = {{"scenes", json::array()}, {"cells", json::array()}};
  std::map<std::tuple<std::string, std::string, double>, std::size_t> places;
  const auto cell_of = [&](const std::string& scene, const json& point) -> json& {
    const std::string method = point["method"];
    const auto [place, added] = places.emplace(
        std::tuple(scene, method, point["time_step"].get<double>()), result["cells"].size());
    if (!added) return result["cells"][place->second];
    const auto& methods = judgement["methods"];
    const auto record = std::find_if(methods.begin(), methods.end(),
                                     [&](const json& one) { return one["name"] == method; });
    return result["cells"].emplace_back(json{{"scene", scene},
                                             {"method", method},
                                             {"options", json::object()},  // the name has them
                                             {"time_step", point["time_step"]},
                                             {"consistent", is_consistent(*record, scene)},
                                             {"status", "ok"},
                                             {"cost", {{"core_seconds_per_time", point["cost"]}}},
                                             {"observables", json::object()}});
  };
  for (const auto& entry : judgement["trade"]) {
    const std::string scene = entry["scene"], observable = entry["observable"];
    const json named = {{"name", scene}};
    auto& scenes = result["scenes"];
    if (std::find(scenes.begin(), scenes.end(), named) == scenes.end()) scenes.push_back(named);
    const auto competitors = static_cast<double>(entry["points"].size());
    for (const auto& point : entry["points"]) {
      cell_of(scene, point)["observables"][observable]["deviation"] =
          deviation_of(point, observable, competitors);
    }
  }
  return result;
}

}  // namespace driftless::judge
