#include "experiments/compare/cost_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace driftless {
namespace {

using nlohmann::json;

struct Timings {
  double log_ratios = 0;
  std::vector<double> spreads;
};

/// 0 where a cell has no timing.
double seconds(const json& cell) {
  const auto cost = cell.value("cost", json::object());
  const auto value = cost.value("core_seconds_per_time", json());
  return value.is_number() ? value.get<double>() : 0.0;
}

/// Over the cost itself.
double relative_spread(const json& cell) {
  const auto value = cell["cost"].value("spread", json());
  return value.is_number() ? value.get<double>() / seconds(cell) : 0.0;
}

json method_record(const std::string& method, Timings timings) {
  const auto count = timings.spreads.size();
  const double ratio = std::exp(timings.log_ratios / static_cast<double>(count));
  std::sort(timings.spreads.begin(), timings.spreads.end());
  const double typical = timings.spreads[count / 2];
  const double threshold = std::max(0.1, 3 * typical);
  const double away = std::log(ratio);
  return {{"method", method},
          {"cells", count},
          {"ratio", ratio},
          {"spread", typical},
          {"verdict", away > threshold    ? "slower"
                      : away < -threshold ? "faster"
                                          : "same"}};
}

}  // namespace

json cost_changes(const json& base, const json& changed, const std::vector<CommonCell>& cells) {
  for (const char* key : {"cpu", "instructions"}) {
    const auto one = base["provenance"].value(key, ""),
               other = changed["provenance"].value(key, "");
    if (one == other) continue;
    return {{"compared", false},
            {"reason", fmt::format("{} is \"{}\" in BASE, \"{}\" in NEW", key, one, other)}};
  }
  std::map<std::string, Timings> methods;
  for (const auto& cell : cells) {
    const double one = seconds(*cell.base), other = seconds(*cell.changed);
    if (one <= 0 || other <= 0) continue;
    auto& timings = methods[(*cell.base)["method"]];
    timings.log_ratios += std::log(other / one);
    timings.spreads.push_back(
        std::hypot(relative_spread(*cell.base), relative_spread(*cell.changed)));
  }
  json records = json::array();
  for (auto& [method, timings] : methods) records.push_back(method_record(method, timings));
  return {{"compared", true}, {"methods", records}};
}

}  // namespace driftless
