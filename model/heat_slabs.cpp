#include "model/heat_slabs.hpp"

#include <boost/random/gamma_distribution.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace driftless {
namespace {

[[noreturn]] void refuse(const std::string& what, double value, const std::string& allowed) {
  throw std::invalid_argument("heat slabs: " + what + " is " + std::to_string(value) + ", " +
                              allowed);
}

void check_slab(const std::string& name, const Slab& slab, double length) {
  if (!(slab.from >= 0) || !(slab.from < length)) {
    refuse("the lower end of the " + name + " slab", slab.from,
           "must lie in the box, below " + std::to_string(length));
  }
  if (!(slab.to > slab.from) || !(slab.to <= length)) {
    refuse("the upper end of the " + name + " slab", slab.to,
           "must be above the lower one and at most " + std::to_string(length));
  }
}

void check_drive(const HeatSlabs& slabs) {
  const auto check_positive = [](const std::string& what, double value) {
    if (!(value > 0) || !std::isfinite(value)) refuse(what, value, "must be above 0");
  };
  if (slabs.drive == SlabDrive::heat_rate) check_positive("the heat rate", slabs.rate);
  if (slabs.drive == SlabDrive::temperatures) {
    check_positive("the hot slab's temperature", slabs.hot_temperature);
    check_positive("the cold slab's temperature", slabs.cold_temperature);
  }
  if (!(slabs.period >= 0) || !std::isfinite(slabs.period)) {
    refuse("the period", slabs.period, "must not be below 0");
  }
}

std::vector<std::size_t> places_in(const Slab& slab, int axis, const State& state) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (slab.contains(state.position[i][axis])) places.push_back(i);
  }
  return places;
}

/// The place whose `value` is the least (sign 1) or the largest (sign -1); of equal ones that of
/// the smaller id, so that no order of storage enters.
template <class Value>
std::optional<std::size_t> extreme(const std::vector<std::size_t>& places, const State& state,
                                   double sign, Value&& value) {
  std::optional<std::size_t> best;
  for (const std::size_t i : places) {
    if (!best) {
      best = i;
      continue;
    }
    const double ours = sign * value(i), theirs = sign * value(*best);
    if (ours < theirs || (ours == theirs && state.id[i] < state.id[*best])) best = i;
  }
  return best;
}

/// The least of the hot slab and the largest of the cold one, if the latter is larger.
struct Partners {
  std::size_t hot, cold;
};
template <class Value>
std::optional<Partners> partners(const HeatSlabs& slabs, const State& state, Value&& value) {
  const auto hot = extreme(places_in(slabs.hot, slabs.axis, state), state, 1, value);
  const auto cold = extreme(places_in(slabs.cold, slabs.axis, state), state, -1, value);
  if (!hot || !cold || !(value(*cold) > value(*hot))) return std::nullopt;
  return Partners{*hot, *cold};
}

/// The canonical law of an internal energy: gamma of shape phi/k + 1 and scale k T (Mackie, Bonet
/// Avalos and Navas 1999, eq. 3.21); phi T where nothing fluctuates.
double draw_energy(const EquationOfState& state, double boltzmann, double temperature,
                   NoiseStream stream) {
  const double mean = state.internal_energy(temperature);
  if (boltzmann == 0) return mean;
  boost::random::gamma_distribution<double> gamma(mean / (boltzmann * temperature) + 1);
  return boltzmann * temperature * gamma(stream);
}

/// Books in the system that its driver has given heat.
void book(System& system, double heat) {
  Exchange given;
  given.surroundings[driver_place].energy = -heat;
  system.give_surroundings(given, 1);
}

void refuse_fluid(const Fluid& fluid, SlabDrive drive) {
  for (std::size_t species = 0; species < fluid.species(); ++species) {
    if (drive != SlabDrive::temperatures) break;
    if (fluid.equation_of_state(species).has_constant_heat_capacity()) continue;
    throw std::invalid_argument(
        "heat slabs: energies are drawn for a constant heat capacity alone, which species " +
        std::to_string(species) + " has not");
  }
  if (drive != SlabDrive::velocity_exchange) {
    if (!fluid.isothermal()) return;
    throw std::invalid_argument(
        "heat slabs: an isothermal fluid has no internal energies that slabs could change");
  }
  for (std::size_t species = 1; species < fluid.species(); ++species) {
    if (fluid.mass(species) == fluid.mass()) continue;
    refuse("the mass of species " + std::to_string(species), fluid.mass(species),
           "must be that of the others, " + std::to_string(fluid.mass()) +
               ", as an exchange of velocities would change the momentum");
  }
}

}  // namespace

SlabHeater::SlabHeater(const HeatSlabs& slabs, const Fluid& fluid, const Box& box,
                       const Noise& noise)
    : slabs_(slabs), noise_(noise) {
  if (slabs.axis < 0 || slabs.axis > 2) refuse("the axis", slabs.axis, "must be 0, 1 or 2");
  check_slab("hot", slabs.hot, box.lengths[slabs.axis]);
  check_slab("cold", slabs.cold, box.lengths[slabs.axis]);
  if (slabs.hot.from < slabs.cold.to && slabs.cold.from < slabs.hot.to) {
    refuse("the lower end of the cold slab", slabs.cold.from,
           "the slabs must not overlap and the hot one ends at " + std::to_string(slabs.hot.to));
  }
  check_drive(slabs);
  refuse_fluid(fluid, slabs.drive);
}

