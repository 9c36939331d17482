#include "experiments/compare/common_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/compare/compare.hpp"
#include "experiments/named_list.hpp"

namespace driftless {
namespace {

using nlohmann::json;

/// Equal, numbers to rounding.
bool alike(const json& one, const json& other) {
  if (!one.is_number() || !other.is_number()) return one == other;
  const double a = one, b = other;
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

bool same_cell(const json& one, const json& other) {
  return one["scene"] == other["scene"] && one["method"] == other["method"] &&
         one["options"] == other["options"] && alike(one["time_step"], other["time_step"]);
}

const json* counterpart(const json& cell, const json& result) {
  for (const auto& other : result["cells"]) {
    if (same_cell(cell, other)) return &other;
  }
  return nullptr;
}

bool is_chosen(const json& cell, const std::string& method) {
  return method.empty() || cell["method"] == method;
}

bool applies(const json* cell) { return cell && (*cell)["status"] != "not_applicable"; }

void require_same_durations(const json& base, const json& changed) {
  const json none = json::object();
  const auto one = base["study"].value("duration", none);
  const auto other = changed["study"].value("duration", none);
  for (const auto& [key, value] : one.items()) {
    const json theirs = other.value(key, json());
    if (alike(value, theirs)) continue;
    throw NotComparable(
        fmt::format("the studies differ in duration.{}: {} in BASE, {} in NEW; only runs of one "
                    "protocol can be compared",
                    key, value.dump(), theirs.dump()));
  }
}

void require_same_scene(const json& base, const json& changed) {
  const json none = json::object();
  const auto one = base.value("parameters", none), other = changed.value("parameters", none);
  for (const auto& [key, value] : one.items()) {
    const json theirs = other.value(key, json());
    if (alike(value, theirs)) continue;
    throw NotComparable(fmt::format("the scenes named \"{}\" differ in {}: {} in BASE, {} in NEW",
                                    base["name"].get<std::string>(), key, value.dump(),
                                    theirs.is_null() ? "none" : theirs.dump()));
  }
}

}  // namespace

CommonCells common_cells(const json& base, const json& changed, const std::string& method) {
  require_same_durations(base, changed);
  for (const auto& scene : base["scenes"]) {
    const json* other = find_named(changed["scenes"], scene["name"]);
    if (other) require_same_scene(scene, *other);
  }
  CommonCells cells;
  for (const auto& cell : base["cells"]) {
    if (!applies(&cell) || !is_chosen(cell, method)) continue;
    const json* other = counterpart(cell, changed);
    if (!applies(other)) {
      cells.missing.push_back(&cell);
      continue;
    }
    cells.common.push_back({find_named(base["scenes"], cell["scene"]),
                            find_named(changed["scenes"], cell["scene"]), &cell, other});
  }
  for (const auto& cell : changed["cells"]) {
    if (applies(&cell) && is_chosen(cell, method) && !applies(counterpart(cell, base)))
      cells.added.push_back(&cell);
  }
  if (cells.common.empty()) {
    throw NotComparable(
        fmt::format("no cell (scene, method, options and time step){} stands in both results",
                    method.empty() ? "" : " of " + method));
  }
  return cells;
}

json cell_identity(const json& cell) {
  json identity;
  for (const char* key : {"scene", "method", "options", "time_step"}) identity[key] = cell[key];
  return identity;
}

std::string cell_name(const json& cell) {
  std::string options;
  for (const auto& [name, value] : cell["options"].items()) {
    options += fmt::format("{}{}={}", options.empty() ? "" : ", ", name,
                           value.is_string() ? value.get<std::string>() : value.dump());
  }
  if (!options.empty()) options = " (" + options + ")";
  return fmt::format("{}, {}{}, step {:g}", cell["scene"].get<std::string>(),
                     cell["method"].get<std::string>(), options, cell["time_step"].get<double>());
}

}  // namespace driftless
