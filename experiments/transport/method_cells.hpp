#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study.hpp"
#include "experiments/transport/starts.hpp"
#include "experiments/transport/waves.hpp"

/// The transport coefficients that a method gives at a time step.
namespace driftless::transport {

/// A fluid with the boxes and times in which its coefficients are measured; every method and step
/// sees the same.
struct TransportScene {
  std::string name;
  FluidParameters fluid;
  double density = 1;
  std::vector<double> time_steps;  ///< coarsest first
  /// Mean squared displacements over this window, so many of them, in a cubic box.
  double particle_window = 0;
  unsigned particle_windows = 4;
  double cube_side = 0;
  /// A temperature wave in the cubic box: how long it is followed, how often imposed a replica.
  double heat_window = 0;
  unsigned heat_impositions = 4;
  /// Transverse and longitudinal waves along a box of this length and width; width 0: in the cubic
  /// box, along with the temperature wave.
  double flow_length = 0, flow_width = 0;
  double flow_window = 0;
  unsigned flow_impositions = 4;
  double sound_guess = 1;
  unsigned replicas = 6;

  double cube_wavenumber() const;
  double flow_wavenumber() const;
};

/// The ideal fluid of the preset mackie-1999, and the preset soft-fluid; `effort` multiplies
/// replicas.
TransportScene ideal_transport_scene(unsigned effort);
TransportScene soft_transport_scene(unsigned effort);

/// The coefficients' names in records: "diffusion", "viscosity", "conductivity", "sound speed", and
/// beside them "kinetic temperature".
const std::vector<std::string>& coefficient_names();

/// What a method gives at a step: {"runs", "failed", "cause" of the first failure, and each
/// coefficient as {"value", "error", "degrees_of_freedom"}}, from the replicas that did not fail. A
/// replica fails by StepFailure or by doubling its energy. A pure function of its arguments.
nlohmann::json measure_method(const TransportScene& scene, const MethodChoice& method, double step,
                              std::uint64_t seed);

/// Sound speed of an ideal scene along a box of another length, for its limit of long waves.
Estimate sound_at(const TransportScene& scene, const MethodChoice& method, double step,
                  double length, std::uint64_t seed);

/// Predicted cost of measure_method in seconds of one core.
double predicted_seconds(const TransportScene& scene, double step);

}  // namespace driftless::transport
