#include "experiments/compare/compare_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "experiments/answer_words.hpp"
#include "experiments/compare/common_cells.hpp"

namespace driftless {
namespace {

using nlohmann::json;

/// Shares in percent, other effects as they are.
std::string effect_text(const json& test, const char* key) {
  const double effect = test[key];
  return test["share"] ? percent(effect) : fmt::format("{:.2g}", effect);
}

std::string number(const json& value) { return fmt::format("{:.6g}", value.get<double>()); }

/// A row of the table of changes; of failures or conservation there is no error.
std::vector<std::string> row_of(const json& cell, const json& test) {
  const bool counted = test["kind"] == "failures";
  const auto side = [&](const char* key) {
    return counted ? fmt::format("{} of {}", test[key].get<unsigned>(),
                                 test[std::string(key) + "_replicas"].get<unsigned>())
                   : number(test[key]);
  };
  const bool measured = test["kind"] == "mean";
  return {test["verdict"],
          cell_name(cell),
          test["observable"],
          side("base"),
          side("new"),
          measured ? fmt::format("{:+.3g} +- {:.2g}", test["difference"].get<double>(),
                                 test["error"].get<double>())
                   : "",
          measured ? effect_text(test, "effect") : "",
          test.contains("adjusted_probability")
              ? fmt::format("{:.1e}", test["adjusted_probability"].get<double>())
              : "",
          test.value("reason", "")};
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t n = 0; n < row.size(); ++n) widths[n] = std::max(widths[n], row[n].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t n = 0; n < row.size(); ++n) line += fmt::format("{:<{}}  ", row[n], widths[n]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text + "\n";
}

/// Of what has too little data, only failures are listed.
bool may_matter(const json& test) {
  return test["verdict"] != "too_little_data" || test["kind"] == "failures";
}

std::string changes(const json& comparison) {
  std::vector<std::vector<std::string>> rows = {{"verdict", "cell", "observable", "BASE", "NEW",
                                                 "difference", "effect", "adjusted p", "why"}};
  for (const char* verdict : {"worse", "better", "too_little_data"}) {
    for (const auto& cell : comparison["cells"]) {
      for (const auto& test : cell["tests"]) {
        if (test["verdict"] == verdict && may_matter(test)) rows.push_back(row_of(cell, test));
      }
    }
  }
  return rows.size() > 1 ? table(rows) : "";
}

std::string counts_line(const json& counts, const char* of) {
  const auto& all = counts[of];
  return fmt::format("{}: {} same, {} better, {} worse, {} with too little data\n", of,
                     all["same"].get<int>(), all["better"].get<int>(), all["worse"].get<int>(),
                     all["too_little_data"].get<int>());
}

/// What each observable's tests would have found: the range over cells.
std::string sight(const json& comparison) {
  std::map<std::string, std::pair<const json*, const json*>> ranges;  // least and most detectable
  for (const auto& cell : comparison["cells"]) {
    for (const auto& test : cell["tests"]) {
      if (!test.contains("detectable")) continue;
      auto& [least, most] = ranges.try_emplace(test["observable"], &test, &test).first->second;
      if (test["detectable"] < (*least)["detectable"]) least = &test;
      if (test["detectable"] > (*most)["detectable"]) most = &test;
    }
  }
  std::string text;
  for (const auto& [observable, range] : ranges) {
    text += fmt::format("  {:<28} {} to {}\n", observable, effect_text(*range.first, "detectable"),
                        effect_text(*range.second, "detectable"));
  }
  if (text.empty()) return "";
  return "Effects that a cell finds with 95 % probability, by observable:\n" + text;
}

std::string cells_line(const json& cells, const std::string& where) {
  if (cells.empty()) return "";
  return fmt::format("{} {} in {} alone, the first of them {}\n", cells.size(),
                     cells.size() > 1 ? "cells stand" : "cell stands", where,
                     cell_name(cells.front()));
}

std::string cost_lines(const json& cost) {
  if (!cost["compared"].get<bool>()) {
    return fmt::format("Times are not compared: {}.\n", cost["reason"].get<std::string>());
  }
  std::string text;
  for (const auto& method : cost["methods"]) {
    if (method["verdict"] == "same") continue;
    text += fmt::format("  {} is {}: {:.2f} times BASE's processor time (spread {})\n",
                        method["method"].get<std::string>(), method["verdict"].get<std::string>(),
                        method["ratio"].get<double>(), percent(method["spread"]));
  }
  if (text.empty()) return "Times: no method is slower or faster by 10 %.\n";
  return "Times (a hint; they are no part of the verdict):\n" + text;
}

std::string sentence(const json& comparison) {
  const auto& cells = comparison["counts"]["cells"];
  const int worse = cells["worse"], better = cells["better"], blind = cells["too_little_data"];
  const int blind_tests = comparison["counts"]["tests"]["too_little_data"];
  const std::string level =
      fmt::format("at a family level of {:g} over {} tests",
                  comparison["family_level"].get<double>(), comparison["tests"].get<std::size_t>());
  if (comparison["verdict"] == "too_little_data") {
    return fmt::format(
        "NEW cannot be called the same as BASE, nor worse, {}: {} of them have too little data; "
        "more "
        "replicas would tell.\n",
        level, blind_tests);
  }
  std::string text = fmt::format("NEW is {} BASE", worse > 0    ? "worse than"
                                                   : better > 0 ? "better than"
                                                                : "the same as");
  const auto total = comparison["cells"].size();
  if (worse > 0) text += fmt::format(" in {} of {} cells", worse, total);
  if (better > 0)
    text += fmt::format("{} in {}{}", worse > 0 ? ", better" : "", better,
                        worse > 0 ? "" : fmt::format(" of {} cells", total));
  text += ", " + level;
  if (blind > 0) {
    text +=
        fmt::format("; {} {} too little data for an effect of {} in every observable", blind,
                    blind > 1 ? "cells have" : "cell has", percent(comparison["wanted_effect"]));
  }
  return text + ".\n";
}

}  // namespace

std::string comparison_text(const json& comparison) {
  return changes(comparison) + cells_line(comparison["missing"], "BASE") +
         cells_line(comparison["added"], "NEW") + counts_line(comparison["counts"], "tests") +
         counts_line(comparison["counts"], "cells") + sight(comparison) +
         cost_lines(comparison["cost"]) + sentence(comparison);
}

}  // namespace driftless
