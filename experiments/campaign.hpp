#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/study.hpp"

namespace driftless {

struct CampaignOptions {
  std::filesystem::path directory;  ///< gets the result, its reports, plan.json, finished cells
  unsigned threads = 0;             ///< 0: all processors that it may use
  std::string command;              ///< for the provenance: the command that repeats the run
  bool quiet = false;               ///< no progress on the terminal
};

/// Runs a study: every cell's replicas on all threads, then the timing pass, and writes the result.
/// Each finished cell is kept in `directory`/cells at once; the same study run again by the same
/// program there takes those up and runs the others. Numbers do not depend on the threads. Returns
/// the result. Throws InputError if the directory cannot be written.
nlohmann::json run_campaign(const Study& study, const CampaignOptions& options);

}  // namespace driftless
