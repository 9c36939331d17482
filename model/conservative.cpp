#include "model/system.hpp"

#include <array>
#include <atomic>

// How a system moves, and the conservative forces on the way.
namespace driftless {

void System::kick(double duration) {
  if (!fluid_.has_repulsion()) return;
  const auto& force = conservative_force();
  give_surroundings(duration);
  const double factor = duration / fluid_.mass();
  const bool alike = fluid_.species() == 1;
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      state_.velocity[i] += (alike ? factor : duration / mass(i)) * force[i];
    }
  });
}

Vector System::reflect(Vector position, std::size_t place, Surroundings& received) {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box_.lengths[axis];
    if (!box_.is_walled(axis) || (position[axis] >= 0 && position[axis] <= length)) continue;
    const bool upper = position[axis] > length;
    position[axis] = upper ? 2 * length - position[axis] : -position[axis];
    double& velocity = state_.velocity[place][axis];
    received[static_cast<std::size_t>(2 * axis + (upper ? 1 : 0))].momentum[axis] +=
        2 * mass(place) * velocity;
    velocity = -velocity;
  }
  return position;
}

void System::move_along(const std::vector<Vector>& velocity, double duration) {
  if (frozen_) return;
  const auto factors = energy_factors();
  const bool walled = box_.is_walled(0) || box_.is_walled(1) || box_.is_walled(2);
  // Shares that do not depend on the threads: sums then do not either.
  constexpr std::size_t shares = 8;
  std::array<Surroundings, shares> received;
  std::atomic<bool> sound = true, inside = true;
  const std::size_t tasks[] = {shares};
  threads_.phases(tasks, [&](unsigned, std::size_t, std::size_t share) {
    bool all_sound = true, all_inside = true;
    for (std::size_t i = size() * share / shares; i < size() * (share + 1) / shares; ++i) {
      Vector moved = box_.wrap(state_.position[i] + duration * velocity[i]);
      if (walled) moved = reflect(moved, i, received[share]);
      const bool sound_here = is_sound(i), inside_here = box_.contains(moved);
      // Whoever looks at a failed state finds every particle in the box.
      if (sound_here & inside_here) state_.position[i] = moved;
      all_sound = all_sound & sound_here;
      all_inside = all_inside & inside_here;
    }
    if (!all_sound) sound = false;
    if (!all_inside) inside = false;
  });
  for (const auto& of_share : received) {
    for (std::size_t n = 0; n < surrounding_places; ++n) state_.surroundings[n] += of_share[n];
  }
  ++positions_version_;
  if (!sound) throw_failure();
  if (inside) {
    follow_factors(factors);
    return;
  }
  // So far beyond the box that rounding leaves no image inside, or through two walls at once.
  std::vector<std::uint32_t> lost;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector moved = box_.wrap(state_.position[i] + duration * velocity[i]);
    if (!box_.contains(moved)) lost.push_back(state_.id[i]);
  }
  throw StepFailure(FailureCause::non_finite, std::move(lost));
}

void System::renew_conservative() {
  if (conservative_version_ == positions_version_) return;
  if (!fluid_.has_repulsion()) {
    conservative_.reset(size());
    conservative_version_ = positions_version_;
    return;
  }
  const auto repulsion = [&](const auto& pair) {
    const PairLaw& law = *pair.law;
    const auto potential = law.potential(pair.r);
    return Transfer{law.repulsive_force(pair.r), law.potential_share_i() * potential,
                    law.potential_share_j() * potential};
  };
  const PairKernel kernel = PairKernel::of(repulsion);
  const auto of_pairs = [&](PairPass& pass, PairBlock&, std::size_t, std::size_t count) {
    pass.geometry(0, count);
    pass.run(kernel, 0, count);
  };
  const auto at_boundary = [&](PairPass& pass, std::size_t, std::size_t count) {
    pass.run(kernel, 0, count);
  };
  const ContactAnswer contacts(at_boundary);
  sum(conservative_, of_pairs, nothing_to_prepare, &contacts);
  conservative_version_ = positions_version_;
  count_visit(false, false);
}

const std::vector<Vector>& System::conservative_force() {
  if (fluid_.repulsion_follows_temperatures()) {
    renew_thermal_force();
    return thermal_.momentum;
  }
  renew_conservative();
  return conservative_.momentum;
}

const std::vector<double>& System::potential_shares() {
  renew_conservative();
  return conservative_.energy;
}

}  // namespace driftless
