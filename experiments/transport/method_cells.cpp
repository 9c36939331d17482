#include "experiments/transport/method_cells.hpp"

#include <cmath>
#include <numbers>

#include "experiments/judge/isolated_runs.hpp"
#include "experiments/reproduce/estimates.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/transport/equilibrium.hpp"
#include "experiments/transport/ideal_runs.hpp"

namespace driftless::transport {
namespace {

using nlohmann::json;

constexpr std::size_t particle_lags = 41;
constexpr std::uint64_t wave_samples = 120;

/// Curves of the replicas that lived.
struct Curves {
  double particle_interval = 0, heat_interval = 0, flow_interval = 0;
  std::vector<std::vector<double>> moved, heat, transverse, longitudinal, temperature;
};

bool has_flow_box(const TransportScene& scene) { return scene.flow_width > 0; }

System cube_start(const TransportScene& scene, std::uint64_t seed, unsigned replica) {
  if (scene.fluid.has_repulsion()) {
    Scene prepared = find_preset("soft-fluid")->scene;
    prepared.fluid = scene.fluid;
    prepared.density = scene.density;
    prepared.particles =
        static_cast<std::size_t>(std::lround(std::pow(scene.cube_side, 3) * scene.density));
    return judge::prepared_once(prepared, seed, scene.replicas).start(replica);
  }
  const auto box = fluid_box(scene.cube_side, scene.cube_side, scene.density);
  return ideal_start(scene.fluid, box, Noise(seed, replica));
}

void check_energy(double before, System& system) {
  if (!(std::abs(system.total_energy() - before) <= std::abs(before))) {
    throw StepFailure(FailureCause::energy_runaway, {});
  }
}

/// Particles at rest of waves: their displacements, and the kinetic temperature meanwhile.
void follow_particles(const TransportScene& scene, double step, Integrator& integrator,
                      System& system, std::uint64_t& done, Curves& curves) {
  Diffusion particles(particle_lags);
  const auto stride = stride_of(scene.particle_window, particle_lags - 1, step);
  const double energy = system.total_energy();
  const double degrees = 3 * (static_cast<double>(system.size()) - 1);
  double temperature = 0;
  const std::uint64_t samples = scene.particle_windows * particle_lags;
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    particles.take(system);
    temperature += 2 * system.kinetic_energy() / (degrees * system.fluid().boltzmann()) /
                   static_cast<double>(samples);
    for (std::uint64_t n = 0; n < stride; ++n) {
      system.set_step(++done);
      integrator.step(system, step);
    }
    check_energy(energy, system);
  }
  curves.particle_interval = step * static_cast<double>(stride);
  curves.moved.push_back(particles.squared_displacement());
  curves.temperature.push_back({temperature});
}

WaveRecord follow_waves(const Waves& waves, double window, unsigned impositions, double step,
                        Integrator& integrator, System& system, std::uint64_t& done) {
  const WaveSchedule schedule{step, stride_of(window, wave_samples, step), wave_samples,
                              impositions};
  const double energy = system.total_energy();
  auto record = relax(waves, schedule, integrator, system, done);
  check_energy(energy, system);
  return record;
}

void run_cube(const TransportScene& scene, const MethodChoice& choice, double step,
              std::uint64_t seed, unsigned replica, Curves& curves) {
  System system = cube_start(scene, seed, replica);
  const auto integrator = find_method(choice.name)->make(choice.options);
  std::uint64_t done = 0;
  follow_particles(scene, step, *integrator, system, done, curves);
  Waves waves{{0, 1, 2}, 1, 0, 0, 0.1};
  if (!has_flow_box(scene)) waves.transverse = waves.longitudinal = 0.2;
  const auto record = follow_waves(waves, scene.heat_window, scene.heat_impositions, step,
                                   *integrator, system, done);
  curves.heat_interval = record.interval;
  curves.heat.push_back(record.temperature);
  if (has_flow_box(scene)) return;
  curves.flow_interval = record.interval;
  curves.transverse.push_back(record.transverse);
  curves.longitudinal.push_back(record.longitudinal);
}

WaveRecord flow(const TransportScene& scene, const MethodChoice& choice, double step, double length,
                double window, std::uint64_t seed, unsigned replica) {
  const auto box = fluid_box(length, scene.flow_width, scene.density);
  System system = ideal_start(scene.fluid, box, Noise(seed, replica));
  const auto integrator = find_method(choice.name)->make(choice.options);
  std::uint64_t done = 0;
  return follow_waves({{0}, 1, 0.5, 0.3, 0}, window, scene.flow_impositions, step, *integrator,
                      system, done);
}

void run_flow(const TransportScene& scene, const MethodChoice& choice, double step,
              std::uint64_t seed, unsigned replica, Curves& curves) {
  const auto record =
      flow(scene, choice, step, scene.flow_length, scene.flow_window, seed, replica);
  curves.flow_interval = record.interval;
  curves.transverse.push_back(record.transverse);
  curves.longitudinal.push_back(record.longitudinal);
}

Estimate derived(const std::vector<std::vector<double>>& replicas,
                 const std::function<double(const std::vector<double>&)>& derive) {
  if (!replicas.empty()) return jackknife(replicas, derive);
  Estimate none;
  none.mean = std::numeric_limits<double>::quiet_NaN();
  return none;
}

void put_coefficients(const TransportScene& scene, const Curves& curves, json& record) {
  const auto put = [&](const char* name, const std::vector<std::vector<double>>& replicas,
                       const std::function<double(const std::vector<double>&)>& derive) {
    record[name] = reproduce::to_json(derived(replicas, derive));
  };
  put("diffusion", curves.moved, [&](const auto& mean) {
    return diffusion_from_displacement({curves.particle_interval, mean});
  });
  put("viscosity", curves.transverse, [&](const auto& mean) {
    return viscosity({curves.flow_interval, mean}, scene.flow_wavenumber(), scene.fluid,
                     scene.density);
  });
  put("conductivity", curves.heat, [&](const auto& mean) {
    return conductivity({curves.heat_interval, mean}, scene.cube_wavenumber(), scene.fluid,
                        scene.density);
  });
  put("sound speed", curves.longitudinal, [&](const auto& mean) {
    return sound_speed({curves.flow_interval, mean}, scene.flow_wavenumber(), scene.sound_guess);
  });
  put("kinetic temperature", curves.temperature, [](const auto& mean) { return mean[0]; });
}

}  // namespace

