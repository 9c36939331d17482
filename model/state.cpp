#include "model/state.hpp"

#include <cmath>

namespace driftless {

Vector Box::minimum_image(const Vector& difference) const {
  Vector shortest;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = lengths[axis];
    shortest[axis] = difference[axis];
    if (!is_walled(axis)) shortest[axis] -= length * std::round(difference[axis] / length);
  }
  return shortest;
}

void Exchange::reset(std::size_t particles) {
  momentum.assign(particles, Vector::Zero());
  energy.assign(particles, 0.0);
  surroundings = {};
}

std::string to_string(FailureCause cause) {
  switch (cause) {
    case FailureCause::non_finite:
      return "non-finite number";
    case FailureCause::negative_internal_energy:
      return "negative internal energy";
    case FailureCause::not_converged:
      return "solver did not converge";
    case FailureCause::energy_runaway:
      return "energy ran away";
  }
  throw std::logic_error("unknown failure cause");
}

StepFailure::StepFailure(FailureCause cause, std::vector<std::uint32_t> ids)
    : std::runtime_error(to_string(cause)), cause_(cause), ids_(std::move(ids)) {}

}  // namespace driftless
