#include "model/initial.hpp"

#include <algorithm>
#include <boost/random/gamma_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

namespace driftless {
namespace {

std::size_t island_size(Layout layout, std::size_t particles) {
  return layout == Layout::pairs ? 2 : particles;
}

/// Calls visit(first, last) with the places of each island's particles.
template <class Visit>
void for_each_island(Layout layout, const State& state, Visit&& visit) {
  const std::size_t size = island_size(layout, state.size());
  for (std::size_t first = 0; first + size <= state.size(); first += size) {
    visit(first, first + size);
  }
}

/// Mass of a particle in units of the first species'.
double relative_mass(const Fluid& fluid, const State& state, std::size_t place) {
  return fluid.mass(state.species_of(place)) / fluid.mass();
}

double shape_of(const Fluid& fluid, std::size_t species) {
  return heat_capacity(fluid, species) / fluid.boltzmann() + 1;
}

/// Normal velocities without momentum, standard ones for the mass of the first species; along x
/// alone for pairs.
void draw_directions(const Fluid& fluid, Layout layout, const Noise& noise, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    auto stream = noise.particle_stream(state.id[i], Purpose::initial_velocity);
    boost::random::normal_distribution<double> normal;
    const int components = layout == Layout::pairs ? 1 : 3;
    state.velocity[i] = Vector::Zero();
    for (int axis = 0; axis < components; ++axis) state.velocity[i][axis] = normal(stream);
    state.velocity[i] /= std::sqrt(relative_mass(fluid, state, i));
  }
  for_each_island(layout, state, [&](std::size_t first, std::size_t last) {
    Vector mean = Vector::Zero();
    double mass = 0;
    for (std::size_t i = first; i < last; ++i) {
      mean += relative_mass(fluid, state, i) * state.velocity[i];
      mass += relative_mass(fluid, state, i);
    }
    mean /= mass;
    for (std::size_t i = first; i < last; ++i) state.velocity[i] -= mean;
  });
}

/// Twice the kinetic energy over the mass of the first species.
double squared_speeds(const Fluid& fluid, const State& state, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    sum += relative_mass(fluid, state, i) * state.velocity[i].squaredNorm();
  }
  return sum;
}

/// Sites as far apart along each axis, for a box of sides in these proportions.
Eigen::Vector3i lattice_sites(std::size_t particles, const Vector& lengths) {
  const double per_length = std::cbrt(static_cast<double>(particles) / lengths.prod());
  const int x = static_cast<int>(std::ceil(lengths[0] * per_length - 1e-9));
  const int y = static_cast<int>(std::ceil(lengths[1] * per_length - 1e-9));
  const auto per_plane = static_cast<std::size_t>(x * y);
  return {x, y, static_cast<int>((particles + per_plane - 1) / per_plane)};
}

Vector lattice_position(const Box& box, const Eigen::Vector3i& sites, std::size_t n) {
  const auto x = n % sites[0], y = n / sites[0] % sites[1], z = n / sites[0] / sites[1];
  return {(static_cast<double>(x) + 0.5) * box.lengths[0] / sites[0],
          (static_cast<double>(y) + 0.5) * box.lengths[1] / sites[1],
          (static_cast<double>(z) + 0.5) * box.lengths[2] / sites[2]};
}

}  // namespace

double MicrocanonicalLaw::internal_energy_variance(double e) const {
  const double total = total_shape();
  return e * e * shape * (total - shape) / (total * total * (total + 1));
}

double MicrocanonicalLaw::internal_energy_skewness() const {
  const double total = total_shape(), other = total - shape;
  return 2 * (other - shape) * std::sqrt(total + 1) / ((total + 2) * std::sqrt(shape * other));
}

double heat_capacity(const Fluid& fluid, std::size_t species) {
  const auto& f = fluid.parameters();
  if (fluid.has_constant_heat_capacities()) {
    return species == 0 ? f.heat_capacity : f.further_species[species - 1].heat_capacity;
  }
  const auto& state = fluid.equation_of_state(species);
  return 1 / state.inverse_heat_capacity(state.internal_energy(f.temperature));
}

MicrocanonicalLaw microcanonical_law(const Fluid& fluid, Layout layout, std::size_t particles,
                                     const std::vector<std::uint8_t>& species) {
  MicrocanonicalLaw law;
  law.particles = island_size(layout, particles);
  law.islands = particles / law.particles;
  law.degrees = layout == Layout::pairs ? 1 : 3 * (static_cast<double>(particles) - 1);
  law.boltzmann = fluid.boltzmann();
  law.shape = shape_of(fluid, 0);
  for (std::size_t i = 0; i < std::min(law.particles, species.size()); ++i) {
    const double excess = shape_of(fluid, species[i]) - law.shape;
    law.excess_shape += excess;
    law.alike = law.alike && excess == 0;
  }
  return law;
}

