#pragma once

#include "experiments/judge/isolated_runs.hpp"

/// What a method makes of a fluid that moves as a whole.
namespace driftless::judge {

/// A uniform velocity of so many thermal velocities sqrt(kT/m) in a general direction.
Vector frame_velocity(const Fluid& fluid, double thermal_velocities);

/// How far a frame's velocity changes internal energies from the same start with the same noise,
/// after `duration`:
/// {"time_step", "speeds": [{"speed", "spread", "rate": {"value", "error",
/// "degrees_of_freedom"}, "energies", "runs", "failed", ...}]}, `spread` the root mean square
/// change of so many internal energies in units of the mean one, and `rate` the relative change of
/// the internal temperature per unit time, with its standard error. Without the numbers of a speed
/// at which fewer than two runs came to their end.
nlohmann::json frame_change(const Candidate& candidate, const PreparedScene& scene, unsigned runs,
                            const std::vector<double>& speeds, double time_step, double duration);

/// Averages of long runs in a frame of a given speed: {"speed", "time_step", "runs", "failed", ...}
/// and, for each run, null if it failed, "kinetic_temperature", "internal_temperature" and
/// "internal_energy_variance". Starts and noise are the same in every frame.
nlohmann::json frame_averages(const Candidate& candidate, const PreparedScene& scene, unsigned runs,
                              double speed, double time_step, double duration);

}  // namespace driftless::judge
