#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiments/avalos_mackie_fluid.hpp"
#include "experiments/reproduce/estimates.hpp"
#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/interval_arithmetic.hpp"
#include "experiments/transport/ideal_runs.hpp"
#include "experiments/transport/theory.hpp"
#include "model/differentiable.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;
using std::numbers::pi;

constexpr double box_length = 10;
const double wavenumber = 2 * pi / box_length;

/// A wish: how a transport coefficient is to follow the temperature.
struct Wish {
  const char* name;
  CoefficientLaw law;
  double (*factor)(double temperature);  ///< the same where both particles have this one
};

const std::vector<Wish>& wishes() {
  const auto liquid = [](double, const Differentiable& i, const Differentiable& j) {
    const Differentiable mean = 0.5 * (i + j);
    return Differentiable(exp(2 / mean - 2));
  };
  static const std::vector<Wish> all = {
      {"T*^2", CoefficientLaw::power(2, 1), [](double T) { return T * T; }},
      {"exp(2/T* - 2)", CoefficientLaw::any(liquid, 1, am99::many),
       [](double T) { return std::exp(2 / T - 2); }}};
  return all;
}

enum class Transported { momentum, heat };
constexpr Transported both[] = {Transported::momentum, Transported::heat};

std::string coefficient_of(Transported what) {
  return what == Transported::momentum ? "viscosity" : "thermal conductivity";
}

std::vector<double> temperatures(Effort effort) {
  return effort == Effort::quick ? std::vector<double>{0.7, 1.4}
                                 : std::vector<double>{0.6, 0.75, 1, 1.25, 1.5, 2};
}

unsigned replicas(Transported what, Effort effort) {
  const unsigned most = what == Transported::momentum ? 16 : 6;
  return effort == Effort::quick ? most : 4 * most;
}

/// A fluid with a law, or with the constant coefficient that the law gives at its temperature.
struct Cell {
  Transported what;
  const Wish* wish;
  double temperature;
  bool has_law;

  bool is_momentum() const { return what == Transported::momentum; }
  std::string name() const {
    return fmt::format("{}, {} {}, T* = {:g}", coefficient_of(what),
                       has_law ? "law" : "constant in the place of", wish->name, temperature);
  }
  FluidParameters fluid() const {
    // Where little heat is stored in fluctuations the mean of a law is the law of the mean.
    constexpr double heat_ratio = 0.002;
    auto f = am99::fluid(am99::many, 0);
    f.temperature = temperature;
    f.heat_capacity = f.boltzmann / heat_ratio;
    if (!is_momentum()) {
      f.heat_form = HeatForm::temperature;
      f.conduction = f.heat_capacity;
    }
    if (has_law) {
      (is_momentum() ? f.friction_law : f.conduction_law) = wish->law;
    } else {
      (is_momentum() ? f.friction : f.conduction) *= wish->factor(temperature);
    }
    return f;
  }
  Cell constant() const { return {what, wish, temperature, false}; }
  double mean_field() const {
    const auto f = constant().fluid();
    return is_momentum() ? transport::mean_field_viscosity(f, 1, wavenumber)
                         : transport::mean_field_conductivity(f, 1, wavenumber);
  }
  double decay_time() const {
    const double stored = is_momentum() ? 1.0 : fluid().heat_capacity;
    return stored / (mean_field() * wavenumber * wavenumber);
  }
  /// A wave of velocities has the long side for itself: along several axes they would carry each
  /// other along.
  transport::FluidBox box() const {
    return transport::fluid_box(box_length, is_momentum() ? 6 : box_length, 1);
  }
  double step() const {
    const auto f = constant().fluid();
    const double rate = std::max(transport::collision_rate(f, 1), transport::heat_rate(f, 1));
    return std::min(0.05, 0.1 / rate);
  }
};

std::vector<Cell> cells(Transported what, Effort effort) {
  std::vector<Cell> all;
  for (const auto& wish : wishes()) {
    for (const double temperature : temperatures(effort)) {
      for (const bool has_law : {true, false}) all.push_back({what, &wish, temperature, has_law});
    }
  }
  return all;
}

constexpr double decay_times = 4.5;
constexpr unsigned impositions = 2;

