#include "experiments/judge/drift_runs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/energy_drift.hpp"
#include "experiments/judge/drift_prediction.hpp"
#include "experiments/judge/isolated_runs.hpp"
#include "experiments/replica.hpp"
#include "experiments/scene_keys.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr unsigned replicas = 8, most_that_break = 2;

std::vector<double> steps(Depth depth) {
  // Whole fractions of the time between samples.
  if (depth == Depth::quick) return {0.4 / 13, 0.04, 0.05, 0.4 / 6};
  return {0.02, 0.025, 0.4 / 13, 0.04, 0.05, 0.4 / 6};
}

std::vector<double> frictions(Depth depth) {
  if (depth == Depth::quick) return {0.5, 1.5, 13.5};
  return {0.17, 0.5, 1.5, 13.5, 40.5};
}

Study study_of(Depth depth, const DriftSetting& setting) {
  Study study;
  study.equilibrate = 2;
  study.measure = setting.brief ? 8 : depth == Depth::quick ? 40 : 200;
  study.sample_every = 0.4;
  study.replicas = replicas;
  return study;
}

Scene scene_of(const DriftSetting& setting) {
  Scene scene = find_preset("soft-fluid")->scene;
  scene.fluid.heat_capacity = setting.heat_capacity;
  scene.fluid.friction = setting.friction;
  scene.fluid.conduction = 0;
  scene.fluid.heat_form = HeatForm::none;
  return scene;
}

}  // namespace

std::string DriftSetting::name() const {
  return fmt::format("phi/k {:g}, friction {:g}, step {:.4g}", heat_capacity, friction, time_step);
}

std::vector<DriftSetting> drift_settings(Depth depth) {
  std::vector<DriftSetting> all;
  for (const double capacity : {usual_capacity, small_capacity}) {
    for (const double step : steps(depth)) all.push_back({capacity, usual_friction, step});
  }
  for (const double friction : frictions(depth)) {
    all.push_back({usual_capacity, friction, usual_step});
  }
  for (const double step : steps(depth)) all.push_back({usual_capacity, 0, step});
  for (const double step : {0.0025, 0.005, 0.01}) {
    all.push_back({usual_capacity, usual_friction, step, true});
  }
  return all;
}

std::optional<std::string> drift_refusal(const Method& method) {
  return refusal(method, Fluid(scene_of({usual_capacity, usual_friction, 0}).fluid));
}

double drift_cost(const DriftSetting& setting, Depth depth) {
  const auto study = study_of(depth, setting);
  return 4e-4 * (study.equilibrate + study.measure) * study.replicas / setting.time_step;
}

unsigned drift_replicas() { return replicas; }

json run_drift(const Candidate& candidate, const Conditions& conditions,
               const DriftSetting& setting) {
  const Study study = study_of(conditions.depth, setting);
  const auto& scene = prepared_once(scene_of(setting), conditions.seed, study.replicas);
  std::vector<EnergyTrace> traces;
  json record = {{"failures", json::array()}};
  for (unsigned replica = 0; replica < study.replicas; ++replica) {
    auto result = run_replica(scene, study, candidate.choice, setting.time_step, replica);
    if (result.failure) {
      record["failures"].push_back(to_string(result.failure->cause));
    } else {
      traces.push_back(std::move(result.record.energy));
    }
  }
  if (record["failures"].size() > most_that_break) return record;
  const auto drift = energy_drift(traces);
  const auto particles = static_cast<double>(scene.scene().particles);
  record["drift"] = drift.slope.mean;
  record["error"] = drift.slope.error;
  // Of the energy per particle: times N for that of a particle's share.
  record["walk"] = {particles * drift.walk.value, particles * drift.walk.lower,
                    particles * drift.walk.upper};
  System system = scene.start(0);
  const auto theory = predicted_drift(system);
  record["kick_move_kick"] = theory.kick_move_kick * std::pow(setting.time_step, 4);
  record["move_kick_move"] = theory.move_kick_move * std::pow(setting.time_step, 4);
  return record;
}

std::vector<MeasuredDrift> measured_drifts(Depth depth, const Records& records) {
  std::vector<MeasuredDrift> all;
  for (const auto& setting : drift_settings(depth)) {
    const auto found = records.find(setting.name());
    if (found == records.end() || !found->second.contains("drift")) continue;
    const auto& record = found->second;
    all.push_back({setting, record["drift"], record["error"], record["walk"][0], record["walk"][1],
                   record["walk"][2], record["kick_move_kick"], record["move_kick_move"]});
  }
  return all;
}

}  // namespace driftless::judge
