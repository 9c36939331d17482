#pragma once

#include <string>

#include "experiments/study.hpp"
#include "experiments/transport/gradient.hpp"
#include "experiments/transport/starts.hpp"
#include "experiments/transport/waves.hpp"

/// Independent replicas of fluids without repulsion, from their exact law.
namespace driftless::transport {

struct IdealRun {
  FluidParameters fluid;
  FluidBox box;
  MethodChoice method = {"metropolized-splitting", {}};
  unsigned replicas = 8;
  std::uint64_t seed = 1;

  double density() const { return static_cast<double>(box.particles) / box.box.volume(); }
  System start(unsigned replica) const { return ideal_start(fluid, box, Noise(seed, replica)); }
};

/// Decays of imposed waves, one of every replica; equally long, at the same times.
struct WaveRecords {
  double interval = 0;
  std::vector<std::vector<double>> transverse, longitudinal, temperature;

  void add(const WaveRecord& record);
};
WaveRecords relax_replicas(const IdealRun& run, const Waves& waves, const WaveSchedule& schedule);

/// Viscosity or conductivity with the replicas' error; `wavenumber` that of the waves.
Estimate viscosity(const WaveRecords& records, double wavenumber, const FluidParameters& fluid,
                   double density);
Estimate conductivity(const WaveRecords& records, double wavenumber, const FluidParameters& fluid,
                      double density);

/// A steady source of heat along every axis.
struct SourceSchedule {
  HeatShape shape = HeatShape::cosine;
  double rate = 0;            ///< of HeatSource
  double step = 0;            ///< of time
  std::uint64_t warm_up = 0;  ///< steps until it is steady
  std::uint64_t steps = 0;    ///< that are measured
  std::uint64_t stride = 1;   ///< steps between measurements
};

struct SourceResult {
  Estimate conductivity;
  double amplitude = 0;  ///< relative, of the temperature waves
};
SourceResult heat_replicas(const IdealRun& run, const SourceSchedule& schedule);

}  // namespace driftless::transport
