#include "experiments/transport/waves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/transport/theory.hpp"

namespace driftless::transport {
namespace {

/// The velocity a particle gets, over the thermal one.
Vector velocity_wave(const Waves& waves, const Box& box, const Vector& position, double phase) {
  Vector sum = Vector::Zero();
  for (const int axis : waves.axes) {
    const double k = wave_vector(box, axis, waves.number)[axis];
    const double wave = std::cos(k * position[axis] - phase);
    sum[axis] += waves.longitudinal * wave;
    for (int n = 1; n <= 2; ++n) sum[(axis + n) % 3] += waves.transverse * wave;
  }
  return sum;
}

double temperature_factor(const Waves& waves, const Box& box, const Vector& position,
                          double phase) {
  double sum = 1;
  for (const int axis : waves.axes) {
    const double k = wave_vector(box, axis, waves.number)[axis];
    sum += waves.temperature * std::cos(k * position[axis] - phase);
  }
  return sum;
}

void keep_momentum_and_energy(const Vector& momentum, double energy, System& system) {
  const auto size = static_cast<double>(system.size());
  const Vector gained = (system.momentum() - momentum) / (size * system.fluid().mass());
  system.update([&](std::size_t, Vector& velocity, double&) { velocity -= gained; });
  if (system.fluid().isothermal()) return;
  const double internal = system.internal_energy();
  const double factor = (energy - system.kinetic_energy()) / internal;
  system.update([&](std::size_t, Vector&, double& u) { u *= factor; });
}

void take(const Waves& waves, double phase, System& system, std::size_t sample, WaveRecord& sums) {
  const Complex turn = std::polar(1.0, phase);
  for (const int axis : waves.axes) {
    const Modes found = modes(system, axis, waves.number);
    for (const auto& amplitude : found.transverse) {
      sums.transverse[sample] += (amplitude * turn).real();
    }
    sums.longitudinal[sample] += (found.longitudinal * turn).real();
    sums.temperature[sample] += (found.internal_energy * turn).real();
  }
}

}  // namespace

void impose(const Waves& waves, double phase, System& system) {
  const auto& fluid = system.fluid().parameters();
  const double thermal = std::sqrt(fluid.boltzmann * fluid.temperature / fluid.mass);
  const Vector momentum = system.momentum();
  const double energy = system.kinetic_energy() + system.internal_energy();
  const auto& positions = system.state().position;
  system.update([&](std::size_t i, Vector& velocity, double& u) {
    const double factor = temperature_factor(waves, system.box(), positions[i], phase);
    u *= factor;
    velocity *= std::sqrt(factor);
    velocity += thermal * velocity_wave(waves, system.box(), positions[i], phase);
  });
  keep_momentum_and_energy(momentum, energy, system);
}

std::uint64_t stride_of(double window, std::uint64_t samples, double step) {
  return std::max<std::uint64_t>(1, std::llround(window / (static_cast<double>(samples) * step)));
}

WaveRecord relax(const Waves& waves, const WaveSchedule& schedule, Integrator& integrator,
                 System& system, std::uint64_t& done) {
  WaveRecord record;
  record.interval = schedule.step * static_cast<double>(schedule.stride);
  for (auto* curve : {&record.transverse, &record.longitudinal, &record.temperature}) {
    curve->assign(schedule.samples + 1, 0.0);
  }
  for (unsigned n = 0; n < schedule.impositions; ++n) {
    const double phase = 0.5 * std::numbers::pi * n;
    impose(waves, phase, system);
    take(waves, phase, system, 0, record);
    for (std::uint64_t sample = 1; sample <= schedule.samples; ++sample) {
      for (std::uint64_t step = 0; step < schedule.stride; ++step) {
        system.set_step(++done);
        integrator.step(system, schedule.step);
      }
      take(waves, phase, system, sample, record);
    }
  }
  if (waves.transverse == 0) record.transverse.clear();
  if (waves.longitudinal == 0) record.longitudinal.clear();
  if (waves.temperature == 0) record.temperature.clear();
  return record;
}

double viscosity(const Decay& transverse, double wavenumber, const FluidParameters& fluid,
                 double density) {
  return density * fluid.mass * integral_rate(transverse) / (wavenumber * wavenumber);
}

double conductivity(const Decay& temperature, double wavenumber, const FluidParameters& fluid,
                    double density) {
  return density * heat_capacity_at_volume(fluid) * integral_rate(temperature) /
         (wavenumber * wavenumber);
}

double sound_speed(const Decay& longitudinal, double wavenumber, double guess) {
  const auto fit = fit_oscillation(longitudinal, guess * wavenumber);
  if (!fit) throw std::domain_error("a longitudinal wave does not oscillate");
  return fit->undamped_frequency() / wavenumber;
}

}  // namespace driftless::transport
