#include "experiments/judge/trade.hpp"

#include <algorithm>
#include <limits>

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr const char* title = "Error against cost";

/// The entry of a scene and observable, made if there is none yet.
json& entry_of(json& trade, const json& scene, const json& observable) {
  for (auto& entry : trade) {
    if (entry["scene"] == scene && entry["observable"] == observable) return entry;
  }
  return trade.emplace_back(
      json{{"scene", scene}, {"observable", observable}, {"points", json::array()}});
}

void add_method(const json& method, const json& table, json& trade) {
  for (const auto& row : table["rows"]) {
    entry_of(trade, row[0], row[1])["points"].push_back({{"method", method["name"]},
                                                         {"time_step", row[2]},
                                                         {"cost", row[3]},
                                                         {"error", row[4]},
                                                         {"lower", row[5]},
                                                         {"upper", row[6]}});
  }
}

void mark_front(json& points) {
  std::stable_sort(points.begin(), points.end(), [](const json& a, const json& b) {
    return a["cost"].get<double>() < b["cost"].get<double>();
  });
  double smallest = std::numeric_limits<double>::infinity();
  for (auto& point : points) {
    point["on_front"] = point["upper"].get<double>() < smallest;
    point["dominated"] = smallest < point["lower"].get<double>();
    smallest = std::min(smallest, point["upper"].get<double>());
  }
}

}  // namespace

Table empty_trade_table() {
  return {title,
          {"scene", "observable", "time step", "core-seconds per unit time", "deviation", "lower",
           "upper"},
          {}};
}

json trade_front(const json& judgement) {
  json trade = json::array();
  for (const auto& method : judgement["methods"]) {
    for (const auto& [name, conclusion] : method["conclusions"].items()) {
      for (const auto& table : conclusion["tables"]) {
        if (table["title"] == title) add_method(method, table, trade);
      }
    }
  }
  for (auto& entry : trade) mark_front(entry["points"]);
  return trade;
}

}  // namespace driftless::judge
