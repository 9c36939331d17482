#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/energy_ladder.hpp"
#include "experiments/judge/examinations.hpp"
#include "experiments/judge/short_paths.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

/// What is asked of a scene's runs.
enum class Asked { energy, positivity };

/// A scene with runs at several steps, from the coarsest to the finest.
struct Ladder {
  Asked asked;
  std::string name;
  double phi_over_k;
  bool with_potential;
  std::vector<double> time_steps;
  unsigned runs;
  double duration;

  std::string rung(double time_step) const {
    return fmt::format("{}, {}, step {:g}", asked == Asked::energy ? "energy" : "positivity", name,
                       time_step);
  }
};

/// Total energy is watched in short runs, as drift heats a system that then drifts otherwise.
std::vector<Ladder> ladders(const Conditions& conditions) {
  const bool full = conditions.depth == Depth::full;
  std::vector<double> fine = {0.04, 0.02, 0.01, 0.005, 0.0025};
  if (full) fine.push_back(0.00125);
  const std::vector<double> coarse = {0.04, 0.02, 0.01};
  const unsigned many = full ? 256 : 16, many_long = full ? 64 : 16;
  const double brief = 2.88, long_time = full ? 32 : 4;
  return {{Asked::energy, "ideal fluid, phi/k = 100", 100, false, fine, many, brief},
          {Asked::energy, "soft fluid, phi/k = 60", 60, true, fine, many, brief},
          {Asked::positivity, "ideal fluid, phi/k = 100", 100, false, coarse, many_long, long_time},
          {Asked::positivity, "ideal fluid, phi/k = 5", 5, false, coarse, many_long, long_time}};
}

/// Seconds of a particle's step, roughly.
constexpr double particle_step = 5e-7, particles = 150;

json run_short_checks(const Candidate& candidate, const Conditions& conditions) {
  const Trial trial{candidate.method(), candidate.choice.options, conditions.seed};
  json records = json::object();
  for (const auto& check : short_checks()) records[check.name] = short_record(check, trial);
  return records;
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> all = {
      {"short paths", 1, [=] { return run_short_checks(candidate, conditions); }}};
  const auto closure = candidate.method().closures.front();
  for (const auto& one : ladders(conditions)) {
    const auto scene = small_fluid_scene(one.phi_over_k, closure, one.with_potential);
    if (refusal(candidate.method(), Fluid(scene.fluid))) continue;
    for (const double step : one.time_steps) {
      const double cost = particle_step * particles * one.runs * one.duration / step;
      all.push_back({one.rung(step), cost, [=] {
                       const auto& prepared = prepared_once(scene, conditions.seed, one.runs);
                       return energy_rung(candidate, prepared, one.runs, step, one.duration);
                     }});
    }
  }
  return all;
}

/// The rungs of a ladder, none if the method refuses the fluid.
std::vector<json> rungs_of(const Ladder& ladder, const Records& records) {
  std::vector<json> rungs;
  for (const double step : ladder.time_steps) {
    const auto found = records.find(ladder.rung(step));
    if (found != records.end()) rungs.push_back(found->second);
  }
  return rungs;
}

/// One point for each rung that has the quantity, its size alone.
Series series(const Ladder& ladder, const std::vector<json>& rungs, const char* key) {
  Series line{ladder.name, {}};
  for (const auto& rung : rungs) {
    if (!rung.contains(key)) continue;
    const double value = rung[key]["value"], error = rung[key]["error"];
    const double size = std::abs(value), width = interval_quantile * error;
    line.points.push_back({rung["time_step"], size, std::max(0.0, size - width), size + width});
  }
  return line;
}

void add_rows(Table& table, const Ladder& ladder, const std::vector<json>& rungs) {
  const auto cell = [](const json& rung, const char* key) {
    return rung.contains(key) ? rung[key]["value"].get<double>() : std::nan("");
  };
  for (const auto& rung : rungs) {
    table.rows.push_back({ladder.name, rung["duration"].get<double>(),
                          rung["time_step"].get<double>(), cell(rung, "drift"), cell(rung, "walk"),
                          rung["largest_change"].get<double>(), rung["runs"].get<double>(),
                          rung["failed"].get<double>()});
  }
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  Conclusion conclusion;
  for (const auto& check : short_checks()) {
    conclusion.findings.push_back(
        short_finding(check, candidate.method(), records.at("short paths").at(check.name)));
  }
  Chart drift{"Mean drift of total energy",
              {"time step", true},
              {"|drift| / kT per particle and unit time", true},
              {}};
  Chart walk{"Random walk of total energy",
             {"time step", true},
             {"variance / (kT)^2 per particle and unit time", true},
             {}};
  Table table{"Total energy and failures",
              {"fluid", "time units", "time step", "drift / kT per particle and time",
               "walk / (kT)^2 per particle and time", "largest relative change", "runs", "failed"},
              {}};
  for (const auto& ladder : ladders(conditions)) {
    const auto rungs = rungs_of(ladder, records);
    if (rungs.empty()) continue;
    add_rows(table, ladder, rungs);
    if (ladder.asked == Asked::positivity) {
      conclusion.findings.push_back(positivity_finding(ladder.name, rungs));
      continue;
    }
    for (auto& finding : energy_findings(ladder.name, rungs)) {
      conclusion.findings.push_back(std::move(finding));
    }
    drift.series.push_back(series(ladder, rungs, "drift"));
    walk.series.push_back(series(ladder, rungs, "walk"));
  }
  for (const auto& chart : {drift, walk}) {
    const bool drawn = std::any_of(chart.series.begin(), chart.series.end(),
                                   [](const Series& one) { return !one.points.empty(); });
    if (drawn) conclusion.charts.push_back(chart);
  }
  conclusion.tables = {table};
  return conclusion;
}

}  // namespace

const Examination invariants = {
    "invariants", "Invariants and symmetries",
    "What has to stay as it is? Paths of 20 steps of 27 particles, with every closure that the "
    "method claims, every heat form, without and with a potential, are compared to rounding: "
    "momentum, total energy, the same seed twice, a restart, threads, the order of storage and of "
    "pairs, turns, translation, a step of 0. Where total energy is not kept to rounding, the "
    "orders "
    "in the step of its mean drift and of its random walk are measured in an isolated ideal and a "
    "soft fluid of 150 particles. Runs in which an internal energy ran out are counted. What is "
    "not claimed is reported; momentum, repetition and symmetries are demanded of every method.",
    parts, conclude};

}  // namespace driftless::judge
