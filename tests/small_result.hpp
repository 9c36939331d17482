#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace driftless {

/// A cell for a result made by hand: kinetic temperature, internal temperature and variance of the
/// internal energy are all off by `off` (of 1), with one standard error `error`.
struct SmallCell {
  std::string method;
  double time_step = 0.01;
  double cost = 1;
  double off = 0;
  double error = 0.001;
  std::string status = "ok";
  bool consistent = true;
};

inline nlohmann::json small_observable(double off, double error) {
  return {{"mean", 1 + off}, {"error", error},        {"effective_samples", 100},
          {"exact", 1},      {"unit", "temperature"}, {"status", "ok"}};
}

inline nlohmann::json small_cell(const std::string& scene, const SmallCell& cell) {
  nlohmann::json record = {{"scene", scene},
                           {"method", cell.method},
                           {"options", nlohmann::json::object()},
                           {"time_step", cell.time_step},
                           {"consistent", cell.consistent},
                           {"status", cell.status},
                           {"replicas", 4},
                           {"failed_replicas", cell.status == "ok" ? 0 : 4},
                           {"conditioned_on_survival", false},
                           {"observables", nlohmann::json::object()},
                           {"failures", nlohmann::json::array()},
                           {"cost", {{"core_seconds_per_time", cell.cost}}}};
  if (cell.status != "ok") return record;
  for (const char* name :
       {"kinetic_temperature", "internal_temperature", "internal_energy_variance"}) {
    record["observables"][name] = small_observable(cell.off, cell.error);
  }
  return record;
}

/// A result without deviations and answers, each scene with the same cells.
inline nlohmann::json small_result(const std::vector<SmallCell>& cells,
                                   const std::vector<std::string>& scenes = {"scene"}) {
  nlohmann::json result = {{"format", "driftless-result/1"},
                           {"name", "small"},
                           {"provenance",
                            {{"version", "0.1.0"},
                             {"commit", "0123abc"},
                             {"dirty", false},
                             {"compiler", "g++"},
                             {"flags", "-O3"},
                             {"cpu", "a CPU"},
                             {"threads", 4},
                             {"seed", 7},
                             {"date", "2024-02-29T12:00:00Z"},
                             {"command", "driftless run small.json"}}},
                           {"study", {{"time_steps", {0.01, 0.02}}}},
                           {"scenes", nlohmann::json::array()},
                           {"methods", nlohmann::json::array()},
                           {"cells", nlohmann::json::array()}};
  for (const auto& scene : scenes) {
    result["scenes"].push_back({{"name", scene}});
    for (const auto& cell : cells) result["cells"].push_back(small_cell(scene, cell));
  }
  return result;
}

}  // namespace driftless
