#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Long runs cut into parts, each kept on disk once it is finished and taken up again by the same
/// command.
namespace driftless {

/// What a part may use while it runs.
struct PartPlace {
  unsigned threads = 1;              ///< all for a part that runs alone, else 1
  std::filesystem::path checkpoint;  ///< a file of its own, removed once the part is finished
  bool tells_steps = false;          ///< it runs alone and may tell on standard error how far it is
};

/// A share of a run: a pure function of its identity, whatever the threads.
struct KeptPart {
  std::string name;         ///< for progress
  nlohmann::json identity;  ///< all that the record depends on, but the program
  double cost;              ///< predicted, in any unit that all parts of a run share
  bool alone = false;       ///< runs by itself, on all threads
  std::function<nlohmann::json(const PartPlace&)> run;  ///< null if it failed: that is not kept
  nlohmann::json record = nullptr;                      ///< null until finished
};

struct KeptRun {
  std::filesystem::path directory;  ///< finished parts are in `directory`/parts
  unsigned threads;
  std::string command;  ///< that goes on after an interrupt
  bool quiet = false;   ///< no progress on the terminal
};

/// The record kept in a file, null if there is none that is whole.
nlohmann::json kept_record(const std::filesystem::path& file);

/// Gives every part its record: taken up if the same program has kept it, else run. Parts side by
/// side first, one thread each, the longest first; then those that run alone. Each finished part is
/// kept at once; an interrupt ends the program with a sentence that says how to go on. What a part
/// throws ends the run. Throws InputError if the directory cannot be written.
void run_kept_parts(std::vector<KeptPart>& parts, const KeptRun& run);

}  // namespace driftless
