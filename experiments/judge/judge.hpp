#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/examination.hpp"

namespace driftless::judge {

inline constexpr const char* judgement_format = "driftless-judgement/1";

struct JudgeOptions {
  std::filesystem::path directory;  ///< gets the judgement, its reports and the finished parts
  Conditions conditions = {};
  unsigned threads = 0;  ///< 0: all processors that it may use
  std::string command;   ///< for the provenance: the command that repeats the run
  bool quiet = false;    ///< no progress on the terminal
};

/// The candidates of a command line, in order: "NAME", "NAME:option=value,option=value", or "all"
/// for every method with its default options. Throws InputError.
std::vector<Candidate> read_candidates(const std::vector<std::string>& texts);

/// The one method of an option --method. Throws InputError.
MethodChoice read_method_option(const std::string& text);

/// The examinations of these names, all if there is none. Throws InputError.
std::vector<const Examination*> read_examinations(const std::vector<std::string>& names);

/// Runs the examinations' parts for all candidates on all threads, each part on one. A finished
/// part is kept in `directory`/parts at once; the same command run again by the same program takes
/// those up and runs the others. Numbers do not depend on the threads. Returns the judgement
/// ("driftless-judgement/1"). Throws InputError if the directory cannot be written.
nlohmann::json run_judgement(const std::vector<Candidate>& candidates,
                             const std::vector<const Examination*>& examinations,
                             const JudgeOptions& options);

/// A judgement with those examinations that it lacks from an earlier one of the same methods, each
/// of which says by which command it was made; of other methods nothing is taken.
nlohmann::json united(const nlohmann::json& earlier, nlohmann::json judgement);

/// The judgement as Markdown: per method and examination the verdict, then every finding that
/// fails.
std::string judgement_summary(const nlohmann::json& judgement);

/// The judgement of a folder, if that is what the folder (or the file) holds. Throws InputError if
/// it cannot be read.
std::optional<nlohmann::json> read_judgement(const std::filesystem::path& file_or_folder);

/// Writes judgement.json, index.html (the page) and summary.md into a folder, numbers to six
/// digits, which is more than any of them is known to; returns the page's path.
/// Throws InputError if they cannot be written.
std::filesystem::path write_judgement(const nlohmann::json& judgement,
                                      const std::filesystem::path& directory);

}  // namespace driftless::judge
