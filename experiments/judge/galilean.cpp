#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/frame_findings.hpp"
#include "experiments/judge/short_paths.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double phi_over_k = 60, particles = 150;
/// Seconds of a particle's step, roughly.
constexpr double particle_step = 5e-7;
const std::vector<double> speeds = {1, 5, 10};  ///< thermal velocities

struct Plan {
  std::vector<double> short_steps;
  unsigned short_runs;
  std::vector<double> long_steps;
  unsigned long_runs;
  double duration;
};

Plan plan(const Conditions& conditions) {
  if (conditions.depth == Depth::full) {
    return {{0.04, 0.02, 0.01, 0.005}, 64, {0.04, 0.02, 0.01}, 32, 40};
  }
  return {{0.04, 0.02, 0.01}, 8, {0.02}, 16, 10};
}

std::string change_name(double time_step) {
  return fmt::format("same noise, step {:g}", time_step);
}

std::string average_name(double speed, double time_step) {
  return fmt::format("averages at {}, step {:g}", speed_words(speed), time_step);
}

json run_short_checks(const Candidate& candidate, const Conditions& conditions) {
  const Trial trial{candidate.method(), candidate.choice.options, conditions.seed};
  json records = json::object();
  for (const double speed : speeds) {
    const auto check = boost_check(speed);
    records[check.name] = short_record(check, trial);
  }
  return records;
}

/// Long runs are of the ideal fluid, whose energy keeps within bounds for more methods and steps.
Scene scene_of(const Candidate& candidate, bool with_potential) {
  return small_fluid_scene(phi_over_k, candidate.method().closures.front(), with_potential);
}

void add_changes(const Candidate& candidate, const Conditions& conditions, const Plan& how,
                 std::vector<Part>& all) {
  const auto scene = scene_of(candidate, true);
  if (refusal(candidate.method(), Fluid(scene.fluid))) return;
  for (const double step : how.short_steps) {
    const double cost = 4 * particle_step * particles * how.short_runs * changes_after / step;
    all.push_back({change_name(step), cost, [=] {
                     const auto& prepared = prepared_once(scene, conditions.seed, how.short_runs);
                     return frame_change(candidate, prepared, how.short_runs, speeds, step,
                                         changes_after);
                   }});
  }
}

void add_averages(const Candidate& candidate, const Conditions& conditions, const Plan& how,
                  std::vector<Part>& all) {
  const auto scene = scene_of(candidate, false);
  if (refusal(candidate.method(), Fluid(scene.fluid))) return;
  for (const double step : how.long_steps) {
    for (const double speed : {0.0, speeds[0], speeds[1], speeds[2]}) {
      const double cost = particle_step * particles * how.long_runs * how.duration / step;
      all.push_back({average_name(speed, step), cost, [=] {
                       const auto& prepared = prepared_once(scene, conditions.seed, how.long_runs);
                       return frame_averages(candidate, prepared, how.long_runs, speed, step,
                                             how.duration);
                     }});
    }
  }
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> all = {
      {"short paths", 0.2, [=] { return run_short_checks(candidate, conditions); }}};
  const auto how = plan(conditions);
  add_changes(candidate, conditions, how, all);
  add_averages(candidate, conditions, how, all);
  return all;
}

/// The observables at one step against speed, as multiples of their values at rest.
std::vector<Series> average_series(const Records& records, double step) {
  std::vector<Series> all;
  const auto& rest = records.at(average_name(0, step));
  for (const auto& average : frame_averages_asked()) {
    Series line{fmt::format("{}, step {:g}", average.words, step), {}};
    for (const double speed : speeds) {
      const auto& moving = records.at(average_name(speed, step));
      const auto ratio = frame_ratio(average, rest, moving);
      if (!ratio) continue;
      const double width =
          interval_quantile * student_factor(ratio->degrees_of_freedom) * ratio->error;
      const double value = 1 + ratio->difference;
      line.points.push_back({speed, value, value - width, value + width});
    }
    all.push_back(std::move(line));
  }
  return all;
}

Chart spread_chart(const std::vector<json>& changes) {
  Chart chart{
      fmt::format("Wrong internal energies after {:g} time units, same noise", changes_after),
      {"frame's velocity / thermal velocity", true},
      {"root mean square difference from rest / mean internal energy", true},
      {}};
  for (const auto& change : changes) {
    Series line{fmt::format("step {:g}", change["time_step"].get<double>()), {}};
    for (const auto& record : change["speeds"]) {
      if (record.contains("spread")) line.points.push_back({record["speed"], record["spread"]});
    }
    chart.series.push_back(std::move(line));
  }
  return chart;
}

void conclude_changes(const Method& method, const Plan& how, const Records& records,
                      Conclusion& conclusion) {
  if (!records.count(change_name(how.short_steps.front()))) return;
  std::vector<json> changes;
  for (const double step : how.short_steps) changes.push_back(records.at(change_name(step)));
  for (const double speed : speeds) {
    conclusion.findings.push_back(frame_change_finding(method, changes, speed));
  }
  conclusion.charts.push_back(spread_chart(changes));
}

void conclude_averages(const Method& method, const Plan& how, const Records& records,
                       Conclusion& conclusion) {
  Chart chart{"Long averages in a moving frame",
              {"frame's velocity / thermal velocity"},
              {"average / average at rest"},
              {}};
  for (const double step : how.long_steps) {
    if (!records.count(average_name(0, step))) return;
    const auto& rest = records.at(average_name(0, step));
    for (const double speed : speeds) {
      const auto& moving = records.at(average_name(speed, step));
      for (const auto& average : frame_averages_asked()) {
        conclusion.findings.push_back(frame_average_finding(method, average, rest, moving));
      }
    }
    for (auto& line : average_series(records, step)) chart.series.push_back(std::move(line));
  }
  conclusion.charts.push_back(std::move(chart));
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  const Method& method = candidate.method();
  Conclusion conclusion;
  for (const double speed : speeds) {
    const auto check = boost_check(speed);
    conclusion.findings.push_back(
        short_finding(check, method, records.at("short paths").at(check.name)));
  }
  const auto how = plan(conditions);
  conclude_changes(method, how, records, conclusion);
  conclude_averages(method, how, records, conclusion);
  return conclusion;
}

}  // namespace

const Examination galilean = {
    "galilean", "Galilean invariance",
    "Does a uniform velocity change anything? The same system and the same noise, seen from frames "
    "at 1, 5 and 10 thermal velocities in a general direction, must give the same internal "
    "energies "
    "and relative motion: to rounding over 20 steps of 27 particles, and over 0.32 time units of a "
    "soft fluid of 150, where the size of a violation, its rate and its order in the step are "
    "measured. In long runs of the ideal fluid the means of the kinetic and the internal "
    "temperature and of the variance of the internal energies must be those at rest with the same "
    "noise.",
    parts, conclude};

}  // namespace driftless::judge
