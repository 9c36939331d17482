#include "experiments/transport/equilibrium.hpp"

namespace driftless::transport {
namespace {

/// The series of one axis' waves.
struct Series {
  std::vector<Complex> density, longitudinal, transverse[2], energy;

  void take(System& system, int axis, int number) {
    const Modes now = modes(system, axis, number);
    density.push_back(now.density);
    longitudinal.push_back(now.longitudinal);
    for (int n = 0; n < 2; ++n) transverse[n].push_back(now.transverse[n]);
    energy.push_back(now.energy);
  }
};

void add(const std::vector<double>& values, double weight, std::vector<double>& sum) {
  sum.resize(values.size(), 0.0);
  for (std::size_t n = 0; n < values.size(); ++n) sum[n] += weight * values[n];
}

}  // namespace

EquilibriumRecord run_equilibrium(const EquilibriumSchedule& schedule, Integrator& integrator,
                                  System& system, std::uint64_t& done) {
  Diffusion particles(schedule.particle_lags);
  std::vector<Series> waves(schedule.axes.size());
  for (std::uint64_t step = 0; step < schedule.warm_up + schedule.steps; ++step) {
    system.set_step(++done);
    integrator.step(system, schedule.step);
    if (step < schedule.warm_up) continue;
    const std::uint64_t measured = step - schedule.warm_up;
    if (measured % schedule.particle_stride == 0) particles.take(system);
    if (measured % schedule.wave_stride != 0) continue;
    for (std::size_t n = 0; n < waves.size(); ++n) {
      waves[n].take(system, schedule.axes[n], schedule.number);
    }
  }
  EquilibriumRecord record;
  record.interval = schedule.step * static_cast<double>(schedule.wave_stride);
  record.particle_interval = schedule.step * static_cast<double>(schedule.particle_stride);
  record.squared_displacement = particles.squared_displacement();
  record.velocity = particles.velocity_autocorrelation();
  const double weight = 1 / static_cast<double>(waves.size());
  for (const auto& series : waves) {
    const std::size_t lags = schedule.wave_lags;
    add(autocorrelation(series.longitudinal, lags), weight, record.longitudinal);
    for (const auto& one : series.transverse) {
      add(autocorrelation(one, lags), 0.5 * weight, record.transverse);
    }
    const auto heat = orthogonal_part(series.energy, series.density);
    add(autocorrelation(heat, lags), weight, record.heat);
  }
  return record;
}

}  // namespace driftless::transport
