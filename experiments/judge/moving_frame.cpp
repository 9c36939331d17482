#include "experiments/judge/moving_frame.hpp"

#include <cmath>

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double sample_every = 0.16;
/// A start from the exact law of the fluid needs to forget only what the step's size changes fast.
constexpr double settle = 1.6;

double internal_temperature(const System& system) {
  double inverse = 0;
  for (const double u : system.state().internal_energy) {
    inverse += 1 / system.fluid().temperature(u);
  }
  return static_cast<double>(system.size()) / inverse;
}

double kinetic_temperature(const System& system) {
  const auto& velocity = system.state().velocity;
  const double n = static_cast<double>(velocity.size());
  Vector mean = Vector::Zero();
  for (const auto& v : velocity) mean += v / n;
  double squares = 0;
  for (const auto& v : velocity) squares += (v - mean).squaredNorm();
  return system.fluid().mass() * squares / (3 * (n - 1) * system.fluid().boltzmann());
}

double internal_energy_variance(const System& system) {
  const auto& energies = system.state().internal_energy;
  const auto u = Eigen::ArrayXd::Map(energies.data(), static_cast<Eigen::Index>(energies.size()));
  return (u - u.mean()).square().sum() / static_cast<double>(energies.size() - 1);
}

/// What is compared after a short time.
struct End {
  std::vector<double> internal_energy;
  double temperature = 0;
};

struct Changes {
  std::vector<double> rates;
  double squares = 0;
};

void compare(const End& rest, const End& moving, double duration, Changes& changes) {
  changes.rates.push_back((moving.temperature / rest.temperature - 1) / duration);
  const double n = static_cast<double>(rest.internal_energy.size());
  double mean = 0, squares = 0;
  for (std::size_t i = 0; i < rest.internal_energy.size(); ++i) {
    mean += rest.internal_energy[i] / n;
    squares += std::pow(moving.internal_energy[i] - rest.internal_energy[i], 2) / n;
  }
  changes.squares += squares / (mean * mean);
}

/// Mean and standard error of a few independent numbers.
json mean_of(const std::vector<double>& values) {
  const auto all = Eigen::ArrayXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
  const double n = static_cast<double>(values.size());
  const double variance = (all - all.mean()).square().sum() / (n - 1);
  return {{"value", all.mean()}, {"error", std::sqrt(variance / n)}, {"degrees_of_freedom", n - 1}};
}

json change_at(const Candidate& candidate, const PreparedScene& scene, double speed,
               const std::vector<std::optional<End>>& at_rest, double time_step, double duration) {
  const auto steps = static_cast<std::uint64_t>(std::llround(duration / time_step));
  const auto runs = static_cast<unsigned>(at_rest.size());
  const Vector velocity = frame_velocity(scene.fluid(), speed);
  Changes changes;
  std::vector<Failure> failures;
  for (unsigned run = 0; run < runs; ++run) {
    if (!at_rest[run]) continue;
    End end;
    const auto failure = run_isolated(
        candidate, scene, run, velocity, time_step, steps, steps, [&](System& system, double) {
          end = {system.state().internal_energy, internal_temperature(system)};
        });
    if (failure) {
      failures.push_back(*failure);
    } else {
      compare(*at_rest[run], end, duration, changes);
    }
  }
  json record = failures_record(runs, failures);
  record["speed"] = speed;
  if (changes.rates.size() < 2) return record;
  record["rate"] = mean_of(changes.rates);
  const double compared = static_cast<double>(changes.rates.size());
  record["spread"] = std::sqrt(changes.squares / compared);
  record["energies"] = compared * static_cast<double>(scene.scene().particles);
  return record;
}

}  // namespace

Vector frame_velocity(const Fluid& fluid, double thermal_velocities) {
  const double thermal =
      std::sqrt(fluid.boltzmann() * fluid.parameters().temperature / fluid.mass());
  return thermal_velocities * thermal * Vector(1.7, -0.9, 2.3).normalized();
}

json frame_change(const Candidate& candidate, const PreparedScene& scene, unsigned runs,
                  const std::vector<double>& speeds, double time_step, double duration) {
  const auto steps = static_cast<std::uint64_t>(std::llround(duration / time_step));
  std::vector<std::optional<End>> at_rest(runs);
  for (unsigned run = 0; run < runs; ++run) {
    const auto failure = run_isolated(
        candidate, scene, run, Vector::Zero(), time_step, steps, steps,
        [&](System& system, double) {
          at_rest[run] = {system.state().internal_energy, internal_temperature(system)};
        });
    if (failure) at_rest[run].reset();
  }
  json record = {{"time_step", time_step}, {"speeds", json::array()}};
  for (const double speed : speeds) {
    record["speeds"].push_back(change_at(candidate, scene, speed, at_rest, time_step, duration));
  }
  return record;
}

json frame_averages(const Candidate& candidate, const PreparedScene& scene, unsigned runs,
                    double speed, double time_step, double duration) {
  const auto stride = static_cast<std::uint64_t>(std::llround(sample_every / time_step));
  const auto samples = static_cast<std::uint64_t>(std::llround((settle + duration) / sample_every));
  const Vector velocity = frame_velocity(scene.fluid(), speed);
  std::vector<Failure> failures;
  json kinetic = json::array(), internal = json::array(), variance = json::array();
  for (unsigned run = 0; run < runs; ++run) {
    Eigen::Array3d sums = Eigen::Array3d::Zero();
    double count = 0;
    const auto failure = run_isolated(candidate, scene, run, velocity, time_step, samples * stride,
                                      stride, [&](System& system, double time) {
                                        if (time < settle) return;
                                        ++count;
                                        sums += Eigen::Array3d(kinetic_temperature(system),
                                                               internal_temperature(system),
                                                               internal_energy_variance(system));
                                      });
    if (failure) failures.push_back(*failure);
    kinetic.push_back(failure ? json() : json(sums[0] / count));
    internal.push_back(failure ? json() : json(sums[1] / count));
    variance.push_back(failure ? json() : json(sums[2] / count));
  }
  json record = failures_record(runs, failures);
  record["speed"] = speed;
  record["time_step"] = time_step;
  record["kinetic_temperature"] = kinetic;
  record["internal_temperature"] = internal;
  record["internal_energy_variance"] = variance;
  return record;
}

}  // namespace driftless::judge
