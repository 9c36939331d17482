#include "experiments/result_file.hpp"

#include <fmt/format.h>

#include "experiments/answers.hpp"
#include "experiments/files.hpp"
#include "experiments/json_text.hpp"
#include "experiments/study.hpp"
#include "experiments/text_file.hpp"

namespace driftless {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* result_format = "driftless-result/1";

/// Throws json::exception, which names the key, if an object lacks one that answers or reports
/// need.
void require(const json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) (void)object.at(key);
}

void require_observable(const json& entry) {
  require(entry, {"unit", "status"});
  for (const char* key : {"mean", "error"}) (void)entry.at(key).get<double>();
}

void require_parts(const json& result) {
  require(result, {"name", "provenance", "study"});
  require(result["provenance"], {"command", "version", "commit", "cpu", "threads", "date"});
  require(result["study"], {"time_steps"});
  for (const auto& scene : result.at("scenes")) require(scene, {"name"});
  for (const auto& cell : result.at("cells")) {
    require(cell, {"scene", "method", "options", "time_step", "consistent", "status", "replicas",
                   "failed_replicas", "observables"});
    for (const auto& [name, entry] : cell["observables"].items()) require_observable(entry);
  }
}

[[noreturn]] void refuse_unfinished(const fs::path& folder, const Plan& plan) {
  const auto missing = missing_cells(plan, folder);
  const std::string what = missing.empty()
                               ? "the timing of its cells"
                               : fmt::format("{} of {} cells, the first of them {}", missing.size(),
                                             plan.cells.size(), missing.front().name);
  throw InputError(fmt::format("{}: the study there is not finished: {} {} missing; `{}` goes on",
                               folder.string(), what, missing.size() > 1 ? "are" : "is",
                               plan.command));
}

}  // namespace

json read_result(const fs::path& file_or_folder) {
  const bool is_folder = fs::is_directory(file_or_folder);
  const fs::path file = is_folder ? file_or_folder / "result.json" : file_or_folder;
  if (is_folder) {
    const auto plan = read_plan(file_or_folder);
    if (plan && !plan->finished) refuse_unfinished(file_or_folder, *plan);
  }
  json result = parse_json_text(read_text_file(file.string()), file.string());
  if (!result.is_object() || result.value("format", json()) != result_format) {
    throw InputError(fmt::format("{}: is not a result of format {}", file.string(), result_format));
  }
  try {
    require_parts(result);
    add_answers(result);
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: is not a whole result of format {} ({})", file.string(),
                                 result_format, error.what()));
  }
  return result;
}

void write_plan(const Plan& plan, const fs::path& folder) {
  json cells = json::array();
  for (const auto& cell : plan.cells) cells.push_back({{"name", cell.name}, {"file", cell.file}});
  const json object = {{"program", plan.program},
                       {"command", plan.command},
                       {"finished", plan.finished},
                       {"cells", std::move(cells)}};
  write_atomically(folder / "plan.json", object.dump(1) + "\n");
}

void finish_plan(const fs::path& folder) {
  auto plan = read_plan(folder);
  if (!plan || plan->finished) return;
  plan->finished = true;
  write_plan(*plan, folder);
}

std::optional<Plan> read_plan(const fs::path& folder) {
  const auto file = folder / "plan.json";
  if (!fs::exists(file)) return std::nullopt;
  try {
    const json object = json::parse(read_text_file(file.string()));
    Plan plan{object.at("program"), object.at("command"), {}, object.at("finished")};
    for (const auto& cell : object.at("cells")) {
      plan.cells.push_back({cell.at("name"), cell.at("file")});
    }
    return plan;
  } catch (const json::exception&) {
    return std::nullopt;  // torn, as a dying disk would leave it
  }
}

std::vector<Plan::Cell> missing_cells(const Plan& plan, const fs::path& folder) {
  std::vector<Plan::Cell> missing;
  for (const auto& cell : plan.cells) {
    if (!fs::exists(folder / "cells" / cell.file)) missing.push_back(cell);
  }
  return missing;
}

}  // namespace driftless
