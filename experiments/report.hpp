#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace driftless {

/// The result as Markdown for terminals and pull requests: the answers, and per scene the worst
/// error of every method at every step, with its cost and what failed.
std::string summary(const nlohmann::json& result);

/// Writes result.json, index.html (the page) and summary.md into a folder, whose plan is finished
/// then; returns the page's path.
/// Throws InputError if they cannot be written.
std::filesystem::path write_report(const nlohmann::json& result,
                                   const std::filesystem::path& directory);

}  // namespace driftless
