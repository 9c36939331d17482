#include <fmt/format.h>

#include <cmath>

#include "experiments/judge/limit_fit.hpp"
#include "experiments/reproduce/estimates.hpp"
#include "experiments/reproduce/experiments.hpp"
#include "experiments/transport/method_cells.hpp"
#include "experiments/transport/theory.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;
using transport::TransportScene;

std::vector<TransportScene> scenes(const Conditions& conditions) {
  const unsigned effort = conditions.effort == Effort::quick ? 1 : 8;
  return {transport::ideal_transport_scene(effort), transport::soft_transport_scene(effort)};
}

/// The methods that run a scene.
std::vector<const Method*> methods_of(const TransportScene& scene) {
  std::vector<const Method*> all;
  for (const Method* method : methods()) {
    if (!refusal(*method, Fluid(scene.fluid))) all.push_back(method);
  }
  return all;
}

std::string cell_name(const TransportScene& scene, const Method& method, double step) {
  return fmt::format("{}, {}, step {:g}", scene.name, method.name, step);
}

/// Sound of the ideal fluid at longer waves, by one method.
constexpr const char* sound_method = "metropolized-splitting";
constexpr double sound_step = 0.08;
const std::vector<double> sound_lengths = {60, 120};
std::string sound_name(double length) { return fmt::format("sound, wavelength {:g}", length); }

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& scene : scenes(conditions)) {
    for (const Method* method : methods_of(scene)) {
      for (const double step : scene.time_steps) {
        const MethodChoice choice{std::string(method->name), {}};
        all.push_back({cell_name(scene, *method, step), transport::predicted_seconds(scene, step),
                       false, [=](const Workplace&) {
                         return transport::measure_method(scene, choice, step, conditions.seed);
                       }});
      }
    }
  }
  const auto ideal = scenes(conditions).front();
  for (const double length : sound_lengths) {
    all.push_back({sound_name(length), length / 4, false, [=](const Workplace&) {
                     return to_json(transport::sound_at(ideal, {sound_method, {}}, sound_step,
                                                        length, conditions.seed));
                   }});
  }
  return all;
}

std::optional<Estimate> found(const Records& records, const std::string& cell,
                              const std::string& coefficient) {
  const auto record = records.find(cell);
  if (record == records.end() || !record->second.contains(coefficient)) return {};
  return read_estimate(record->second[coefficient]);
}

/// What a method's coefficient tends to as the step vanishes.
std::optional<judge::Limit> limit_of(const TransportScene& scene, const Method& method,
                                     const std::string& coefficient, const Records& records) {
  std::vector<judge::LimitPoint> points;
  for (const double step : scene.time_steps) {
    const auto one = found(records, cell_name(scene, method, step), coefficient);
    if (!one) continue;
    points.push_back({step, one->mean, one->error / student_factor(one->degrees_of_freedom),
                      one->degrees_of_freedom});
  }
  return judge::limit_at_zero(points);
}

