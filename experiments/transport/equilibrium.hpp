#pragma once

#include <cstdint>
#include <vector>

#include "experiments/transport/diffusion.hpp"
#include "experiments/transport/modes.hpp"
#include "integrators/integrator.hpp"

namespace driftless::transport {

/// What one run in equilibrium says of transport: autocorrelations by lag, means over axes (and
/// both transverse components) of the wave with `number` wavelengths in the box.
struct EquilibriumRecord {
  double interval = 0;
  std::vector<double> squared_displacement,
      velocity;  ///< of single particles, in shorter intervals
  double particle_interval = 0;
  std::vector<double> transverse, longitudinal;
  /// Of the wave of total energy without what goes along with that of density: temperature.
  std::vector<double> heat;
};

struct EquilibriumSchedule {
  double step = 0;                    ///< of time
  std::uint64_t warm_up = 0;          ///< steps before anything is measured
  std::uint64_t particle_stride = 1;  ///< steps between samples of particles
  std::size_t particle_lags = 50;
  std::vector<int> axes = {0, 1, 2};
  int number = 1;
  std::uint64_t wave_stride = 1;  ///< steps between samples of waves
  std::size_t wave_lags = 50;
  std::uint64_t steps = 0;  ///< of the measurement
};

/// Runs the system, whose steps are counted on from `done`. Throws StepFailure.
EquilibriumRecord run_equilibrium(const EquilibriumSchedule& schedule, Integrator& integrator,
                                  System& system, std::uint64_t& done);

}  // namespace driftless::transport
