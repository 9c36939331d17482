#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/reproduce/experiment.hpp"

namespace driftless::reproduce {

struct ReproduceOptions {
  std::filesystem::path directory;  ///< gets the report and the finished parts
  Conditions conditions = {};
  unsigned threads = 0;  ///< 0: all processors that it may use
  std::string command;   ///< for the provenance: the command that repeats the run
  bool quiet = false;    ///< no progress on the terminal
};

/// The experiments of a command line, in order, each once: their names, or "all". Throws InputError
/// naming the nearest one.
std::vector<const Experiment*> read_experiments(const std::vector<std::string>& names);

/// Those of `read_experiments` that a method runs in the place of the papers' own. One that it
/// cannot run is left out, with a sentence in `left_out`, if it was asked for by "all" alone; else
/// that sentence is thrown as InputError, as is one if nothing is left.
std::vector<const Experiment*> experiments_run_by(const MethodChoice& method,
                                                  const std::vector<std::string>& names,
                                                  std::vector<std::string>& left_out);

/// Runs the experiments' parts: narrow ones side by side on all threads, then the wide ones, one
/// after the other. A finished part is kept in `directory`/parts at once; the same command run
/// again by the same program takes those up and runs the others. Numbers do not depend on the
/// threads. An experiment of which a part or the conclusion throws is reported with the sentence in
/// "failure", without rows; the others go on. Returns the report ("driftless-papers/1"). Throws
/// InputError if the directory cannot be written.
nlohmann::json run_experiments(const std::vector<const Experiment*>& experiments,
                               const ReproduceOptions& options);

}  // namespace driftless::reproduce
