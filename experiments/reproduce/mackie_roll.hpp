#pragma once

#include <cstdint>

#include "experiments/reproduce/mackie_box.hpp"

/// The box of [MAN Fig. 4-6]: a fluid between a hot and a cold wall in a weak field.
namespace driftless::reproduce {

inline constexpr double hot = mackie_hot, cold = mackie_cold, gravity = mackie_gravity;
inline constexpr std::size_t roll_particles = 100000;

/// Side of the section: of the cube of 100000 particles at density 1.
double roll_side();

enum class HotWall { floor, left };

struct RollRun {
  MethodChoice method;
  double time_step;
  std::size_t particles;  ///< fewer than in the cube: a slice of the same section, less deep
  double gravity;
  double settle, duration;            ///< fields are averaged from `settle` on
  double start;                       ///< temperature of the whole fluid at the start
  HotWall hot_wall = HotWall::floor;  ///< the cold one is opposite
};

/// Runs it: {"series": {name: [...]}, "fields": as Fields::to_json, "pair_evaluations"}. Series:
/// time; roll, the mass flow around the fundamental roll (RollSeries); kinetic, internal and
/// potential energies; hot and cold, what energy these walls have received.
nlohmann::json run_roll(const RollRun& run, std::uint64_t seed, const Workplace& workplace);

/// Mass flow per depth around a roll, psi_0 of m rho v = curl(psi_0 sin(pi x/L) sin(pi z/L)),
/// projected from all particles; positive: counterclockwise with x to the right and z upwards.
double roll_flow(const System& system);

/// T_kin/T_int of a periodic box of the fluid after it has settled: {"kinetic", "inverse"} over
/// time, from the exact law; "failure" if it broke off.
nlohmann::json run_step_check(const MethodChoice& method, double time_step, std::uint64_t seed);

}  // namespace driftless::reproduce
