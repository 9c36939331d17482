#include "experiments/recommend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "experiments/answer_words.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/judge/trade_result.hpp"
#include "experiments/location.hpp"
#include "experiments/nearest.hpp"
#include "experiments/observables.hpp"
#include "experiments/result_file.hpp"
#include "experiments/study.hpp"

namespace driftless {
namespace {

using nlohmann::json;

/// A number above 0 that makes up the whole text.
std::optional<double> positive_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

double read_tolerance(const std::string& text) {
  std::string_view number = text;
  const bool is_percent = number.ends_with('%');
  if (is_percent) number.remove_suffix(1);
  while (is_percent && number.ends_with(' ')) number.remove_suffix(1);
  const auto value = positive_number(number);
  if (!value) {
    throw InputError(
        fmt::format("--tolerance: is \"{}\"; allowed is a number > 0 such as 0.005, or "
                    "a percentage such as 0.5%",
                    printable(text)));
  }
  if (!is_percent && *value >= 1) {
    throw InputError(fmt::format(
        "--tolerance: is \"{0}\", which as a share would be {1:g} %; allowed is a number "
        "> 0 and < 1 such as 0.005, or a percentage such as {0}%",
        printable(text), 100 * *value));
  }
  return is_percent ? *value / 100 : *value;
}

double read_budget(const std::string& text) {
  const auto value = positive_number(text);
  if (!value) {
    throw InputError(fmt::format(
        "--budget: is \"{}\"; allowed is a number > 0 of core-s per unit time, such as 0.05",
        printable(text)));
  }
  return *value;
}

std::string read_observable(const std::string& text) {
  if (text.empty()) return equilibrium_observable;
  std::vector<std::string> names = {equilibrium_observable};
  for (const auto& spec : observable_specs()) names.emplace_back(spec.name);
  if (std::find(names.begin(), names.end(), text) != names.end()) return text;
  throw InputError(fmt::format("--observable: is \"{}\", which is none{}", printable(text),
                               suggestion(text, names)));
}

struct Request {
  std::string observable;
  std::optional<double> tolerance, budget;
};

/// "; 7 of 25 cells failed (negative internal energy 7)", and how many do not resolve it.
std::string left_out(const json& result, const Choice& choice) {
  std::map<std::string, int> causes;
  int run = 0, failed = 0;
  for (const auto& cell : result["cells"]) {
    if (cell["scene"] != choice.scene || cell["status"] == "not_applicable") continue;
    ++run;
    if (cell["status"] == "ok") continue;
    ++failed;
    std::string cause = cell["status"];
    std::replace(cause.begin(), cause.end(), '_', ' ');
    ++causes[cause];
  }
  std::string text;
  const int unresolved = run - failed - choice.cells_compared;
  if (!choice.lacks_exact_value && unresolved > 0) {
    text += fmt::format("; {} of {} cells do not resolve it", unresolved, run);
  }
  if (failed == 0) return text;
  std::string list;
  for (const auto& [cause, count] : causes) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", cause, count);
  }
  return text + fmt::format("; {} of {} cells failed ({})", failed, run, list);
}

std::string sentence(const json& result, const std::string& scene, const Request& request) {
  const Choice choice =
      request.budget ? most_accurate_within(result, scene, request.observable, *request.budget)
                     : cheapest_within(result, scene, request.observable, *request.tolerance);
  std::string text = request.budget ? budget_clause(choice, *request.budget, request.tolerance)
                                    : tolerance_clause(choice, *request.tolerance);
  // Where nothing is found the clause itself says what could be seen.
  if (!choice.ranked.empty()) text += "; " + resolution_text(choice);
  return text + left_out(result, choice) + ".";
}

std::vector<std::string> scenes_of(const json& result) {
  std::vector<std::string> names;
  for (const auto& scene : result["scenes"]) names.push_back(scene["name"]);
  return names;
}

/// Of a result or a judgement.
json read_cells(const std::string& path) {
  const auto judgement = judge::read_judgement(path);
  if (!judgement) return read_result(path);
  json cells = judge::trade_as_result(*judgement);
  if (!cells["cells"].empty()) return cells;
  throw InputError(fmt::format(
      "{}: its judgement has no trade of error against cost; allowed is one with the examination "
      "limits",
      printable(path)));
}

}  // namespace

std::string recommend(const Question& question) {
  Request request{read_observable(question.observable), std::nullopt, std::nullopt};
  if (!question.tolerance.empty()) request.tolerance = read_tolerance(question.tolerance);
  if (!question.budget.empty()) request.budget = read_budget(question.budget);
  if (!request.tolerance && !request.budget) {
    throw InputError("recommend needs --tolerance, such as 0.5%, or --budget");
  }
  std::vector<std::string> known;
  std::string text;
  bool found = false;
  for (const auto& path : question.results) {
    const json result = read_cells(path);
    for (const auto& scene : scenes_of(result)) {
      known.push_back(scene);
      if (!question.scene.empty() && scene != question.scene) continue;
      found = true;
      if (question.results.size() > 1) text += path + ": ";
      text += sentence(result, scene, request) + "\n";
    }
  }
  if (found) return text;
  throw InputError(fmt::format("--scene: is \"{}\", which is none of the results'{}",
                               printable(question.scene), suggestion(question.scene, known)));
}

}  // namespace driftless
