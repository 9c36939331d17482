#include "model/system.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
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
  if (!state.species.empty() && state.species.size() != particles) {
    throw std::invalid_argument("the arrays of a state differ in length");
  }
  auto ids = state.id;
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end()) {
    throw std::invalid_argument("two particles of a state have the same id");
  }
  for (auto& position : state.position) {
    position = box.wrap(position);
    if (!box.contains(position)) {
      throw std::invalid_argument("a position is not finite, or is beyond a wall");
    }
  }
  return state;
}

}  // namespace

System::System(const Fluid& fluid, const Box& box, State state, const Noise& noise, bool frozen)
    : fluid_(fluid.within(box)),
      box_(box),
      state_(valid(box, std::move(state))),
      noise_(noise),
      frozen_(frozen),
      cells_(box, fluid_.range(), state_.size()),
      pairs_(cells_, fluid_.range(), 1) {
  check_species();
  drop_if_isothermal(state_.internal_energy);
  set_threads(1);
}

void System::check_species() const {
  for (const auto species : state_.species) {
    if (species < fluid_.species()) continue;
    throw std::invalid_argument("a particle is of a species that the fluid does not have");
  }
}

void System::set_threads(unsigned count) {
  wanted_threads_ = count;
  cut_cells();
}

void System::cut_cells() {
  cells_ = CellGrid(box_, fluid_.range(), size());
  threads_ = Threads(std::min(wanted_threads_, cells_.tiles_at_once()));
  pairs_ = PairBlocks(cells_, fluid_.range(), threads_.count(), fluid_.species());
  contacts_ = BoundaryContacts();
  passes_.resize(threads_.count());
  forget_sums();
  if (measured_) measure_passes();
  pairs_version_ = 0;
}

void System::measure_passes() {
  measured_ = true;
  for (auto& pass : passes_) pass.measure(true);
}

PassSeconds System::pass_seconds() const {
  PassSeconds sum;
  for (const auto& pass : passes_) sum += pass.seconds();
  return sum;
}

template <class Value>
void System::bring_along(const Places& places, std::vector<Value>& values) const {
  if (values.size() != places.size()) return;
  const auto ordered = std::make_unique_for_overwrite<Value[]>(values.size());
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) ordered[n] = values[places[n]];
  });
  for_each_particle([&](std::size_t begin, std::size_t end) {
    std::copy(&ordered[begin], &ordered[end], &values[begin]);
  });
}

Places System::order_storage() {
  find_pairs();
  Places places(size());
  for (std::size_t n = 0; n < size(); ++n) places[n] = cells_.place(n);
  bring_along(places, state_.position);
  bring_along(places, state_.velocity);
  bring_along(places, state_.internal_energy);
  bring_along(places, state_.id);
  bring_along(places, state_.species);
  bring_along(places, conservative_.momentum);
  bring_along(places, conservative_.energy);
  cells_.follow_storage();
  factors_version_ = thermal_positions_version_ = 0;
  return places;
}

void System::drop_if_isothermal(Surroundings& surroundings) const {
  if (!fluid_.isothermal()) return;
  for (auto& received : surroundings) received.energy = 0;
}

void System::drop_if_isothermal(std::vector<double>& energies) const {
  if (fluid_.isothermal()) std::fill(energies.begin(), energies.end(), 0.0);
}

void System::apply(const Exchange& exchange, double share) {
  give_surroundings(exchange, share);
  if (fluid_.species() == 1) {
    const double per_mass = share / fluid_.mass();
    update([&](std::size_t i, Vector& velocity, double& internal_energy) {
      velocity += exchange.momentum[i] * per_mass;
      internal_energy += share * exchange.energy[i];
    });
    return;
  }
  update([&](std::size_t i, Vector& velocity, double& internal_energy) {
    velocity += exchange.momentum[i] * (share / mass(i));
    internal_energy += share * exchange.energy[i];
  });
}

void System::give_surroundings(const Exchange& exchange, double share) {
  for (std::size_t n = 0; n < surrounding_places; ++n) {
    const auto& received = exchange.surroundings[n];
    state_.surroundings[n] += {share * received.momentum, share * received.energy};
  }
}

void System::give_surroundings(double duration) {
  renew_conservative();
  for (std::size_t n = 0; n < surrounding_places; ++n) {
    state_.surroundings[n].momentum += duration * conservative_.surroundings[n].momentum;
  }
}

void System::set_motion(const Motion& motion) {
  state_.velocity = motion.velocity;
  state_.internal_energy = motion.internal_energy;
  state_.surroundings = motion.surroundings;
  drop_if_isothermal(state_.internal_energy);
  ++energies_version_;
  check();
}

void System::swap_motion(Motion& motion) {
  std::swap(static_cast<Motion&>(state_), motion);
  drop_if_isothermal(state_.internal_energy);
  ++energies_version_;
  check();
}

void System::check() const {
  std::atomic<bool> sound = true;
  for_each_particle([&](std::size_t begin, std::size_t end) {
    bool all = true;
    for (std::size_t i = begin; i < end; ++i) all = all & is_sound(i);
    if (!all) sound = false;
  });
  if (!sound) throw_failure();
}

void System::throw_failure(std::vector<std::uint32_t> in_passing) const {
  auto failed = std::move(in_passing);
  bool negative = !failed.empty();
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_sound(i)) continue;
    failed.push_back(state_.id[i]);
    negative = negative || (!fluid_.isothermal() && state_.internal_energy[i] <= 0);
  }
  std::sort(failed.begin(), failed.end());
  failed.erase(std::unique(failed.begin(), failed.end()), failed.end());
  // An energy below zero makes the roots that follow it non-finite: it is the cause of both.
  throw StepFailure(negative ? FailureCause::negative_internal_energy : FailureCause::non_finite,
                    std::move(failed));
}

double System::kinetic_energy() const {
  double sum = 0;
  if (fluid_.species() == 1) {
    for (const auto& velocity : state_.velocity) sum += velocity.squaredNorm();
    return 0.5 * fluid_.mass() * sum;
  }
  for (std::size_t i = 0; i < size(); ++i) sum += mass(i) * state_.velocity[i].squaredNorm();
  return 0.5 * sum;
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
  for (std::size_t i = 0; i < size(); ++i) sum += mass(i) * state_.velocity[i];
  return sum;
}

void System::set_state(State state) {
  const bool as_many = state.size() == size();
  state_ = valid(box_, std::move(state));
  check_species();
  drop_if_isothermal(state_.internal_energy);
  ++positions_version_;
  if (!as_many) cut_cells();
}

}  // namespace driftless