double TransportScene::cube_wavenumber() const { return 2 * std::numbers::pi / cube_side; }

double TransportScene::flow_wavenumber() const {
  return 2 * std::numbers::pi / (flow_width > 0 ? flow_length : cube_side);
}

TransportScene ideal_transport_scene(unsigned effort) {
  TransportScene scene;
  scene.name = "ideal fluid";
  scene.fluid = find_preset("mackie-1999")->scene.fluid;
  // Conduction relaxes a particle in 0.09, a close pair in 0.04: beyond, explicit methods break.
  scene.time_steps = {0.04, 0.02, 0.01};
  // A particle's velocity lasts 4 units of time, a wave of 8 units of length 3 to 5.
  scene.cube_side = 8;
  scene.particle_window = 40;
  scene.heat_window = 20;
  // Sound wants waves longer than the 3 units of length that a particle flies.
  scene.flow_length = 30, scene.flow_width = 4.2;
  scene.flow_window = 110;
  scene.flow_impositions = 3;
  scene.sound_guess = 0.75;
  scene.replicas = 6 * effort;
  return scene;
}

TransportScene soft_transport_scene(unsigned effort) {
  TransportScene scene;
  const Scene& preset = find_preset("soft-fluid")->scene;
  scene.name = "soft fluid";
  scene.fluid = preset.fluid;
  scene.density = preset.density;
  scene.time_steps = {0.04, 0.02, 0.01};
  scene.cube_side = 6;
  scene.particle_window = 6;
  scene.heat_window = 15;
  scene.heat_impositions = 3;
  scene.sound_guess = 4.4;
  scene.replicas = 6 * effort;
  return scene;
}

const std::vector<std::string>& coefficient_names() {
  static const std::vector<std::string> names = {"diffusion", "viscosity", "conductivity",
                                                 "sound speed"};
  return names;
}

json measure_method(const TransportScene& scene, const MethodChoice& method, double step,
                    std::uint64_t seed) {
  Curves curves;
  unsigned failed = 0;
  json record = {{"runs", scene.replicas}};
  for (unsigned replica = 0; replica < scene.replicas; ++replica) {
    try {
      run_cube(scene, method, step, seed, replica, curves);
      if (has_flow_box(scene)) run_flow(scene, method, step, seed, replica, curves);
    } catch (const StepFailure& failure) {
      if (failed++ == 0) record["cause"] = to_string(failure.cause());
    }
  }
  record["failed"] = failed;
  put_coefficients(scene, curves, record);
  return record;
}

Estimate sound_at(const TransportScene& scene, const MethodChoice& method, double step,
                  double length, std::uint64_t seed) {
  std::vector<std::vector<double>> all;
  double interval = 0;
  // Three periods, by which a long wave has decayed enough to tell how fast it does.
  const double window = 3 * length / scene.sound_guess;
  for (unsigned replica = 0; replica < scene.replicas; ++replica) {
    const auto record = flow(scene, method, step, length, window, seed, replica);
    interval = record.interval;
    all.push_back(record.longitudinal);
  }
  return jackknife(all, [&](const std::vector<double>& mean) {
    return sound_speed({interval, mean}, 2 * std::numbers::pi / length, scene.sound_guess);
  });
}

double predicted_seconds(const TransportScene& scene, double step) {
  const auto range = Fluid(scene.fluid).range();
  const double pairs = 2 * std::numbers::pi / 3 * std::pow(range, 3) * scene.density;
  const double particle_step = 9e-8 + 4e-8 * pairs;
  const double in_cube = std::pow(scene.cube_side, 3) * scene.density;
  const double in_flow = scene.flow_length * scene.flow_width * scene.flow_width * scene.density;
  const double cube_time =
      scene.particle_window * scene.particle_windows + scene.heat_window * scene.heat_impositions;
  const double flow_time = scene.flow_window * scene.flow_impositions;
  return scene.replicas * particle_step * (in_cube * cube_time + in_flow * flow_time) / step;
}

}  // namespace driftless::transport
