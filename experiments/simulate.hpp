#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace driftless {

/// What the command `simulate` is given; what is absent or empty has a default.
struct SimulateArguments {
  std::string scene;   ///< a preset's name, or a JSON file of one scene
  std::string method;  ///< NAME or NAME:option=value,option=value
  double time_step = 0;
  double duration = 0;
  std::string directory;                                ///< of all files that are not named
  std::string trajectory, fields, monitor, checkpoint;  ///< files
  std::optional<double> every;         ///< simulated time between frames of the trajectory
  std::optional<double> sample_every;  ///< and between samples of fields and monitor
  double equilibrate = 0;              ///< simulated time before the first sample of the fields
  std::vector<std::size_t> bins = {8, 8, 8};
  double checkpoint_every = 60;  ///< seconds of wall time
  unsigned threads = 0;          ///< 0: all processors that this process may use
  std::uint64_t seed = 1;
  std::string command;  ///< for the provenance: the command that repeats the run
  bool quiet = false;
};

/// Runs one scene under one method: writes a trajectory, fields, a monitor, a checkpoint, and
/// run.json, which says how they were made. The same arguments again go on from the checkpoint, and
/// so do those of a longer duration with the same periods. Returns what there is to say, in lines.
/// Throws InputError, before anything is written, for arguments that make no sense;
/// LongRunFailure.
std::string simulate(const SimulateArguments& arguments);

}  // namespace driftless
