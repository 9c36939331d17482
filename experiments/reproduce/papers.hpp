#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/reproduce/experiment.hpp"

/// The report of reproduced experiments: papers.json, its page and its summary.
namespace driftless::reproduce {

inline constexpr const char* papers_format = "driftless-papers/1";

/// Rows, pictures and remarks as in papers.json. Never holds NaN or infinity: an interval lacks
/// what is not finite, a list has null in its place.
nlohmann::json to_json(const Outcome& outcome);

/// The report as Markdown: per experiment how many values agree, then every row.
std::string papers_summary(const nlohmann::json& papers);

/// A report with the experiments of an earlier one that it does not have itself, in the order of
/// all experiments. One run under another method is another experiment.
nlohmann::json united(const std::optional<nlohmann::json>& earlier, nlohmann::json papers);

/// The report of a folder, if that is what the folder (or the file) holds. Throws InputError if it
/// cannot be read.
std::optional<nlohmann::json> read_papers(const std::filesystem::path& file_or_folder);

/// Writes papers.json, index.html (the page) and summary.md into a folder, numbers to six digits,
/// which is more than any of them is known to; returns the page's path. Throws InputError if they
/// cannot be written.
std::filesystem::path write_papers(const nlohmann::json& papers,
                                   const std::filesystem::path& directory);

}  // namespace driftless::reproduce
