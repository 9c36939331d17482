#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftless {

using Vector = Eigen::Vector3d;

/// Velocities and internal energies of all particles, in the order of storage.
struct Motion {
  std::vector<Vector> velocity;
  std::vector<double> internal_energy;
};

/// State of N particles. `id` names a particle for life: noise and pair order follow it.
struct State : Motion {
  std::vector<Vector> position;  ///< inside the periodic box, each component in [0, length)
  std::vector<std::uint32_t> id;

  std::size_t size() const { return position.size(); }
};

/// Periodic rectangular box with one corner at the origin.
struct Box {
  Vector lengths;

  double volume() const { return lengths.prod(); }
  /// Whether a position is inside; one that is not finite is not.
  bool contains(const Vector& position) const {
    return (position.array() >= 0).all() && (position.array() < lengths.array()).all();
  }
  /// The image of a position inside the box.
  Vector wrap(const Vector& position) const;
  /// The shortest image of a difference of two positions.
  Vector minimum_image(const Vector& difference) const;
};

inline Vector Box::wrap(const Vector& position) const {
  Vector wrapped;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = lengths[axis];
    const double x = position[axis] - length * std::floor(position[axis] / length);
    wrapped[axis] = x >= length ? 0 : x;  // rounding may put a tiny negative on the upper edge
  }
  return wrapped;
}

/// What every particle receives in one stage of a step.
struct Exchange {
  std::vector<Vector> momentum;
  std::vector<double> energy;

  void reset(std::size_t particles);
};

/// Why a step could not be completed.
enum class FailureCause { non_finite, negative_internal_energy, not_converged, energy_runaway };

/// "non-finite number", "negative internal energy", "solver did not converge", "energy ran away".
std::string to_string(FailureCause cause);

/// Thrown from inside a step, with the ids of the particles concerned (empty if all are). The state
/// is then that of an unfinished step; nothing is clipped or repaired.
class StepFailure : public std::runtime_error {
 public:
  StepFailure(FailureCause cause, std::vector<std::uint32_t> ids);
  FailureCause cause() const { return cause_; }
  const std::vector<std::uint32_t>& ids() const { return ids_; }

 private:
  FailureCause cause_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace driftless
