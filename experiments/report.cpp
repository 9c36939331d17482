#include "experiments/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "experiments/answer_words.hpp"
#include "experiments/answers.hpp"
#include "experiments/deviations.hpp"
#include "experiments/files.hpp"
#include "experiments/page.hpp"
#include "experiments/result_file.hpp"

namespace driftless {
namespace {

using nlohmann::json;

using Row = std::vector<std::string>;

/// A Markdown table, its columns padded so that a terminal shows it straight.
std::string table(const Row& head, const std::vector<Row>& rows) {
  std::vector<std::size_t> width;
  for (const auto& cell : head) width.push_back(cell.size());
  for (const auto& row : rows) {
    for (std::size_t n = 0; n < row.size(); ++n) width[n] = std::max(width[n], row[n].size());
  }
  std::string text;
  const auto line = [&](const Row& row) {
    for (std::size_t n = 0; n < row.size(); ++n) text += fmt::format("| {:<{}} ", row[n], width[n]);
    text += "|\n";
  };
  line(head);
  for (const auto columns : width) text += "| " + std::string(columns, '-') + " ";
  text += "|\n";
  for (const auto& row : rows) line(row);
  return text;
}

/// The tolerances that a summary has lines for.
bool is_summed_up(double tolerance) { return tolerance >= 0.01 && tolerance <= 0.05; }

std::string step_text(const json& step) { return fmt::format("{:g}", step.get<double>()); }

/// The energy drift of the cell that an answer names.
std::string drift_text(const json& result, const json& answer) {
  for (const auto& cell : result["cells"]) {
    const bool named = cell["scene"] == answer["scene"] && method_label(cell) == answer["method"] &&
                       cell["time_step"] == answer["time_step"];
    if (!named || !cell["observables"].contains("energy_drift")) continue;
    const auto& drift = cell["observables"]["energy_drift"];
    return fmt::format("{:.1e} +- {:.0e}", drift["mean"].get<double>(),
                       drift["error"].get<double>());
  }
  return "";
}

bool is_isothermal(const json& result, const std::string& scene) {
  const auto& cells = result["cells"];
  return std::any_of(cells.begin(), cells.end(), [&](const json& cell) {
    return cell["scene"] == scene && cell.value("isothermal", false);
  });
}

/// Why an answer table is empty, or what it says.
std::string about_answers(bool isothermal, int compared) {
  if (compared == 0) {
    return isothermal
               ? "No cell resolves the kinetic temperature against an exact value.\n"
               : "No cell resolves kinetic temperature, internal temperature and variance of the "
                 "internal\nenergy against exact values.\n";
  }
  const std::string what =
      isothermal ? "Cheapest method and step whose kinetic temperature is\nshown to be"
                 : "Cheapest method and step whose kinetic temperature, internal temperature and "
                   "variance of the internal\nenergy are all shown to be";
  return fmt::format(
      "{} within the tolerance. The bounds of all {} cells compared hold at once, at\n{:g} % "
      "confidence, so that the choice among them costs nothing of it:\n\n",
      what, compared, 100 * bounds_level);
}

std::string answers_of(const json& result, const std::string& scene) {
  const bool isothermal = is_isothermal(result, scene);
  std::vector<Row> rows;
  std::string beside, last;  // cheaper methods of another limit
  int compared = 0;
  for (const auto& answer : result["answers"]) {
    if (answer["scene"] != scene || answer["observable"] != equilibrium_observable ||
        !is_summed_up(answer["tolerance"])) {
      continue;
    }
    compared = answer["cells_compared"];
    Row row = {tolerance_text(equilibrium_observable, answer["tolerance"])};
    if (answer["method"].is_null()) {
      row.insert(row.end(), {"none shown to be", "", "", "", "", ""});
    } else {
      const auto& next = answer["runner_up"];
      row.insert(
          row.end(),
          {answer["method"], step_text(answer["time_step"]),
           bound_text(equilibrium_observable, answer["upper"]),
           fmt::format("{:.3g}", answer["cost"].get<double>()), drift_text(result, answer),
           next.is_null() ? "none"
                          : fmt::format("{} at {}, {:.3g}", next["method"].get<std::string>(),
                                        step_text(next["time_step"]), next["cost"].get<double>())});
    }
    rows.push_back(row);
    const auto& other = answer["cheaper_inconsistent"];
    if (other.is_null() || other.dump() == last) continue;
    last = other.dump();
    beside += fmt::format(
        "\nFrom {} on, {} at step {} passes for {:.3g}, but its limit is not the model.\n",
        tolerance_text(equilibrium_observable, answer["tolerance"]),
        other["method"].get<std::string>(), step_text(other["time_step"]),
        other["cost"].get<double>());
  }
  if (compared == 0) return about_answers(isothermal, compared);
  Row head = {"tolerance",
              "method",
              "step",
              "wrong by at most",
              "core-s per unit time",
              "energy drift, kT per particle and unit time",
              "runner-up"};
  if (isothermal) {  // energy comes and goes with the bath
    constexpr int drift = 5;
    head.erase(head.begin() + drift);
    for (auto& row : rows) row.erase(row.begin() + drift);
  }
  return about_answers(isothermal, compared) + table(head, rows) + beside;
}

/// What a map of methods and steps says of a cell.
std::string verdict(const json& cell) {
  if (cell["status"] == "not_applicable") return "not applicable";
  if (cell["status"] != "ok") {
    return fmt::format("{} ({} of {})", cell["status"].get<std::string>(),
                       cell["failed_replicas"].get<int>(), cell["replicas"].get<int>());
  }
  const auto worst = worst_deviation(cell, equilibrium_observable);
  if (!worst) return "not resolved";
  return fmt::format("{} (<= {})", percent(worst->value),
                     bound_text(equilibrium_observable, worst->bound));
}

std::string map_of(const json& result, const std::string& scene) {
  Row head = {"method"};
  for (const auto& step : result["study"]["time_steps"]) head.push_back(step_text(step));
  std::vector<Row> rows;
  std::string last;
  for (const auto& cell : result["cells"]) {
    if (cell["scene"] != scene) continue;
    const std::string name = method_label(cell);
    if (rows.empty() || name != last) rows.push_back({name});
    last = name;
    rows.back().push_back(verdict(cell));
  }
  return table(head, rows);
}

/// "failed: 5 of 25 cells (negative_internal_energy 5)".
std::string failures_of(const json& result, const std::string& scene) {
  std::map<std::string, int> causes;
  int failed = 0, run = 0;
  for (const auto& cell : result["cells"]) {
    if (cell["scene"] != scene || cell["status"] == "not_applicable") continue;
    ++run;
    if (cell["status"] == "ok") continue;
    ++failed;
    ++causes[cell["status"]];
  }
  std::string text = fmt::format("Failed: {} of {} cells", failed, run);
  std::string list;
  for (const auto& [cause, count] : causes) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", cause, count);
  }
  return list.empty() ? text : fmt::format("{} ({})", text, list);
}

}  // namespace

