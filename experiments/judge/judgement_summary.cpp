#include <fmt/format.h>

#include "experiments/files.hpp"
#include "experiments/json_text.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/page.hpp"
#include "experiments/text_file.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

std::string verdict_table(const json& judgement) {
  std::string head = "| method |", rule = "| --- |";
  for (const auto& examination : judgement["examinations"]) {
    head += fmt::format(" {} |", examination["name"].get<std::string>());
    rule += " --- |";
  }
  std::string text = head + "\n" + rule + "\n";
  for (const auto& method : judgement["methods"]) {
    text += fmt::format("| {} |", method["name"].get<std::string>());
    for (const auto& examination : judgement["examinations"]) {
      const auto& conclusion = method["conclusions"][examination["name"].get<std::string>()];
      text += fmt::format(" {} |", conclusion["verdict"].get<std::string>());
    }
    text += "\n";
  }
  return text;
}

/// The command and the commit of every examination, those alike together.
std::string origins(const json& judgement) {
  std::vector<std::pair<std::string, std::string>> all;  // origin, names
  for (const auto& examination : judgement["examinations"]) {
    const auto name = examination["name"].get<std::string>();
    const auto origin = fmt::format("`{}` (commit {})", examination["command"].get<std::string>(),
                                    examination["commit"].get<std::string>().substr(0, 7));
    if (!all.empty() && all.back().first == origin) {
      all.back().second += ", " + name;
    } else {
      all.emplace_back(origin, name);
    }
  }
  std::string text;
  for (const auto& [origin, names] : all) text += fmt::format("- {}: {}\n", names, origin);
  return text;
}

/// What fails, one line each; where the method claims the contrary it is said.
std::string failures(const json& judgement) {
  std::string text;
  for (const auto& method : judgement["methods"]) {
    for (const auto& examination : judgement["examinations"]) {
      const auto name = examination["name"].get<std::string>();
      for (const auto& finding : method["conclusions"][name]["findings"]) {
        if (finding["verdict"] != "fails") continue;
        text += fmt::format("- {}, {}: {}{}\n", method["name"].get<std::string>(), name,
                            finding["sentence"].get<std::string>(),
                            finding.value("claimed", false) ? " (claimed otherwise)" : "");
      }
    }
  }
  return text.empty() ? "Nothing fails.\n" : text;
}

}  // namespace

std::optional<json> read_judgement(const std::filesystem::path& file_or_folder) {
  const auto file = std::filesystem::is_directory(file_or_folder)
                        ? file_or_folder / "judgement.json"
                        : file_or_folder;
  if (file.filename() != "judgement.json" || !std::filesystem::exists(file)) return {};
  auto judgement = json::parse(read_text_file(file.string()), nullptr, false);
  if (!judgement.is_object() || judgement.value("format", "") != judgement_format) {
    throw InputError(
        fmt::format("{}: is no judgement of format {}", file.string(), judgement_format));
  }
  // Judgements whose examinations were all made at once said it once.
  for (auto& examination : judgement["examinations"]) {
    if (examination.contains("depth")) continue;
    examination["depth"] = judgement["depth"];
    for (const char* key : {"commit", "command"}) {
      examination[key] = judgement["provenance"][key];
    }
  }
  return judgement;
}

std::string judgement_summary(const json& judgement) {
  return fmt::format("# Judgement ({})\n\n{}\n{}\n## What fails\n\n{}",
                     judgement["depth"].get<std::string>(), origins(judgement),
                     verdict_table(judgement), failures(judgement));
}

std::filesystem::path write_judgement(const json& exact, const std::filesystem::path& directory) {
  const json judgement = rounded(exact);
  const auto page = directory / "index.html";
  write_atomically(directory / "judgement.json", judgement.dump() + "\n");
  write_atomically(directory / "summary.md", judgement_summary(judgement));
  write_atomically(page, render_judgement_page(judgement));
  return page;
}

}  // namespace driftless::judge