Box make_box(const Fluid& fluid, Layout layout, std::size_t particles, double density,
             double pair_distance) {
  if (layout == Layout::fluid) {
    return {Vector::Constant(std::cbrt(static_cast<double>(particles) / density))};
  }
  const double apart = 1.25 * fluid.range();  // beyond the range, whatever the rounding
  const Vector cell(pair_distance + apart, apart, apart);
  // At least three cells a side keep every pair clear of its own images.
  const Eigen::Vector3i sites = lattice_sites(particles / 2, Vector::Ones()).cwiseMax(3);
  return {cell.cwiseProduct(sites.cast<double>())};
}

State place(const Box& box, Layout layout, Placement placement, std::size_t particles,
            double pair_distance, const Noise& noise) {
  State state;
  state.velocity.assign(particles, Vector::Zero());
  state.internal_energy.assign(particles, 0.0);
  const bool pairs = layout == Layout::pairs;
  auto sites =
      pairs ? lattice_sites(particles / 2, Vector::Ones()) : lattice_sites(particles, box.lengths);
  if (pairs) sites = sites.cwiseMax(3);
  for (std::size_t i = 0; i < particles; ++i) {
    state.id.push_back(static_cast<std::uint32_t>(i));
    Vector position = lattice_position(box, sites, pairs ? i / 2 : i);
    if (pairs) {
      position[0] += (i % 2 == 0 ? 0.5 : -0.5) * pair_distance;
    } else if (placement == Placement::random) {
      auto stream = noise.particle_stream(state.id[i], Purpose::initial_position);
      boost::random::uniform_01<double> uniform;
      for (int axis = 0; axis < 3; ++axis) position[axis] = uniform(stream) * box.lengths[axis];
    }
    state.position.push_back(position);
  }
  return state;
}

void draw_microcanonical(const Fluid& fluid, Layout layout, double energy, const Noise& noise,
                         State& state) {
  draw_directions(fluid, layout, noise, state);
  for (std::size_t i = 0; i < state.size(); ++i) {
    auto stream = noise.particle_stream(state.id[i], Purpose::initial_energy);
    const double shape = shape_of(fluid, state.species_of(i));
    state.internal_energy[i] = boost::random::gamma_distribution<double>(shape)(stream);
  }
  for_each_island(layout, state, [&](std::size_t first, std::size_t last) {
    // Kinetic energy m v^2/2 of unit normals is a Gamma(degrees/2) variate in units of m.
    double sum = 0.5 * squared_speeds(fluid, state, first, last);
    for (std::size_t i = first; i < last; ++i) sum += state.internal_energy[i];
    const double scale = energy / sum;
    for (std::size_t i = first; i < last; ++i) {
      state.internal_energy[i] *= scale;
      state.velocity[i] *= std::sqrt(scale / fluid.mass());
    }
  });
}

void draw_canonical(const Fluid& fluid, Layout layout, double temperature, const Noise& noise,
                    State& state) {
  draw_directions(fluid, layout, noise, state);
  const double spread = std::sqrt(fluid.boltzmann() * temperature / fluid.mass());
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity[i] *= spread;
    state.internal_energy[i] = 0;
  }
}

void draw_off_equilibrium(const Fluid& fluid, Layout layout, double energy, const Noise& noise,
                          State& state) {
  const auto law = microcanonical_law(fluid, layout, state.size(), state.species);
  draw_alike(fluid, layout, energy, 0.5 * law.kinetic_energy(energy), noise, state);
}

void draw_alike(const Fluid& fluid, Layout layout, double energy, double kinetic,
                const Noise& noise, State& state) {
  draw_directions(fluid, layout, noise, state);
  for_each_island(layout, state, [&](std::size_t first, std::size_t last) {
    const double present = 0.5 * fluid.mass() * squared_speeds(fluid, state, first, last);
    const double scale = present > 0 ? std::sqrt(kinetic / present) : 0;  // one particle: none
    const auto relative = [&](std::size_t i) {
      const double temperature = fluid.parameters().temperature;
      const auto& particle = fluid.equation_of_state(state.species_of(i));
      return particle.internal_energy(temperature) / fluid.internal_energy(temperature);
    };
    double energies = 0;  // in units of the first species' at one temperature
    for (std::size_t i = first; i < last; ++i) energies += relative(i);
    for (std::size_t i = first; i < last; ++i) {
      state.velocity[i] *= scale;
      state.internal_energy[i] = (energy - kinetic) / energies * relative(i);
    }
  });
}

void draw_given_spread(const Fluid& fluid, Layout layout, double spread, double temperature,
                       const Noise& noise, State& state) {
  draw_directions(fluid, layout, noise, state);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity[i] *= spread;
    const auto& particle = fluid.equation_of_state(state.species_of(i));
    state.internal_energy[i] = particle.internal_energy(temperature);
  }
}

void boost_frame(const Vector& velocity, State& state) {
  for (auto& v : state.velocity) v += velocity;
}

}  // namespace driftless
