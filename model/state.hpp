#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftless {

using Vector = Eigen::Vector3d;

/// Momentum and energy that something outside of the fluid has received from it.
struct Received {
  Vector momentum = Vector::Zero();
  double energy = 0;

  Received& operator+=(const Received& more) {
    momentum += more.momentum;
    energy += more.energy;
    return *this;
  }
};

/// What can receive: the six walls (lower x, upper x, lower y, ...), the field, and what drives the
/// fluid between steps.
inline constexpr std::size_t field_place = 6, driver_place = 7, surrounding_places = 8;
using Surroundings = std::array<Received, surrounding_places>;

/// What they have received together.
inline Received total(const Surroundings& surroundings) {
  Received all;
  for (const auto& received : surroundings) all += received;
  return all;
}

/// Velocities and internal energies of all particles, in the order of storage, and what the
/// surroundings have received since the start: fluid and surroundings together keep momentum and
/// energy.
struct Motion {
  std::vector<Vector> velocity;
  std::vector<double> internal_energy;
  Surroundings surroundings = {};
};

/// State of N particles. `id` names a particle for life: noise and pair order follow it.
struct State : Motion {
  std::vector<Vector> position;  ///< inside the periodic box, each component in [0, length)
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> species = {};  ///< numbers in the fluid; empty: all 0

  std::size_t size() const { return position.size(); }
  std::size_t species_of(std::size_t place) const { return species.empty() ? 0 : species[place]; }
};

/// A plane wall, along which particles slip. It repels along its normal, r being the distance from
/// it, and a particle that reaches it all the same is reflected. With a temperature it is a
/// reservoir: a particle near it exchanges heat, and a normal friction and noise force, with it as
/// with a particle of infinite mass and heat capacity [Mackie, Bonet Avalos, Navas, PCCP 1, 2039
/// (1999), section 3]; without one it is adiabatic. Closure, heat form and weight exponent are the
/// fluid's.
struct Wall {
  std::optional<double> temperature = {};  ///< T > 0 of a reservoir
  double repulsion = 0, repulsion_range = 1;
  double friction = 0, friction_range = 1;  ///< zeta_0
  double conduction = 0, heat_range = 1;    ///< L_0 or lambda_0
  bool operator==(const Wall&) const = default;
};

/// Rectangular box with one corner at the origin, periodic along the axes that have no walls.
struct Box {
  Vector lengths;
  std::array<std::optional<Wall>, 6> walls = {};  ///< lower x, upper x, lower y, ...; in pairs
  Vector gravity = Vector::Zero();                ///< acceleration, along one axis with walls

  double volume() const { return lengths.prod(); }
  bool is_walled(int axis) const { return walls[static_cast<std::size_t>(2 * axis)].has_value(); }
  /// Whether there is a wall or a field.
  bool is_bounded() const {
    return is_walled(0) || is_walled(1) || is_walled(2) || !gravity.isZero(0);
  }
  /// Whether a position is inside; one that is not finite is not.
  bool contains(const Vector& position) const {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = position[axis], length = lengths[axis];
      inside = inside & (x >= 0) & (x < length || (x == length && is_walled(axis)));
    }
    return inside;
  }
  /// The image of a position inside the box along its periodic axes.
  Vector wrap(const Vector& position) const;
  /// The shortest image of a difference of two positions.
  Vector minimum_image(const Vector& difference) const;
};

inline Vector Box::wrap(const Vector& position) const {
  Vector wrapped;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = lengths[axis];
    // Nearly always inside, and then without a division.
    if ((position[axis] >= 0 && position[axis] < length) || is_walled(axis)) {
      wrapped[axis] = position[axis];
      continue;
    }
    const double x = position[axis] - length * std::floor(position[axis] / length);
    wrapped[axis] = x >= length ? 0 : x;  // rounding may put a tiny negative on the upper edge
  }
  return wrapped;
}

/// What every particle, and the surroundings, receive in one stage of a step.
struct Exchange {
  std::vector<Vector> momentum;
  std::vector<double> energy;
  Surroundings surroundings = {};

  void reset(std::size_t particles);
};

/// A change of the order of storage: what lies at place n was at places[n] before.
using Places = std::vector<std::uint32_t>;

/// Brings values along that lie in the order of storage, one for every particle.
template <class Value>
void follow(const Places& places, std::vector<Value>& values) {
  if (values.size() != places.size()) return;
  const auto before = values;
  for (std::size_t n = 0; n < places.size(); ++n) values[n] = before[places[n]];
}

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
