#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace driftless {

/// A scene, method, options and time step that two results have in common.
struct CommonCell {
  const nlohmann::json* base_scene;
  const nlohmann::json* new_scene;
  const nlohmann::json* base;
  const nlohmann::json* changed;
};

/// The cells of two results, in BASE's order; a cell whose method does not apply is none.
struct CommonCells {
  std::vector<CommonCell> common;
  std::vector<const nlohmann::json*> missing;  ///< BASE has them alone
  std::vector<const nlohmann::json*> added;    ///< NEW has them alone
};

/// Of one method, or of all if `method` is empty. Throws NotComparable if durations or the
/// parameters of common scenes differ or no cell is common.
CommonCells common_cells(const nlohmann::json& base, const nlohmann::json& changed,
                         const std::string& method);

/// {scene, method, options, time_step} of a cell.
nlohmann::json cell_identity(const nlohmann::json& cell);
/// "mackie-1999, shardlow-s1 (order=ids), step 0.02".
std::string cell_name(const nlohmann::json& cell);

}  // namespace driftless
