#include "experiments/reproduce/papers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/files.hpp"
#include "experiments/json_text.hpp"
#include "experiments/named_list.hpp"
#include "experiments/page.hpp"
#include "experiments/study.hpp"
#include "experiments/text_file.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr Verdict verdicts[] = {Verdict::agrees, Verdict::differs, Verdict::not_resolved,
                                Verdict::ours_alone};

std::string text_of(const json& record, const char* key) { return record.value(key, ""); }

/// A cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
    text.insert(at, "\\");
  }
  return text;
}

/// "1.1370 (1.1322 to 1.1418)", "1.137" without error bar, "-" without a value.
std::string interval_text(const json& interval) {
  if (!interval.contains("value")) return "-";
  const double value = interval["value"];
  const double low = interval.value("low", value), high = interval.value("high", value);
  const double reach = std::max(high - value, value - low);
  if (!(reach > 0)) return fmt::format("{:.6g}", value);
  // Two digits of the error, or three where the whole is too small or too large to be written out.
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(reach))));
  if (decimals > 6 || std::abs(value) >= 1e6) {
    return fmt::format("{:.3g} ({:.3g} to {:.3g})", value, low, high);
  }
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", value, decimals, low, decimals, high,
                     decimals);
}

/// The number and the words of "paper" or of "theory".
std::string number_and_words(const json& row, const std::string& of) {
  const std::string number = row.contains(of) ? interval_text(row[of]) : "";
  const std::string words = row.value(of + "_text", "");
  if (number.empty()) return words.empty() ? "-" : words;
  return words.empty() ? number : fmt::format("{}: {}", number, words);
}

bool has_theory(const json& rows) {
  return std::any_of(rows.begin(), rows.end(),
                     [](const json& row) { return row.contains("theory"); });
}

/// "mackie-1999-walls", "mackie-1999-walls, with peters".
std::string with_method(const json& experiment, std::string text) {
  return experiment.contains("method") ? text + ", with " + text_of(experiment, "method") : text;
}

std::string overview(const json& papers) {
  std::string head = "| experiment | source |", rule = "| --- | --- |";
  for (const auto verdict : verdicts) {
    head += fmt::format(" {} |", to_string(verdict));
    rule += " --- |";
  }
  std::string text = head + "\n" + rule + "\n";
  for (const auto& experiment : papers["experiments"]) {
    text += fmt::format("| {} | {} |", with_method(experiment, text_of(experiment, "name")),
                        text_of(experiment, "source"));
    for (const auto verdict : verdicts) {
      std::size_t count = 0;
      for (const auto& row : experiment["rows"]) count += row["verdict"] == to_string(verdict);
      text += experiment.contains("failure") ? " failed |" : fmt::format(" {} |", count);
    }
    text += "\n";
  }
  return text;
}

std::string rows_of(const json& experiment) {
  if (experiment.contains("failure")) {
    return fmt::format("Failed: {}\n", text_of(experiment, "failure"));
  }
  const bool theory = has_theory(experiment["rows"]);
  std::string text = fmt::format(
      "| quantity | setting | paper |{} ours (95 %) | verdict | explanation |\n"
      "| --- | --- | --- |{} --- | --- | --- |\n",
      theory ? " theory |" : "", theory ? " --- |" : "");
  for (const auto& row : experiment["rows"]) {
    const std::string unit = text_of(row, "unit");
    const std::string quantity =
        text_of(row, "quantity") + (unit.empty() || unit == "1" ? "" : ", " + unit);
    const auto beside = [&](const char* of) { return cell(number_and_words(row, of)) + " |"; };
    text += fmt::format("| {} | {} | {}{} {} | {} | {} |\n", cell(quantity),
                        cell(text_of(row, "setting")), beside("paper"),
                        theory ? " " + beside("theory") : "", interval_text(row["ours"]),
                        text_of(row, "verdict"), cell(text_of(row, "explanation")));
  }
  return text;
}

}  // namespace

json united(const std::optional<json>& earlier, json papers) {
  if (!earlier) return papers;
  papers["experiments"] =
      united_by_name(experiments(), papers["experiments"], (*earlier)["experiments"]);
  return papers;
}

std::string papers_summary(const json& papers) {
  std::string text =
      "# The papers' figures and values\n\n"
      "Verdicts are against the paper's value; against theory's where the paper's number is not "
      "known to us.\n\n" +
      overview(papers);
  for (const auto& experiment : papers["experiments"]) {
    text += fmt::format("\n## {}: {}\n\n`{}` (commit {})\n\n{}", text_of(experiment, "source"),
                        with_method(experiment, text_of(experiment, "title")),
                        text_of(experiment, "command"), text_of(experiment, "commit"),
                        rows_of(experiment));
  }
  return text;
}

std::optional<json> read_papers(const std::filesystem::path& file_or_folder) {
  const auto file = std::filesystem::is_directory(file_or_folder) ? file_or_folder / "papers.json"
                                                                  : file_or_folder;
  if (file.filename() != "papers.json" || !std::filesystem::exists(file)) return {};
  auto papers = json::parse(read_text_file(file.string()), nullptr, false);
  if (!papers.is_object() || papers.value("format", json()) != papers_format) {
    throw InputError(fmt::format("{}: is no report of format {}", file.string(), papers_format));
  }
  return papers;
}

std::filesystem::path write_papers(const json& exact, const std::filesystem::path& directory) {
  const json papers = rounded(exact);
  const auto page = directory / "index.html";
  write_atomically(directory / "papers.json", papers.dump() + "\n");
  write_atomically(directory / "summary.md", papers_summary(papers));
  write_atomically(page, render_papers_page(papers));
  return page;
}

}  // namespace driftless::reproduce
