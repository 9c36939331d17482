#include "experiments/judge/limit_cells.hpp"

#include <fmt/format.h>

#include <cmath>

namespace driftless::judge {

using nlohmann::json;

std::optional<LimitValue> LimitCell::value(const std::string& observable) const {
  const auto found = observables.find(observable);
  if (found == observables.end()) return std::nullopt;
  // Blocks are of equal length: weights that followed their errors could follow their values.
  LimitValue sum{0, 0, 0};
  double variance = 0, spread = 0;
  for (const auto& block : *found) {
    const double square = std::pow(block["error"].get<double>(), 2);
    sum.value += block["value"].get<double>();
    variance += square;
    if (block.contains("degrees_of_freedom")) {
      spread += square * square / block["degrees_of_freedom"].get<double>();
    }
  }
  const auto count = static_cast<double>(found->size());
  return LimitValue{
      sum.value / count, std::sqrt(variance) / count,
      spread > 0 ? variance * variance / spread : std::numeric_limits<double>::infinity()};
}

double LimitCell::reference_error(const std::string& observable) const {
  const auto found = observables.find(observable);
  return found == observables.end() ? 0.0 : found->front().value("reference_error", 0.0);
}

std::string part_name(const LimitScene& scene, std::size_t step, unsigned block) {
  return fmt::format("{}, step {:g}, block {}", scene.name, scene.time_steps[step], block + 1);
}

std::string timing_name(const LimitScene& scene) { return scene.name + ", cost"; }

std::vector<LimitCell> limit_cells(const LimitScene& scene, const Records& records) {
  std::vector<LimitCell> cells;
  for (std::size_t step = 0; step < scene.time_steps.size(); ++step) {
    LimitCell cell;
    cell.time_step = scene.time_steps[step];
    json lists = json::object();
    for (unsigned block = 0; block < scene.blocks; ++block) {
      const auto& record = records.at(part_name(scene, step, block));
      cell.runs += record["runs"].get<double>();
      cell.failed += record["failed"].get<double>();
      if (cell.failure.is_null() && record.contains("failure")) cell.failure = record["failure"];
      for (const auto& [name, entry] : record["observables"].items()) lists[name].push_back(entry);
    }
    cell.observables = json::object();
    for (const auto& [name, list] : lists.items()) {
      if (list.size() == scene.blocks) cell.observables[name] = list;
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace driftless::judge
