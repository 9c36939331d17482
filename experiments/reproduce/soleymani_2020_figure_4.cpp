#include <fmt/format.h>

#include <cmath>

#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/soleymani_2020.hpp"

namespace driftless::reproduce {
namespace {

using namespace so20;
using nlohmann::json;

/// One measurement of the conductivity.
struct Point {
  Combination combination;
  MethodChoice method;
  double temperature = 1, density = 3, heat_flux = 6;

  std::string name() const {
    return fmt::format("{}, {}, T = {:g}, density {:g}, flux {:g}", combination.name(),
                       to_string(method), temperature, density, heat_flux);
  }
};

struct Scan {
  const char* title;
  const char* axis;
  double Point::*variable;
  std::vector<double> values;  ///< beside that of the common point
};
const std::vector<Scan>& scans() {
  static const std::vector<Scan> all = {
      {"against temperature", "mean temperature", &Point::temperature, {0.75, 1.35}},
      {"against density", "number density", &Point::density, {2, 4}},
      {"against heat flux", "heat flux", &Point::heat_flux, {3, 12}}};
  return all;
}

/// The common point and those of a scan, in rising order.
std::vector<Point> points_of(const Combination& combination, const Conditions& conditions,
                             const Scan& scan) {
  Point common{combination, methods_for(combination, conditions).front()};
  Point low = common, high = common;
  low.*scan.variable = scan.values[0];
  high.*scan.variable = scan.values[1];
  return {low, common, high};
}

std::vector<Point> all_points(const Conditions& conditions) {
  std::vector<Point> points;
  for (const auto& combination : all_combinations()) {
    for (const auto& method : methods_for(combination, conditions)) {
      points.push_back({combination, method});
    }
    for (const auto& scan : scans()) {
      const auto scanned = points_of(combination, conditions, scan);
      points.push_back(scanned.front());
      points.push_back(scanned.back());
    }
  }
  return points;
}

flux::PeriodicFluid fluid_at(const Point& point, const Conditions& conditions) {
  auto fluid = box_of(point.combination, point.method, conditions);
  fluid.temperature = point.temperature;
  fluid.density = point.density;
  return fluid;
}

json measure(const Point& point, const Conditions& conditions) {
  const auto fluid = fluid_at(point, conditions);
  const auto slabs = flux::run_between_slabs(slabs_of(fluid, point.heat_flux, conditions.effort));
  const auto still = flux::run_in_equilibrium(fluid, equilibrium_duration(conditions.effort));
  return {{"line", slabs["lines"]["whole"]},
          {"conduction", still["conduction"]},
          {"heat_diffusion", still["heat_diffusion"]},
          {"collision_rate", still["collision_rate"]}};
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& point : all_points(conditions)) {
    const auto fluid = fluid_at(point, conditions);
    const auto run = slabs_of(fluid, point.heat_flux, conditions.effort);
    const double duration =
        run.settle + run.duration + equilibrium_duration(conditions.effort) + 10;
    all.push_back(
        {point.name(), cost_of(fluid, duration), false, [point, conditions](const Workplace&) {
           return or_failure([&] { return measure(point, conditions); });
         }});
  }
  return all;
}

/// Without structure, at the temperature and density that the line had.
double analytic(const Point& point, const json& record) {
  const auto fluid = fluid_of(point.combination);
  const double density = record["line"]["density"]["mean"], t = record["line"]["middle"]["mean"];
  return flux::predicted_conductivity(fluid, density, t, flux::without_structure(fluid, density, t))
      .total();
}

/// With the fluid's own pairs and velocity autocorrelation, of an equilibrium run; the kinetic part
/// as in theory.
Interval with_structure(const Point& point, const json& record) {
  const auto fluid = fluid_of(point.combination);
  const Interval conduction = interval_of(record["conduction"]);
  const Interval carried =
      scaled(interval_of(record["heat_diffusion"]), point.density * fluid.heat_capacity);
  flux::PairSums sums;
  sums.collision_rate = record["collision_rate"]["mean"];
  const double kinetic =
      flux::predicted_conductivity(fluid, point.density, point.temperature, sums).kinetic;
  const double value = conduction.value + carried.value + kinetic;
  const double half =
      0.5 * std::hypot(conduction.high - conduction.low, carried.high - carried.low);
  return {value, value - half, value + half};
}

std::string state_of(const Point& point) {
  return fmt::format("T = {:g}, density {:g}, flux {:g}", point.temperature, point.density,
                     point.heat_flux);
}

Row row_of(const Point& point, const json& record) {
  Row row;
  row.quantity = "thermal conductivity";
  row.setting = setting_of(point.combination.name(), point.method, state_of(point));
  row.unit = "k/(r_c tau)";
  row.ours = interval_of(record["line"]["conductivity"]);
  put_theory(row, analytic(point, record), analytic_name, 0.2);
  const Interval better = with_structure(point, record);
  row.explanation = fmt::format(
      "{:+.1f} % from the analytic value, which takes particles to be where chance puts them; with "
      "the measured g(r) and velocity autocorrelation it is {:.1f} +- {:.1f}, from which ours is "
      "{:+.1f} %. Both leave out that neighbours' temperatures and velocities are correlated.",
      100 * (row.ours.value / row.theory->value - 1), better.value,
      0.5 * (better.high - better.low), 100 * (row.ours.value / better.value - 1));
  return row;
}

Picture picture(const Conditions& conditions, const Scan& scan, const Records& records) {
  judge::Chart chart{
      std::string("conductivity ") + scan.title, {scan.axis}, {"thermal conductivity"}, {}};
  for (const auto& combination : all_combinations()) {
    judge::Series measured{combination.name(), {}};
    judge::Series theory{combination.name() + ", analytic", {}, judge::Marks::line};
    for (const auto& point : points_of(combination, conditions, scan)) {
      const json& record = records.at(point.name());
      if (failed(record)) continue;
      const double x = point.*scan.variable;
      measured.points.push_back(point_of(x, interval_of(record["line"]["conductivity"])));
      theory.points.push_back({x, analytic(point, record), {}, {}});
    }
    chart.series.push_back(std::move(measured));
    chart.series.push_back(std::move(theory));
  }
  return {
      std::string("So20 Fig. 4: conductivity ") + scan.title,
      fmt::format("{}, and {} where that does not run, from the heat flux over the slope between "
                  "the slabs; lines: analytic, without structure.",
                  to_string(leading_method(conditions)), to_string(contrast)),
      std::move(chart),
      {}};
}

bool both_ran(const std::vector<Point>& points, const Records& records) {
  return !failed(records.at(points.front().name())) && !failed(records.at(points.back().name()));
}

/// The conductivity at the end of a scan over that at its start: the shape of the paper's curve,
/// which our choice of parameters need not spoil.
Row trend(const Combination& combination, const Conditions& conditions, const Scan& scan,
          const Records& records) {
  const auto points = points_of(combination, conditions, scan);
  const Point &from = points.front(), &to = points.back();
  const json &low = records.at(from.name()), &high = records.at(to.name());
  Row row;
  row.quantity = fmt::format("conductivity at {0} {1:g} / at {0} {2:g}", scan.axis,
                             to.*scan.variable, from.*scan.variable);
  row.setting = setting_of(combination.name(), from.method);
  row.unit = "1";
  row.ours =
      ratio(interval_of(high["line"]["conductivity"]), interval_of(low["line"]["conductivity"]));
  if (scan.variable == &Point::heat_flux) {
    put_theory(row, 1, "Fourier's law: the flux does not matter", 0.3);
    row.explanation =
        "Both at mean temperature 1. At the larger flux the temperatures of the two slabs differ "
        "by about 80 %, so that the slope is one of a curved profile.";
  } else {
    put_theory(row, analytic(to, high) / analytic(from, low), analytic_name, 0.3);
    row.explanation = fmt::format("{:+.0f} % from the analytic trend.",
                                  100 * (row.ours.value / row.theory->value - 1));
  }
  return row;
}

/// The abstract's sentence, for all states of a combination that ran.
void add_estimate_row(const Combination& combination, const Conditions& conditions,
                      const Records& records, Outcome& outcome) {
  const auto method = methods_for(combination, conditions).front();
  std::vector<RatioAt> ratios;
  for (const auto& point : all_points(conditions)) {
    if (point.combination.name() != combination.name() || !same(point.method, method)) continue;
    const json& record = records.at(point.name());
    if (failed(record)) continue;
    ratios.push_back({state_of(point), scaled(interval_of(record["line"]["conductivity"]),
                                              1 / analytic(point, record))});
  }
  if (ratios.empty()) return;
  outcome.rows.push_back(
      about_row("thermal conductivity / analytic one", setting_of(combination.name(), method),
                "the analytic approximation allows an estimate a priori", ratios));
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  outcome.remarks = common_remarks(conditions);
  for (const auto& combination : all_combinations()) {
    add_estimate_row(combination, conditions, records, outcome);
  }
  for (const auto& combination : all_combinations()) {
    for (const auto& scan : scans()) {
      if (!both_ran(points_of(combination, conditions, scan), records)) continue;
      outcome.rows.push_back(trend(combination, conditions, scan, records));
    }
  }
  for (const auto& point : all_points(conditions)) {
    if (const auto* record = record_or_remark(records, point.name(), outcome)) {
      outcome.rows.push_back(row_of(point, *record));
    }
  }
  for (const auto& scan : scans()) outcome.pictures.push_back(picture(conditions, scan, records));
  outcome.remarks.push_back(
      "No number of the paper's figure is known to us, and its eq. 17-26 without their symbols. "
      "Theory is evaluated here: (2 pi rho^2/3) int lambda r^4 dr + rho phi k T/(m (w_0 + w_q)) + "
      "5 rho k^2 T/(6 m "
      "w_0), w_0 the collision rate and w_q the rate at which conduction relaxes an internal "
      "energy "
      "(derived; g = 1).");
  return outcome;
}

}  // namespace

const Experiment soleymani_2020_figure_4{
    .name = "soleymani-2020-figure-4",
    .source = "So20 Fig. 4",
    .title = "Thermal conductivity against temperature, density and heat flux",
    .question =
        "Soleymani et al. measure the thermal conductivity from the temperature gradient between "
        "two slabs at an imposed heat flux and compare it with an analytic approximation. Here at "
        "three temperatures, densities and fluxes, for six combinations of repulsion and heat "
        "form, by the paper's scheme; at the common point, and where the repulsion follows the "
        "temperatures, by shardlow-s1.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