void SlabHeater::act(System& system, double duration) {
  if (duration == 0) return;
  const double given_before = given();
  drive(system, duration);
  book(system, given() - given_before);
}

void SlabHeater::drive(System& system, double duration) {
  if (slabs_.drive == SlabDrive::heat_rate) {
    give_heat(system, owed_ + slabs_.rate * duration);
    return;
  }
  waited_ += duration;
  // A period of so many steps is not missed by rounding.
  const auto due = [&] { return waited_ >= slabs_.period * (1 - 1e-9); };
  while (due()) {
    waited_ -= slabs_.period;
    ++acts_;
    if (slabs_.drive == SlabDrive::velocity_exchange) exchange_velocities(system);
    if (slabs_.drive == SlabDrive::energy_exchange) exchange_energies(system);
    if (slabs_.drive == SlabDrive::temperatures) draw_energies(system);
    if (slabs_.period == 0) {
      waited_ = 0;
      break;
    }
  }
}

void SlabHeater::give_heat(System& system, double heat) {
  const State& state = system.state();
  const auto hot = places_in(slabs_.hot, slabs_.axis, state);
  const auto cold = places_in(slabs_.cold, slabs_.axis, state);
  if (hot.empty() || cold.empty()) {
    owed_ = heat;
    return;
  }
  const double gain = heat / static_cast<double>(hot.size());
  const double loss = heat / static_cast<double>(cold.size());
  std::vector<std::uint32_t> too_poor;
  for (const std::size_t i : cold) {
    if (!(state.internal_energy[i] > loss)) too_poor.push_back(state.id[i]);
  }
  if (!too_poor.empty()) throw StepFailure(FailureCause::negative_internal_energy, too_poor);
  system.update([&](std::size_t i, Vector&, double& u) {
    const double x = system.state().position[i][slabs_.axis];
    if (slabs_.hot.contains(x)) u += gain;
    if (slabs_.cold.contains(x)) u -= loss;
  });
  given_to_hot_ += heat;
  given_to_cold_ -= heat;
  owed_ = 0;
  ++acts_;
}

void SlabHeater::exchange_velocities(System& system) {
  const State& state = system.state();
  const double mass = system.fluid().mass();
  const Vector mean = system.momentum() / (mass * static_cast<double>(system.size()));
  const auto chosen = partners(
      slabs_, state, [&](std::size_t i) { return (state.velocity[i] - mean).squaredNorm(); });
  if (!chosen) return;
  const Vector slow = state.velocity[chosen->hot], fast = state.velocity[chosen->cold];
  system.update([&](std::size_t i, Vector& velocity, double&) {
    if (i == chosen->hot) velocity = fast;
    if (i == chosen->cold) velocity = slow;
  });
  const double energy = mass * (fast - slow).dot(fast + slow) / 2;
  given_to_hot_ += energy;
  given_to_cold_ -= energy;
}

void SlabHeater::exchange_energies(System& system) {
  const State& state = system.state();
  const auto chosen =
      partners(slabs_, state, [&](std::size_t i) { return state.internal_energy[i]; });
  if (!chosen) return;
  const double least = state.internal_energy[chosen->hot];
  const double most = state.internal_energy[chosen->cold];
  system.update([&](std::size_t i, Vector&, double& u) {
    if (i == chosen->hot) u = most;
    if (i == chosen->cold) u = least;
  });
  given_to_hot_ += most - least;
  given_to_cold_ -= most - least;
}

void SlabHeater::draw_energies(System& system) {
  noise_.set_step(acts_);
  const State& state = system.state();
  std::vector<double> drawn = state.internal_energy;
  const auto draw = [&](const Slab& slab, double temperature, double& given) {
    for (const std::size_t i : places_in(slab, slabs_.axis, state)) {
      drawn[i] = draw_energy(system.equation_of_state(i), system.fluid().boltzmann(), temperature,
                             noise_.particle_stream(state.id[i], Purpose::slab_energy));
      given += drawn[i] - state.internal_energy[i];
    }
  };
  draw(slabs_.hot, slabs_.hot_temperature, given_to_hot_);
  draw(slabs_.cold, slabs_.cold_temperature, given_to_cold_);
  system.update([&](std::size_t i, Vector&, double& u) { u = drawn[i]; });
}

std::vector<double> SlabHeater::save() const {
  return {given_to_hot_, given_to_cold_, owed_, waited_, static_cast<double>(acts_)};
}

void SlabHeater::load(const std::vector<double>& saved) {
  if (saved.size() != 5) throw std::invalid_argument("heat slabs: not what they have saved");
  given_to_hot_ = saved[0];
  given_to_cold_ = saved[1];
  owed_ = saved[2];
  waited_ = saved[3];
  acts_ = static_cast<std::uint64_t>(saved[4]);
}

}  // namespace driftless
