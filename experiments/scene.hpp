#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/heat_slabs.hpp"
#include "model/initial.hpp"
#include "model/system.hpp"

namespace driftless {

/// How velocities and internal energies start: drawn from the exact law, which is microcanonical,
/// or canonical in an isothermal scene; or otherwise.
enum class InitialState { microcanonical, canonical, rest, given };

/// What is simulated: the fluid, how much of it, and how it starts. All in program units.
struct Scene {
  std::string name;    ///< unique within a study
  std::string preset;  ///< the preset it was made from
  FluidParameters fluid;
  Layout layout = Layout::fluid;
  std::size_t particles = 1000;
  double density = 1;             ///< number density; unused by `pairs`
  Vector sides = Vector::Ones();  ///< of the box, relative to each other
  std::array<std::optional<Wall>, 6> walls = {};
  Vector gravity = Vector::Zero();
  std::optional<HeatSlabs> heat_slabs = {};  ///< acting after every step
  /// Share of the particles that each species beside the first has.
  std::vector<double> further_shares = {};
  bool frozen = false;
  double pair_distance = 0.5;  ///< `pairs` alone
  Vector frame_velocity = Vector::Zero();
  InitialState initial_state = InitialState::microcanonical;
  Placement initial_positions = Placement::random;
  double initial_temperature = 1;          ///< of the internal energies, for `rest` and `given`
  double initial_velocity_spread = 0;      ///< per component, for `given`
  std::vector<Vector> initial_velocities;  ///< one per particle, for `given`; overrides the spread
};

/// The box of the scene: its volume is that of the density.
Box scene_box(const Scene& scene);
/// The species of every particle: spread evenly over the ids; empty if there is one alone.
std::vector<std::uint8_t> scene_species(const Scene& scene);

/// Whether every replica starts from the exact law.
inline bool starts_in_law(const Scene& scene) {
  return scene.initial_state == InitialState::microcanonical ||
         scene.initial_state == InitialState::canonical;
}

/// A named scene with what it is for.
struct Preset {
  std::string_view name;
  std::string_view title;
  std::string_view source;  ///< paper and section
  Scene scene;
};

/// Under the names that scenes refer to; those with walls or heat slabs come last.
const std::vector<Preset>& presets();

/// Predicted relaxation time of internal energies (derived: friction at rate rho zeta_0 [w]/(2 m
/// a), conduction at rate rho L_0 [w]/(phi T^2), [w] the volume integral of the weight; for `pairs`
/// the rates at the pair's distance). Infinite if nothing acts, and where there are none.
double relaxation_time(const Scene& scene);

/// Predicted relaxation time of the kinetic energy towards the internal energies or a bath: rate
/// 2 rho zeta_0 [w]/(3 m) in a fluid (twice the collision rate of Groot and Warren 1997), 4 zeta
/// w/m for a pair. Infinite without friction.
double kinetic_relaxation_time(const Scene& scene);

}  // namespace driftless
