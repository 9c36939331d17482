#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace driftless {

/// Reads a result (or the result.json of a folder) and draws its answers anew, by this program's
/// rule. Throws InputError in one sentence if there is none, if it is none, or if the folder's
/// study is not finished yet: then the sentence says what is missing.
nlohmann::json read_result(const std::filesystem::path& file_or_folder);

/// What a study's folder says of the run that was last started there, in plan.json.
struct Plan {
  struct Cell {
    std::string name;  ///< scene, method and step
    std::string file;  ///< in cells/
  };
  std::string program;  ///< its fingerprint: cells of another one are not taken up
  std::string command;  ///< repeats, or continues, the run
  std::vector<Cell> cells;
  bool finished = false;  ///< the whole run
};
void write_plan(const Plan& plan, const std::filesystem::path& folder);
/// Says in the folder's plan, if it has one, that its run is finished and the result written.
void finish_plan(const std::filesystem::path& folder);
/// Nothing if there is none that can be read.
std::optional<Plan> read_plan(const std::filesystem::path& folder);
/// The cells of a plan that are not finished.
std::vector<Plan::Cell> missing_cells(const Plan& plan, const std::filesystem::path& folder);

}  // namespace driftless
