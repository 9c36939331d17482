#include "experiments/judge/isolated_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "experiments/scene_keys.hpp"

namespace driftless::judge {

Scene small_fluid_scene(double phi_over_k, FrictionClosure closure, bool with_potential) {
  Scene scene = find_preset("soft-fluid")->scene;
  scene.particles = 150;
  scene.fluid.heat_capacity = phi_over_k * scene.fluid.boltzmann;
  scene.fluid.conduction = scene.fluid.heat_capacity;
  scene.fluid.friction_closure = closure;
  if (!with_potential) scene.fluid.repulsion = 0;
  return scene;
}

const PreparedScene& prepared_once(const Scene& scene, std::uint64_t seed, unsigned replicas) {
  struct Slot {
    std::once_flag made;
    std::unique_ptr<PreparedScene> scene;
  };
  static std::mutex mutex;
  static std::map<std::tuple<std::string, std::uint64_t, unsigned>, Slot> kept;
  Slot* slot = nullptr;
  {
    const std::lock_guard lock(mutex);
    slot = &kept[{to_json(scene).dump(), seed, replicas}];
  }
  // One more, as the last of several starts off equilibrium.
  std::call_once(slot->made,
                 [&] { slot->scene = std::make_unique<PreparedScene>(scene, seed, replicas + 1); });
  return *slot->scene;
}

std::optional<Failure> run_isolated(const Candidate& candidate, const PreparedScene& scene,
                                    unsigned replica, const Vector& frame_velocity,
                                    double time_step, std::uint64_t steps, std::uint64_t stride,
                                    const std::function<void(System&, double time)>& sample) {
  System system = scene.start(replica);
  State state = system.state();
  boost_frame(frame_velocity, state);
  system.set_state(std::move(state));
  const auto integrator = candidate.make();
  const double energy = system.total_energy();
  std::uint64_t step = 0;
  try {
    sample(system, 0);
    while (step < steps) {
      system.set_step(++step);
      integrator->step(system, time_step);
      if (step % stride != 0) continue;
      if (!(std::abs(system.total_energy() - energy) <= std::abs(energy))) {
        throw StepFailure(FailureCause::energy_runaway, {});
      }
      sample(system, static_cast<double>(step) * time_step);
    }
  } catch (const StepFailure& failure) {
    return Failure{replica, failure.cause(), step, static_cast<double>(step) * time_step};
  }
  return {};
}

nlohmann::json failures_record(unsigned runs, const std::vector<Failure>& failures) {
  nlohmann::json record = {{"runs", runs}, {"failed", failures.size()}};
  const auto first =
      std::min_element(failures.begin(), failures.end(),
                       [](const Failure& a, const Failure& b) { return a.time < b.time; });
  if (first == failures.end()) return record;
  record["cause"] = to_string(first->cause);
  record["time"] = first->time;
  record["negative"] = std::count_if(failures.begin(), failures.end(), [](const Failure& one) {
    return one.cause == FailureCause::negative_internal_energy;
  });
  return record;
}

}  // namespace driftless::judge
