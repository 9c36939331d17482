#include "model/system.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftless {
namespace {

/// Brings positions into the box; throws std::invalid_argument if the state makes no sense.
State valid(const Box& box, State state) {
  const std::size_t particles = state.size();
  if (state.velocity.size() != particles || state.internal_energy.size() != particles ||
      state.id.size() != particles) {
    throw std::invalid_argument("the arrays of a state differ in length");
  }
  auto ids = state.id;
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end()) {
    throw std::invalid_argument("two particles of a state have the same id");
  }
  for (auto& position : state.position) {
    position = box.wrap(position);
    if (!box.contains(position)) throw std::invalid_argument("a position is not finite");
  }
  return state;
}

}  // namespace

System::System(const Fluid& fluid, const Box& box, State state, const Noise& noise, bool frozen)
    : fluid_(fluid),
      box_(box),
      state_(valid(box, std::move(state))),
      noise_(noise),
      frozen_(frozen),
      pairs_(box, fluid, state_.size()) {}

PairList& System::up_to_date_pairs() {
  pairs_.update(state_, fluid_, positions_version_);
  return pairs_;
}

PairList& System::pairs_with_noise(unsigned stage) {
  PairList& pairs = up_to_date_pairs();
  counters_.random_numbers += pairs.draw(state_, fluid_, noise_, stage);
  return pairs;
}

void System::apply(const Exchange& exchange) {
  const double inverse_mass = 1 / fluid_.mass();
  update([&](std::size_t i, Vector& velocity, double& internal_energy) {
    velocity += exchange.momentum[i] * inverse_mass;
    internal_energy += exchange.energy[i];
  });
}

void System::set_motion(const Motion& motion) {
  state_.velocity = motion.velocity;
  state_.internal_energy = motion.internal_energy;
  check();
}

void System::check(const std::vector<std::uint32_t>& failed) const {
  std::vector<std::uint32_t> ids;
  bool negative = !failed.empty();
  for (const auto place : failed) ids.push_back(state_.id[place]);
  for (std::size_t i = 0; i < size(); ++i) {
    const double u = state_.internal_energy[i];
    if (u > 0 && std::isfinite(u) && std::isfinite(state_.velocity[i].squaredNorm())) continue;
    ids.push_back(state_.id[i]);
    negative = negative || u <= 0;
  }
  if (ids.empty()) return;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  // An energy below zero makes the roots that follow it non-finite: it is the cause of both.
  throw StepFailure(negative ? FailureCause::negative_internal_energy : FailureCause::non_finite,
                    std::move(ids));
}

void System::kick(double duration) {
  if (!fluid_.has_repulsion()) return;
  const auto& force = conservative_force();
  const double factor = duration / fluid_.mass();
  for (std::size_t i = 0; i < size(); ++i) state_.velocity[i] += factor * force[i];
}

void System::move(double duration) {
  if (frozen_) return;
  check();
  std::vector<std::uint32_t> lost;
  for (std::size_t i = 0; i < size(); ++i) {
    state_.position[i] = box_.wrap(state_.position[i] + duration * state_.velocity[i]);
    if (!box_.contains(state_.position[i])) lost.push_back(state_.id[i]);
  }
  ++positions_version_;
  // So far beyond the box that rounding leaves no image inside.
  if (!lost.empty()) throw StepFailure(FailureCause::non_finite, std::move(lost));
}

void System::renew_conservative() {
  if (conservative_version_ == positions_version_) return;
  conservative_version_ = positions_version_;
  force_.assign(size(), Vector::Zero());
  potential_share_.assign(size(), 0.0);
  if (!fluid_.has_repulsion()) return;
  for_each_pair([&](const PairList::Geometry& g) {
    const Vector force = fluid_.repulsive_force(g.r) * g.e;
    force_[g.i] += force;
    force_[g.j] -= force;
    const double share = 0.5 * fluid_.potential(g.r);
    potential_share_[g.i] += share;
    potential_share_[g.j] += share;
  });
  counters_.pair_evaluations += pairs_.size();
}

const std::vector<Vector>& System::conservative_force() {
  renew_conservative();
  return force_;
}

const std::vector<double>& System::potential_shares() {
  renew_conservative();
  return potential_share_;
}

double System::kinetic_energy() const {
  double sum = 0;
  for (const auto& velocity : state_.velocity) sum += velocity.squaredNorm();
  return 0.5 * fluid_.mass() * sum;
}

double System::internal_energy() const {
  double sum = 0;
  for (const double u : state_.internal_energy) sum += u;
  return sum;
}

double System::potential_energy() {
  double sum = 0;
  for (const double share : potential_shares()) sum += share;
  return sum;
}

Vector System::momentum() const {
  Vector sum = Vector::Zero();
  for (const auto& velocity : state_.velocity) sum += velocity;
  return fluid_.mass() * sum;
}

void System::set_state(State state) {
  state_ = valid(box_, std::move(state));
  ++positions_version_;
}

}  // namespace driftless