std::string summary(const json& result) {
  const auto& provenance = result["provenance"];
  std::string text = fmt::format("# {}\n", result["name"].get<std::string>());
  for (const auto& scene : result["scenes"]) {
    const std::string name = scene["name"];
    text += fmt::format("\n## {}\n\n", name);
    if (scene.contains("note"))
      text += fmt::format("Note: {}.\n\n", scene["note"].get<std::string>());
    text += answers_of(result, name) +
            (is_isothermal(result, name) ? "\nThe error" : "\nThe largest of these errors") +
            std::string(", and in brackets what it is at most, by method and step:\n\n") +
            map_of(result, name);
    text += "\n" + failures_of(result, name) + ".\n";
  }
  text += fmt::format(
      "\nMade by `{}`, driftless {} ({}), {}, {} threads, {}.\n",
      provenance["command"].get<std::string>(), provenance["version"].get<std::string>(),
      provenance["commit"].get<std::string>().substr(0, 7), provenance["cpu"].get<std::string>(),
      provenance["threads"].get<int>(), provenance["date"].get<std::string>());
  return text;
}

std::filesystem::path write_report(const json& result, const std::filesystem::path& directory) {
  const auto page = directory / "index.html";
  write_atomically(directory / "result.json", result.dump(1) + "\n");
  write_atomically(directory / "summary.md", summary(result));
  write_atomically(page, render_page(result));
  finish_plan(directory);
  return page;
}

}  // namespace driftless
