#include "model/system.hpp"

// The part of System that a repulsion which follows the temperatures needs
// (FluidParameters::thermal_repulsion).
namespace driftless {

void System::renew_factors() {
  if (factors_version_ == positions_version_) return;
  const auto halves = [](const auto& pair) {
    const auto half = 0.5 * pair.law->thermal_shape(pair.r);
    return Transfer{0 * half, half, half};
  };
  const PairKernel kernel = PairKernel::of(halves);
  sum(thermal_, [&](PairPass& pass, PairBlock&, std::size_t, std::size_t count) {
    pass.geometry(0, count);
    pass.run(kernel, 0, count);
  });
  energy_factor_.resize(size());
  const auto& f = fluid_.parameters();
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double per_energy = equation_of_state(i).inverse_heat_capacity(1.0) / f.temperature;
      energy_factor_[i] = 1 + f.thermal_repulsion * per_energy * thermal_.energy[i];
    }
  });
  factors_version_ = positions_version_;
  thermal_positions_version_ = 0;  // the force has served for memory
  count_visit(false, false);
}

void System::renew_thermal_force() {
  renew_conservative();
  renew_factors();
  if (thermal_positions_version_ == positions_version_ &&
      thermal_energies_version_ == energies_version_) {
    return;
  }
  find_pairs();
  const auto& f = fluid_.parameters();
  thermal_repulsion_.resize(size());
  motion_.assign(size() + BoundaryContacts::numbers, {});
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t i = cells_.place(n);
      const double u = state_.internal_energy[i] / energy_factor_[i];
      thermal_repulsion_[i] =
          f.thermal_repulsion * equation_of_state(i).temperature(u) / (2 * f.temperature);
      motion_[n].energy = thermal_repulsion_[i];
    }
  });
  // In the place of energies pairs see the strengths.
  const auto repulsion = [](const auto& pair) {
    return Transfer{(pair.u_i + pair.u_j) * pair.law->thermal_shape_force(pair.r)};
  };
  const PairKernel kernel = PairKernel::of(repulsion);
  const PassParticles particles{motion_.data(), nullptr, nullptr, nullptr};
  sum(thermal_, [&](PairPass& pass, PairBlock&, std::size_t, std::size_t count) {
    pass.geometry(0, count);
    pass.motion(particles, 0, count);
    pass.run(kernel, 0, count);
  });
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) thermal_.momentum[i] += conservative_.momentum[i];
  });
  thermal_positions_version_ = positions_version_;
  thermal_energies_version_ = energies_version_;
  count_visit(false, false);
}

void System::follow_factors(const std::vector<double>& before) {
  if (!fluid_.repulsion_follows_temperatures()) return;
  renew_factors();
  update([&](std::size_t i, Vector&, double& energy) { energy *= energy_factor_[i] / before[i]; });
}

const std::vector<double>& System::thermal_repulsion() {
  if (fluid_.repulsion_follows_temperatures()) renew_thermal_force();
  return thermal_repulsion_;
}

const std::vector<double>& System::energy_factors() {
  if (fluid_.repulsion_follows_temperatures()) renew_factors();
  return energy_factor_;
}

}  // namespace driftless
