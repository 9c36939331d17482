#pragma once

#include <filesystem>

#include "experiments/fields.hpp"
#include "experiments/simulate.hpp"
#include "experiments/study.hpp"

namespace driftless {

/// Where a simulation writes: what is not named lies in the folder.
struct SimulationFiles {
  std::filesystem::path folder, trajectory, fields, monitor, checkpoint, run;
};

/// What a simulation is, read from its arguments. Times are in steps.
struct Simulation {
  Scene scene;
  MethodChoice method;
  std::uint64_t steps = 0;
  std::uint64_t every = 0;         ///< between frames of the trajectory
  std::uint64_t sample_every = 0;  ///< between samples of fields and monitor
  std::uint64_t equilibrate = 0;   ///< before the first sample of the fields
  Fields::Bins bins = {1, 1, 1};
  bool has_fields = true;  ///< not for isolated pairs
  SimulationFiles files;
};

/// Reads and checks the arguments; writes nothing. Throws InputError in one sentence.
Simulation read_simulation(const SimulateArguments& arguments);

}  // namespace driftless
