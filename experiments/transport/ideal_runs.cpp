#include "experiments/transport/ideal_runs.hpp"

namespace driftless::transport {

void WaveRecords::add(const WaveRecord& record) {
  interval = record.interval;
  if (!record.transverse.empty()) transverse.push_back(record.transverse);
  if (!record.longitudinal.empty()) longitudinal.push_back(record.longitudinal);
  if (!record.temperature.empty()) temperature.push_back(record.temperature);
}

WaveRecords relax_replicas(const IdealRun& run, const Waves& waves, const WaveSchedule& schedule) {
  WaveRecords records;
  for (unsigned replica = 0; replica < run.replicas; ++replica) {
    System system = run.start(replica);
    const auto integrator = find_method(run.method.name)->make(run.method.options);
    std::uint64_t done = 0;
    records.add(relax(waves, schedule, *integrator, system, done));
  }
  return records;
}

Estimate viscosity(const WaveRecords& records, double wavenumber, const FluidParameters& fluid,
                   double density) {
  return jackknife(records.transverse, [&](const std::vector<double>& mean) {
    return viscosity(Decay{records.interval, mean}, wavenumber, fluid, density);
  });
}

Estimate conductivity(const WaveRecords& records, double wavenumber, const FluidParameters& fluid,
                      double density) {
  return jackknife(records.temperature, [&](const std::vector<double>& mean) {
    return conductivity(Decay{records.interval, mean}, wavenumber, fluid, density);
  });
}

namespace {

/// The mean of 1/conductivity, whose noise is that of the temperature, and the amplitude.
std::vector<double> heat(const IdealRun& run, const SourceSchedule& schedule, unsigned replica) {
  System system = run.start(replica);
  const auto integrator = find_method(run.method.name)->make(run.method.options);
  std::vector<HeatSource> sources;
  for (int axis = 0; axis < 3; ++axis) sources.emplace_back(schedule.shape, axis, schedule.rate);
  for (std::uint64_t step = 1; step <= schedule.warm_up + schedule.steps; ++step) {
    system.set_step(step);
    integrator->step(system, schedule.step);
    if (step == schedule.warm_up) {
      for (auto& source : sources) source.reset();
    }
    for (auto& source : sources) {
      source.apply(system, schedule.step);
      if (step % schedule.stride == 0) source.measure(system);
    }
  }
  std::vector<double> means(2, 0.0);
  for (const auto& source : sources) {
    means[0] += 1 / source.conductivity(system) / 3;
    means[1] += source.amplitude(system) / 3;
  }
  return means;
}

}  // namespace

SourceResult heat_replicas(const IdealRun& run, const SourceSchedule& schedule) {
  std::vector<std::vector<double>> all;
  SourceResult result;
  for (unsigned replica = 0; replica < run.replicas; ++replica) {
    all.push_back(heat(run, schedule, replica));
    result.amplitude += all.back()[1] / run.replicas;
  }
  result.conductivity = jackknife(all, [](const std::vector<double>& mean) { return 1 / mean[0]; });
  return result;
}

}  // namespace driftless::transport
