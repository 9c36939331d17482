#include <cmath>
#include <numbers>

#include "experiments/observables.hpp"
#include "experiments/primary_quantities.hpp"
#include "model/configurations.hpp"

namespace driftless {
namespace {

std::vector<Block> empty_blocks(unsigned replica, std::size_t bins) {
  std::vector<Block> blocks(Sampler::blocks);
  for (std::size_t index = 0; index < blocks.size(); ++index) {
    blocks[index] = {replica, index, std::vector<std::uint64_t>(bins, 0)};
  }
  return blocks;
}

// The radial distribution needs no more snapshots than this from a replica.
constexpr std::size_t distance_snapshots = 64;

}  // namespace

double Sampler::distance_range(const PreparedScene& prepared) {
  if (prepared.scene().layout == Layout::pairs || prepared.scene().frozen) return 0;
  return std::min(2 * prepared.fluid().range(), 0.5 * prepared.box().lengths.minCoeff());
}

Sampler::Sampler(const PreparedScene& prepared, System& system, unsigned replica,
                 std::size_t samples)
    : prepared_(prepared),
      distances_(prepared.box(), distance_range(prepared), system.size()),
      first_energy_(system.energy_with_surroundings()),
      first_momentum_(system.momentum_with_surroundings()),
      island_size_(prepared.island_size()) {
  const auto exact = prepared.reference("internal_energy_mean");
  mean_energy_ = exact ? exact->value : 0;
  record_.samples = Eigen::MatrixXd::Zero(samples, Primary::count);
  record_.energy.times = record_.energy.energies = Eigen::VectorXd::Zero(samples);
  if (prepared.distributions()) {
    const auto bins = prepared.distributions()->momentum.bins();
    record_.momentum_blocks = empty_blocks(replica, bins);
    if (prepared.distributions()->internal_energy) {
      record_.internal_energy_blocks = empty_blocks(replica, bins);
    }
  }
  if (distance_range(prepared) > 0) {
    record_.distance_blocks = empty_blocks(replica, distance_bins);
    record_.distance_snapshots.assign(blocks, 0);
  }
}

Sampler::Island Sampler::island(const State& state, std::size_t first, std::size_t last) const {
  Island result{Vector::Zero(), 0, 0};
  const Fluid& fluid = prepared_.fluid();
  double mass = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double of_particle = fluid.mass(state.species_of(i));
    result.velocity += of_particle * state.velocity[i];
    mass += of_particle;
  }
  result.velocity /= mass;
  for (std::size_t i = first; i < last; ++i) {
    const double of_particle = fluid.mass(state.species_of(i));
    result.kinetic += 0.5 * of_particle * (state.velocity[i] - result.velocity).squaredNorm();
    result.internal += state.internal_energy[i];
  }
  return result;
}

void Sampler::take_island(const State& state, std::size_t first, std::size_t last,
                          Eigen::RowVectorXd& sums) {
  const Island whole = island(state, first, last);
  const auto& law = prepared_.law();
  const Fluid& fluid = prepared_.fluid();
  const double energy = (law && law->degrees == 0 ? 0.0 : whole.kinetic) + whole.internal;
  const bool scaled = law && !prepared_.fluid().has_repulsion();
  const double scale = scaled ? prepared_.island_energy() / energy : 1;
  sums[Primary::kinetic] += whole.kinetic * scale;
  sums[Primary::kinetic_share] += whole.kinetic / (whole.kinetic + whole.internal);
  const std::size_t block = taken_ * blocks / static_cast<std::size_t>(record_.samples.rows());
  double masses = 0;  // in units of the first species'
  for (std::size_t i = first; i < last; ++i) {
    masses += fluid.mass(state.species_of(i)) / fluid.mass();
  }
  // Of a momentum's square: a share of twice the energy, or k T of the bath.
  const double unit =
      fluid.isothermal() ? fluid.boltzmann() * fluid.parameters().temperature : 2 * energy;
  const int components = prepared_.scene().layout == Layout::pairs ? 1 : 3;
  for (std::size_t i = first; i < last; ++i) {
    if (!fluid.isothermal()) {
      const double u = state.internal_energy[i] * scale, excess = u - mean_energy_;
      sums[Primary::inverse_temperature] +=
          1 / fluid.equation_of_state(state.species_of(i)).temperature(u);
      sums[Primary::energy_1] += excess;
      sums[Primary::energy_2] += excess * excess;
      sums[Primary::energy_3] += excess * excess * excess;
    }
    if (!prepared_.distributions()) continue;
    const auto& exact = *prepared_.distributions();
    if (exact.internal_energy) {
      ++record_.internal_energy_blocks[block]
            .counts[exact.internal_energy->bin(state.internal_energy[i] / energy)];
    }
    if (components == 1 && i > first) continue;  // the partner's momentum is the opposite
    const double mass = fluid.mass(state.species_of(i));
    const double momentum_scale = std::sqrt(mass / (unit * (1 - mass / fluid.mass() / masses)));
    for (int axis = 0; axis < components; ++axis) {
      const double v = state.velocity[i][axis] - whole.velocity[axis];
      ++record_.momentum_blocks[block].counts[exact.momentum.bin(v * momentum_scale)];
    }
  }
}

void Sampler::take_distances(const State& state) {
  const std::size_t samples = static_cast<std::size_t>(record_.samples.rows());
  const std::size_t every = std::max<std::size_t>(1, samples / distance_snapshots);
  if (record_.distance_blocks.empty() || taken_ % every != 0) return;
  const std::size_t block = taken_ * blocks / samples;
  ++record_.distance_snapshots[block];
  auto& counts = record_.distance_blocks[block].counts;
  const double bins_per_length = distance_bins / distance_range(prepared_);
  distances_.find(state, [&](const PairSearch::Found& pair) {
    const auto bin = static_cast<std::size_t>(std::sqrt(pair.squared_distance) * bins_per_length);
    ++counts[std::min(bin, distance_bins - 1)];
  });
}

void Sampler::take(System& system, double time) {
  const State& state = system.state();
  const double particles = static_cast<double>(system.size());
  Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(Primary::count);
  for (std::size_t first = 0; first + island_size_ <= system.size(); first += island_size_) {
    take_island(state, first, first + island_size_, sums);
  }
  const double islands = particles / static_cast<double>(island_size_);
  sums[Primary::kinetic] /= islands;
  sums[Primary::kinetic_share] /= islands;
  for (int n = Primary::inverse_temperature; n <= Primary::energy_3; ++n) sums[n] /= particles;
  const auto configuration = configuration_sums(system);
  sums[Primary::potential] = configuration.potential / particles;
  sums[Primary::virial] = configuration.virial;
  sums[Primary::squared_force] = configuration.squared_force / particles;
  sums[Primary::laplacian] = configuration.laplacian / particles;
  record_.samples.row(static_cast<Eigen::Index>(taken_)) = sums;

  const auto& f = prepared_.fluid().parameters();
  const double unit = prepared_.energy_unit();
  record_.energy.times[static_cast<Eigen::Index>(taken_)] = time;
  record_.energy.energies[static_cast<Eigen::Index>(taken_)] =
      (system.energy_with_surroundings() - first_energy_) / (particles * unit);
  record_.momentum_error = std::max(record_.momentum_error,
                                    (system.momentum_with_surroundings() - first_momentum_).norm() /
                                        particles / std::sqrt(f.mass * unit));
  take_distances(state);
  ++taken_;
}

}  // namespace driftless
