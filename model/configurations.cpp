#include "model/configurations.hpp"

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace driftless {
namespace {

// A path lasts 0.6 of the time in which a thermal particle crosses the range; its strides shrink
// with the number of particles so that most paths are accepted at any size. Neither enters the law.
constexpr double path_length = 0.6;
constexpr double stride_of_one_particle = 0.15;
constexpr double infinity = std::numeric_limits<double>::infinity();

State without_energies(State state) {
  state.internal_energy.assign(state.size(), 1.0);  // any positive value: no term of it acts
  return state;
}

Fluid conservative_part(const Fluid& fluid) {
  auto parameters = fluid.parameters();
  parameters.friction = 0;
  parameters.conduction = 0;
  for (auto& pair : parameters.pairs) pair.friction = pair.conduction = 0;
  return Fluid(parameters);
}

/// phi/k + 1 of a particle: what an internal energy is in the mean under a bath, over k T.
double mean_energy_over_thermal(const System& system, std::size_t place) {
  const double capacity = 1 / system.equation_of_state(place).inverse_heat_capacity(1.0);
  return capacity / system.fluid().boltzmann() + 1;
}

/// Potential and Laplacian of walls and field; to the virial, a sum over pairs, they do not belong.
void add_boundaries(System& system, ConfigurationSums& sums) {
  sums.potential = system.potential_energy();
  const State& state = system.state();
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (std::size_t face = 0; face < field_place; ++face) {
      const PairLaw* const wall = system.fluid().boundary_law(face, state.species_of(i));
      if (!wall) continue;
      const auto axis = static_cast<Eigen::Index>(face / 2);
      const double x = state.position[i][axis];
      sums.laplacian +=
          wall->potential_curvature(face % 2 == 1 ? system.box().lengths[axis] - x : x);
    }
  }
}

}  // namespace

ConfigurationChain::ConfigurationChain(const Fluid& fluid, const Box& box, State state,
                                       const Noise& noise)
    : system_(conservative_part(fluid), box, without_energies(std::move(state)), noise),
      noise_(noise) {}

double ConfigurationChain::log_of_factors() {
  double sum = 0;
  const auto& factors = system_.energy_factors();
  for (std::size_t i = 0; i < factors.size(); ++i) {
    sum -= mean_energy_over_thermal(system_, i) * std::log(factors[i]);
  }
  return sum;
}

void ConfigurationChain::kick(double duration) {
  const auto& f = system_.fluid().parameters();
  if (system_.fluid().repulsion_follows_temperatures()) {
    // With these the force is the gradient of k T times the logarithm of the canonical weight.
    system_.update([&](std::size_t i, Vector&, double& energy) {
      energy = mean_energy_over_thermal(system_, i) * f.boltzmann * f.temperature;
    });
  }
  system_.kick(duration);
}

template <class LogWeight>
void ConfigurationChain::advance(LogWeight&& log_weight) {
  const auto& f = system_.fluid().parameters();
  const double thermal = std::sqrt(f.boltzmann * f.temperature / f.mass);  // of the first species
  noise_.set_step(++paths_);
  system_.update([&](std::size_t i, Vector& velocity, double&) {
    auto stream = noise_.particle_stream(system_.state().id[i], Purpose::initial_velocity);
    const double spread = thermal * std::sqrt(f.mass / system_.mass(i));
    boost::random::normal_distribution<double> normal(0, spread);
    for (int axis = 0; axis < 3; ++axis) velocity[axis] = normal(stream);
  });
  const State before = system_.state();
  const auto log_probability = [&] {
    return log_weight(system_.potential_energy()) + log_of_factors() -
           system_.kinetic_energy() / (f.boltzmann * f.temperature);
  };
  const double start = log_probability();
  const double fourth_root = std::pow(static_cast<double>(system_.size()), 0.25);
  const int strides =
      static_cast<int>(std::ceil(path_length * fourth_root / stride_of_one_particle));
  const double stride = path_length / strides * f.repulsion_range / thermal;
  for (int n = 0; n < strides; ++n) {
    kick(stride / 2);
    system_.move(stride);
    kick(stride / 2);
  }
  auto stream = noise_.particle_stream(0, Purpose::monte_carlo);
  const double gain = log_probability() - start;
  if (std::log(1 - boost::random::uniform_01<double>{}(stream)) < gain) {
    ++accepted_;
  } else {
    system_.set_state(before);
  }
}

void ConfigurationChain::relax() {
  // Of infinite weight wherever it ends, so accepted.
  bool ended = false;
  advance([&](double) { return std::exchange(ended, true) ? infinity : 0.0; });
}

void ConfigurationChain::advance_canonical() {
  const auto& f = system_.fluid().parameters();
  advance([&](double potential) { return -potential / (f.boltzmann * f.temperature); });
}

void ConfigurationChain::advance_microcanonical(double energy, double total_shape) {
  advance([&](double potential) {
    return potential < energy ? (total_shape - 1) * std::log(energy - potential) : -infinity;
  });
}

ConfigurationSums configuration_sums(System& system) {
  ConfigurationSums sums;
  const Fluid& fluid = system.fluid();
  if (!fluid.has_repulsion()) return sums;
  const auto& thermal = system.thermal_repulsion();
  system.for_each_pair([&](const System::Geometry& pair) {
    const double strength = thermal.empty() ? 0 : thermal[pair.i] + thermal[pair.j];
    sums.potential += pair.law->potential(pair.r);
    sums.virial += pair.r * pair.law->repulsive_force(pair.r);
    if (strength != 0) sums.virial += pair.r * strength * pair.law->thermal_shape_force(pair.r);
    sums.laplacian += 2 * pair.law->potential_laplacian(pair.r, strength);
  });
  if (system.box().is_bounded()) add_boundaries(system, sums);
  for (const auto& force : system.conservative_force()) sums.squared_force += force.squaredNorm();
  return sums;
}

}  // namespace driftless