/// The limit of small steps pooled over the consistent methods: their mean, each weighing alike but
/// for its error, which is taken no smaller than half of the median one, as errors of few replicas
/// are themselves uncertain. Methods more than five errors off the median are left out. The error
/// is the larger of what the errors and what the scatter say.
struct Pool {
  std::optional<Estimate> value;
  std::size_t methods = 0;
  std::string left_out;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Pool pool(const TransportScene& scene, const std::string& coefficient, const Records& records) {
  struct Entry {
    std::string_view name;
    double value, error;
  };
  std::vector<Entry> entries;
  std::vector<double> values, errors;
  for (const Method* method : methods_of(scene)) {
    if (!is_consistent(*method, {}, Fluid(scene.fluid))) continue;
    const auto limit = limit_of(scene, *method, coefficient, records);
    if (!limit || !(limit->error > 0)) continue;
    entries.push_back({method->name, limit->value, std::hypot(limit->error, limit->model_error)});
    values.push_back(entries.back().value), errors.push_back(entries.back().error);
  }
  Pool result;
  if (entries.empty()) return result;
  const double centre = median(values), least = 0.5 * median(errors);
  double weight = 0, sum = 0, scatter = 0;
  for (auto& entry : entries) {
    entry.error = std::max(entry.error, least);
    if (std::abs(entry.value - centre) > 5 * entry.error) {
      result.left_out += (result.left_out.empty() ? "" : ", ") + std::string(entry.name);
      entry.error = 0;
      continue;
    }
    const double share = 1 / (entry.error * entry.error);
    weight += share, sum += share * entry.value, ++result.methods;
  }
  Estimate value;
  value.mean = sum / weight;
  for (const auto& entry : entries) {
    if (entry.error > 0) scatter += std::pow((entry.value - value.mean) / entry.error, 2);
  }
  const double freedom = std::max(1.0, static_cast<double>(result.methods) - 1);
  value.error = std::sqrt(std::max(1.0, scatter / freedom) / weight);
  result.value = value;
  return result;
}

std::string unit_of(const std::string& coefficient) {
  if (coefficient == "sound speed") return "length/time";
  return coefficient == "diffusion" ? "length^2/time" : "program units";
}

Row row_of(const TransportScene& scene, const Method& method, double step,
           const std::string& coefficient, const Records& records, const Pool& reference) {
  Row row;
  row.quantity = coefficient;
  const std::string cell = cell_name(scene, method, step);
  row.setting = cell;
  row.unit = unit_of(coefficient);
  const auto ours = found(records, cell, coefficient);
  const auto& record = records.at(cell);
  if (!ours) {
    row.verdict = Verdict::not_resolved;
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    row.ours = {nothing, nothing, nothing};
    row.explanation = fmt::format("{} of {} runs failed: {}", record.value("failed", 0),
                                  record.value("runs", 0), record.value("cause", "no decay seen"));
    return row;
  }
  row.ours = interval_of(*ours);
  if (!reference.value) return row;
  put_theory(row, interval_of(*reference.value),
             fmt::format("limit of small steps, {} methods pooled", reference.methods), 0.2);
  const double off = ours->mean / reference.value->mean - 1;
  const double error = interval_quantile * std::hypot(ours->error, reference.value->error) /
                       std::abs(reference.value->mean);
  row.explanation = fmt::format("{:+.1f} % (+- {:.1f}) of the limit", 100 * off, 100 * error);
  if (const auto kinetic = found(records, cell, "kinetic temperature")) {
    row.explanation +=
        fmt::format("; kinetic temperature {:+.1f} % (+- {:.1f})",
                    100 * (kinetic->mean / scene.fluid.temperature - 1),
                    100 * interval_quantile * kinetic->error / scene.fluid.temperature);
  }
  if (!is_consistent(method, {}, Fluid(scene.fluid))) {
    row.explanation += "; by its own claim its limit is another model";
  }
  return row;
}

/// Theory beside the pooled limits.
std::optional<double> theory_of(const TransportScene& scene, const std::string& coefficient) {
  const auto& f = scene.fluid;
  if (f.has_repulsion()) return {};
  if (coefficient == "diffusion") return transport::diffusion(f, scene.density);
  if (coefficient == "sound speed") return transport::sound_speed(f);
  if (coefficient == "viscosity") {
    return transport::mean_field_viscosity(f, scene.density, scene.flow_wavenumber());
  }
  return transport::mean_field_conductivity(f, scene.density, scene.cube_wavenumber());
}

void pooled_row(const TransportScene& scene, const std::string& coefficient, const Pool& reference,
                Outcome& outcome) {
  if (!reference.value) return;
  Row row;
  row.quantity = coefficient;
  row.setting = scene.name + ", limit of small steps";
  row.unit = unit_of(coefficient);
  row.ours = interval_of(*reference.value);
  row.explanation = fmt::format("{} consistent methods pooled", reference.methods);
  if (!reference.left_out.empty())
    row.explanation += "; left out as outliers: " + reference.left_out;
  if (const auto theory = theory_of(scene, coefficient)) {
    put_theory(row, *theory,
               coefficient == "sound speed" ? "MAN 3.30, of long waves"
                                            : "mean field, exact for many neighbours",
               0.2);
  }
  outcome.rows.push_back(row);
}

void sound_rows(const TransportScene& ideal, const Records& records, Outcome& outcome) {
  for (const double length : sound_lengths) {
    const auto record = records.find(sound_name(length));
    if (record == records.end()) continue;
    const auto ours = read_estimate(record->second);
    if (!ours) continue;
    Row row;
    row.quantity = "sound speed";
    row.setting = fmt::format("{}, {}, step {:g}, wavelength {:g}", ideal.name, sound_method,
                              sound_step, length);
    row.unit = "length/time";
    row.ours = interval_of(*ours);
    put_theory(row, transport::sound_speed(ideal.fluid), "MAN 3.30", 0.1);
    row.explanation =
        "waves much longer than the 3 units of length that a particle flies are sound";
    outcome.rows.push_back(row);
  }
}

judge::Chart chart(const TransportScene& scene, const std::string& coefficient,
                   const Records& records, const Pool& reference) {
  judge::Chart chart{fmt::format("{} in the {}", coefficient, scene.name),
                     {"time step", true},
                     {coefficient + " over the limit of small steps", false},
                     {}};
  if (!reference.value) return chart;
  for (const Method* method : methods_of(scene)) {
    judge::Series series{std::string(method->name), {}, judge::Marks::points};
    for (const double step : scene.time_steps) {
      const auto ours = found(records, cell_name(scene, *method, step), coefficient);
      if (ours) series.points.push_back(point(step, scaled(*ours, 1 / reference.value->mean)));
    }
    if (!series.points.empty()) chart.series.push_back(series);
  }
  return chart;
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  const auto all = scenes(conditions);
  for (const auto& scene : all) {
    for (const auto& coefficient : transport::coefficient_names()) {
      const Pool reference = pool(scene, coefficient, records);
      pooled_row(scene, coefficient, reference, outcome);
      for (const Method* method : methods_of(scene)) {
        for (const double step : scene.time_steps) {
          if (!records.contains(cell_name(scene, *method, step))) continue;
          outcome.rows.push_back(row_of(scene, *method, step, coefficient, records, reference));
        }
      }
      outcome.pictures.push_back({fmt::format("{}, {}", scene.name, coefficient),
                                  "Relative to the limit of small steps of the consistent methods.",
                                  chart(scene, coefficient, records, reference),
                                  {}});
    }
  }
  sound_rows(all.front(), records, outcome);
  outcome.remarks = {
      "The reference of every row is not a paper's value but the limit of small steps, "
      "extrapolated "
      "for each consistent method and pooled.",
      fmt::format(
          "Wavelengths: ideal fluid {:g} (heat) and {:g} (viscosity, sound), soft fluid {:g}.",
          all[0].cube_side, all[0].flow_length, all[1].cube_side)};
  return outcome;
}

}  // namespace

const Experiment methods_transport = {
    .name = "methods-transport",
    .source = "all methods; sound: MAN 3.30",
    .title = "Transport coefficients that each method gives at each step",
    .question =
        "Does a method that keeps the temperature keep the motion too? In the ideal fluid of the "
        "preset mackie-1999 and in the preset soft-fluid, under every method that runs them, at "
        "three steps: self-diffusion from squared displacements at equilibrium, viscosity, "
        "conductivity and sound speed from the decay of imposed waves. Every value stands beside "
        "the limit of small steps, pooled over the consistent methods.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = [](const MethodChoice&) {
      return std::optional<std::string>(
          "it measures every method already; allowed is to run it without --method");
    }};

}  // namespace driftless::reproduce