json measure(const Cell& cell, const Conditions& conditions) {
  transport::IdealRun run{cell.fluid(), cell.box()};
  run.method = conditions.method_or(run.method);
  run.seed = conditions.seed;
  run.replicas = replicas(cell.what, conditions.effort);
  transport::WaveSchedule schedule;
  schedule.step = cell.step();
  schedule.samples = 60;
  schedule.stride =
      transport::stride_of(decay_times * cell.decay_time(), schedule.samples, schedule.step);
  schedule.impositions = impositions;
  // A transverse wave need not be small: friction and streaming are linear in its velocities, and
  // the heat that it leaves is less than a hundredth of what there is.
  const transport::Waves waves = cell.is_momentum() ? transport::Waves{{0}, 1, 1.5, 0, 0}
                                                    : transport::Waves{{0, 1, 2}, 1, 0, 0, 0.1};
  const auto records = transport::relax_replicas(run, waves, schedule);
  return to_json(cell.is_momentum() ? transport::viscosity(records, wavenumber, run.fluid, 1)
                                    : transport::conductivity(records, wavenumber, run.fluid, 1));
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  constexpr double seconds_per_particle_step = 2e-6;
  for (const auto what : both) {
    for (const auto& cell : cells(what, conditions.effort)) {
      const double steps = decay_times * cell.decay_time() / cell.step();
      const double runs = replicas(cell.what, conditions.effort) * impositions;
      const double cost =
          runs * steps * static_cast<double>(cell.box().particles) * seconds_per_particle_step;
      all.push_back(
          {cell.name(), cost, false, [=](const Workplace&) { return measure(cell, conditions); }});
    }
  }
  return all;
}

void add_row(const Cell& cell, const Records& records, Outcome& outcome) {
  const auto found = read_estimate(records.at(cell.name()));
  const auto constant = read_estimate(records.at(cell.constant().name()));
  if (!found || !constant) return;
  Row row;
  row.quantity = fmt::format("{} over that of a constant coefficient of the law's value",
                             coefficient_of(cell.what));
  row.setting = fmt::format("law {} = {:.3f} at T* = {:g}", cell.wish->name,
                            cell.wish->factor(cell.temperature), cell.temperature);
  row.unit = "1";
  row.ours = ratio(interval_of(*found), interval_of(*constant));
  put_theory(row, 1, "the law is followed", 0.1);
  row.explanation = fmt::format("the {} itself is {:.3g}, in the mean field {:.3g}",
                                coefficient_of(cell.what), found->mean, cell.mean_field());
  outcome.rows.push_back(row);
}

Picture picture(Transported what, const Conditions& conditions, const Records& records) {
  const auto name = coefficient_of(what);
  judge::Chart chart{
      fmt::format("The {} with two wanted laws", name), {"temperature T*"}, {name, true}, {}};
  const auto all = temperatures(conditions.effort);
  for (const auto& wish : wishes()) {
    for (const bool has_law : {true, false}) {
      judge::Series series{fmt::format("{}{}", has_law ? "law " : "constants as ", wish.name),
                           {},
                           judge::Marks::points};
      for (const double temperature : all) {
        const Cell cell{what, &wish, temperature, has_law};
        const auto found = read_estimate(records.at(cell.name()));
        if (found) series.points.push_back(point(temperature, *found));
      }
      chart.series.push_back(series);
    }
    chart.series.push_back(line(fmt::format("{}, mean field", wish.name), all.front(), all.back(),
                                [&](double temperature) {
                                  return Cell{what, &wish, temperature, true}.mean_field();
                                }));
  }
  return {chart.title, "Lines: the mean field with what particles carry.", chart, {}};
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  for (const auto what : both) {
    for (const auto& cell : cells(what, conditions.effort)) {
      if (cell.has_law) add_row(cell, records, outcome);
    }
    outcome.pictures.push_back(picture(what, conditions, records));
  }
  outcome.remarks = {
      fmt::format("Closure `friction` and heat form `temperature`, in which the law multiplies "
                  "zeta_0 or lambda_0; B = 0.002, 100 neighbours, {} at a step of at most 0.05 and "
                  "a tenth of the fastest relaxation.",
                  to_string(conditions.method_or(transport::IdealRun().method))),
      "exp(2/T* - 2) is written as any function of both temperatures and differentiated "
      "automatically; the noise-induced drift follows from the derivatives."};
  return outcome;
}

std::optional<std::string> unsuited(const MethodChoice& method) {
  std::vector<FluidParameters> fluids;
  for (const auto what : both) {
    for (const auto& cell : cells(what, Effort::quick)) fluids.push_back(cell.fluid());
  }
  return first_refusal(method, fluids);
}

}  // namespace

const Experiment coefficient_laws = {
    .name = "coefficient-laws",
    .source = "MAN 3.23-3.28",
    .title = "Transport coefficients that follow a wanted law of the temperature",
    .question =
        "Does a fluid whose friction or conduction is multiplied by a law of the two temperatures "
        "have a viscosity or conductivity that follows this law? Waves of velocity and of "
        "temperature are left to decay in ideal fluids at several temperatures, "
        "with a law and with the constant coefficient that the law gives there; the laws are the "
        "square of the temperature and the exponential of an activated liquid.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
