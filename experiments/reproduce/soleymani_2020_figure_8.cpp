#include <fmt/format.h>

#include <cmath>

#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/soleymani_2020.hpp"

namespace driftless::reproduce {
namespace {

using namespace so20;
using nlohmann::json;

constexpr double heat_flux = 6;

struct Point {
  double repulsion, friction;
  MethodChoice method;
  double step() const { return friction > 10 ? 0.005 : 0.01; }
  Combination combination() const { return {repulsion, HeatForm::inverse_temperature}; }
  std::string name() const {
    return fmt::format("{}, friction {:g}, {}, step {:g}", combination().name(), friction,
                       to_string(method), step());
  }
};

const std::vector<double>& frictions() {
  static const std::vector<double> all = {2.25, 4.5, 9, 18};
  return all;
}

std::vector<Point> all_points(const Conditions& conditions) {
  const auto both = methods(conditions);
  std::vector<Point> points;
  for (const double repulsion : {0.0, 25.0}) {
    for (const double friction : frictions()) points.push_back({repulsion, friction, both.front()});
    if (both.size() > 1) points.push_back({repulsion, 4.5, both.back()});
  }
  return points;
}

flux::PeriodicFluid fluid_at(const Point& point, const Conditions& conditions) {
  auto fluid = box_of(point.combination(), point.method, conditions);
  fluid.fluid.friction = point.friction;
  fluid.step = point.step();
  return fluid;
}

/// c_p of a particle: c_v = phi + 5 k/2 of the motion and the internal energy, and T
/// (dp/dT)^2/(rho^2 dp/drho) with p = rho k T + 0.101 a rho^2 [Groot and Warren 1997]; what the
/// potential energy adds to c_v is left out (below k).
double heat_capacity_at_pressure(const flux::PeriodicFluid& fluid) {
  const double k = fluid.fluid.boltzmann, t = fluid.temperature;
  const double stiffness = k * t + 0.202 * fluid.fluid.repulsion * fluid.density;
  return fluid.fluid.heat_capacity + 2.5 * k + k * k * t / stiffness;
}

/// The theory without structure; the time in which velocities are forgotten is that of friction,
/// 1/w_0, or one that was measured.
struct Theory {
  double collision_time, viscosity, conductivity, prandtl, schmidt;
};
Theory theory_of(const flux::PeriodicFluid& fluid, double measured_time = 0) {
  const auto& f = fluid.fluid;
  auto sums = flux::without_structure(f, fluid.density, fluid.temperature);
  if (measured_time > 0) sums.collision_rate = 1 / measured_time;
  const double thermal = f.boltzmann * fluid.temperature;
  Theory t{};
  t.collision_time = 1 / sums.collision_rate;
  t.viscosity = sums.viscosity + fluid.density * thermal / (2 * sums.collision_rate);
  t.conductivity = flux::predicted_conductivity(f, fluid.density, fluid.temperature, sums).total();
  t.prandtl = heat_capacity_at_pressure(fluid) * t.viscosity / (f.mass * t.conductivity);
  t.schmidt = t.viscosity * sums.collision_rate / (fluid.density * thermal);
  return t;
}

std::size_t shear_replicas(Effort effort) { return effort == Effort::quick ? 12 : 40; }

json measure(const Point& point, const Conditions& conditions) {
  const auto fluid = fluid_at(point, conditions);
  json record = flux::run_in_equilibrium(fluid, equilibrium_duration(conditions.effort));
  const double expected = 1.3 * theory_of(fluid).viscosity;
  record.update(flux::run_shear_decay(fluid, 1, shear_replicas(conditions.effort), expected));
  const auto slabs = flux::run_between_slabs(slabs_of(fluid, heat_flux, conditions.effort));
  record["conductivity"] = slabs["lines"]["whole"]["conductivity"];
  return record;
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& point : all_points(conditions)) {
    const auto fluid = fluid_at(point, conditions);
    const auto slabs = slabs_of(fluid, heat_flux, conditions.effort);
    // With repulsion every replica comes to equilibrium first.
    const double replica = point.repulsion == 0 ? 12 : 30;
    const double shear = replica * static_cast<double>(shear_replicas(conditions.effort));
    const double duration =
        slabs.settle + slabs.duration + equilibrium_duration(conditions.effort) + shear;
    all.push_back(
        {point.name(), cost_of(fluid, duration), false, [point, conditions](const Workplace&) {
           return or_failure([&] { return measure(point, conditions); });
         }});
  }
  return all;
}

/// What is concluded from a point: measured beside theory.
struct Numbers {
  Interval collision_time, diffusion, viscosity, conductivity, prandtl, schmidt;

  Numbers(const flux::PeriodicFluid& fluid, const json& record)
      : collision_time(interval_of(record["collision_time"])),
        diffusion(interval_of(record["diffusion"])),
        viscosity(interval_of(record["viscosity"])),
        conductivity(interval_of(record["conductivity"])),
        prandtl(scaled(ratio(viscosity, conductivity),
                       heat_capacity_at_pressure(fluid) / fluid.fluid.mass)),
        schmidt(scaled(ratio(viscosity, diffusion), 1 / (fluid.fluid.mass * fluid.density))) {}
};

/// A number beside theory with the measured collision time; the explanation tells what theory says
/// without it, and what it leaves out.
Row row_of(const std::string& quantity, const std::string& unit, const Point& point, double theory,
           double a_priori, const Interval& ours, const std::string& formula,
           const std::string& left_out) {
  Row row;
  row.quantity = quantity;
  row.setting = point.name();
  row.unit = unit;
  row.ours = ours;
  put_theory(row, theory, fmt::format("{}: {}", analytic_name, formula), 0.3);
  row.explanation =
      fmt::format("{:+.0f} % from the analytic value", 100 * (ours.value / theory - 1));
  if (a_priori != theory) {
    row.explanation +=
        fmt::format("; a priori, with the collision time of friction, it is {:.3g} ({:+.0f} %)",
                    a_priori, 100 * (ours.value / a_priori - 1));
  }
  row.explanation += ". " + left_out;
  return row;
}

void add_rows(const Point& point, const flux::PeriodicFluid& fluid, const json& record,
              Outcome& outcome) {
  const Numbers ours(fluid, record);
  const Theory a_priori = theory_of(fluid);
  const Theory theory = theory_of(fluid, ours.collision_time.value);
  const bool repels = point.repulsion != 0;
  const std::string crowd =
      "Theory has a particle in the mean of the others; of about 12 neighbours each moves with it "
      "a little, more so at a larger friction.";
  const std::string stress =
      repels ? "The stress of the repulsion is not in theory." : "Theory has g = 1. " + crowd;
  auto& rows = outcome.rows;
  rows.push_back(row_of("collision time", "tau", point, a_priori.collision_time,
                        a_priori.collision_time, ours.collision_time,
                        "1/w_0, w_0 = (rho/3m) int zeta 4 pi r^2 dr",
                        repels ? "Theory has no repulsion in it, which scatters particles and "
                                 "cages them. " +
                                     crowd
                               : crowd));
  rows.push_back(row_of(
      "viscosity", "m/(r_c tau)", point, theory.viscosity, a_priori.viscosity, ours.viscosity,
      "rho k T tau_c/2 + (2 pi rho^2/15) int zeta r^4 dr, tau_c as measured", stress));
  rows.push_back(row_of("thermal conductivity", "k/(r_c tau)", point, theory.conductivity,
                        a_priori.conductivity, ours.conductivity,
                        "(2 pi rho^2/3) int lambda r^4 dr + what diffuses in tau_c as measured",
                        "Correlations of neighbours' temperatures and g(r) are not in theory."));
  rows.push_back(row_of("Prandtl number", "1", point, theory.prandtl, a_priori.prandtl,
                        ours.prandtl, "c_p eta/(m conductivity)",
                        "It has the errors of the viscosity and of the conductivity."));
  rows.push_back(row_of("Schmidt number", "1", point, theory.schmidt, a_priori.schmidt,
                        ours.schmidt, "eta/(m rho D), D = k T tau_c/m",
                        "It has the error of the viscosity."));
}

/// The frictions at which the paper's scheme, or the one in its place, ran.
std::vector<Point> ran(double repulsion, const Conditions& conditions, const Records& records) {
  std::vector<Point> points;
  for (const double friction : frictions()) {
    const Point point{repulsion, friction, leading_method(conditions)};
    if (!failed(records.at(point.name()))) points.push_back(point);
  }
  return points;
}

/// What holds for all frictions: the paper's sentence on the collision time, and how the numbers
/// change from the smallest friction to the largest, the shape of the paper's curves.
void add_rows_of_all(double repulsion, const Conditions& conditions, const Records& records,
                     Outcome& outcome) {
  const auto points = ran(repulsion, conditions, records);
  if (points.empty()) return;
  const auto numbers = [&](const Point& point) {
    return Numbers(fluid_at(point, conditions), records.at(point.name()));
  };
  const std::string setting = fmt::format(
      "{}; {}, frictions {:g} to {:g}", points.front().combination().name(),
      to_string(points.front().method), points.front().friction, points.back().friction);
  std::vector<RatioAt> ratios;
  for (const auto& point : points) {
    ratios.push_back({fmt::format("friction {:g}", point.friction),
                      scaled(numbers(point).collision_time,
                             1 / theory_of(fluid_at(point, conditions)).collision_time)});
  }
  outcome.rows.push_back(
      about_row("collision time x w_0", setting, "the collision time is about 1/w_0", ratios));
  if (points.size() < 2) return;
  const auto trend = [&](const std::string& quantity, Interval Numbers::*measured,
                         double Theory::*predicted) {
    const auto analytic = [&](const Point& point) {
      return theory_of(fluid_at(point, conditions)).*predicted;
    };
    Row row;
    row.quantity = quantity + " at the largest friction / at the smallest";
    row.setting = setting;
    row.unit = "1";
    row.ours = ratio(numbers(points.back()).*measured, numbers(points.front()).*measured);
    put_theory(row, analytic(points.back()) / analytic(points.front()),
               fmt::format("{}, a priori", analytic_name), 0.3);
    row.explanation = fmt::format("{:+.0f} % from the analytic trend.",
                                  100 * (row.ours.value / row.theory->value - 1));
    outcome.rows.push_back(std::move(row));
  };
  trend("Prandtl number", &Numbers::prandtl, &Theory::prandtl);
  trend("Schmidt number", &Numbers::schmidt, &Theory::schmidt);
}

Picture correlations(const Records& records, const Conditions& conditions) {
  const auto method = leading_method(conditions);
  judge::Chart chart{"velocity autocorrelation", {"time"}, {"<v(0) v(t)>/<v^2>"}, {}};
  for (const double repulsion : {0.0, 25.0}) {
    const Point point{repulsion, 4.5, method};
    const json& record = records.at(point.name());
    if (failed(record)) continue;
    judge::Series series{point.combination().name(), {}, judge::Marks::line};
    for (std::size_t n = 0; n < record["vacf"]["time"].size(); ++n) {
      series.points.push_back({record["vacf"]["time"][n], record["vacf"]["value"][n], {}, {}});
    }
    chart.series.push_back(std::move(series));
  }
  const double time = theory_of(fluid_at({0, 4.5, method}, conditions)).collision_time;
  judge::Series theory{"exp(-w_0 t)", {}, judge::Marks::line};
  for (int n = 0; n <= 40; ++n) {
    const double t = 0.1 * n;
    theory.points.push_back({t, std::exp(-t / time), {}, {}});
  }
  chart.series.push_back(std::move(theory));
  return {"So20 Fig. 8: velocity autocorrelation",
          fmt::format("{}, friction 4.5; the integral is the collision time.", to_string(method)),
          std::move(chart),
          {}};
}

Picture against_friction(const Records& records, const Conditions& conditions, const char* title,
                         Interval Numbers::*measured, double Theory::*predicted) {
  const auto method = leading_method(conditions);
  judge::Chart chart{title, {"friction", true}, {title, true}, {}};
  for (const double repulsion : {0.0, 25.0}) {
    judge::Series series{repulsion == 0 ? "no repulsion" : "a = 25", {}};
    for (const double friction : frictions()) {
      const Point point{repulsion, friction, method};
      const json& record = records.at(point.name());
      if (failed(record)) continue;
      const Numbers numbers(fluid_at(point, conditions), record);
      series.points.push_back(point_of(friction, numbers.*measured));
    }
    chart.series.push_back(std::move(series));
  }
  judge::Series theory{"analytic, a priori", {}, judge::Marks::line};
  for (const double friction : frictions()) {
    theory.points.push_back(
        {friction, theory_of(fluid_at({0, friction, method}, conditions)).*predicted, {}, {}});
  }
  chart.series.push_back(std::move(theory));
  return {fmt::format("So20 eq. 17-26: {}", title), to_string(method), std::move(chart), {}};
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  outcome.remarks = common_remarks(conditions);
  for (const double repulsion : {0.0, 25.0}) {
    add_rows_of_all(repulsion, conditions, records, outcome);
  }
  for (const auto& point : all_points(conditions)) {
    if (const auto* record = record_or_remark(records, point.name(), outcome)) {
      add_rows(point, fluid_at(point, conditions), *record, outcome);
    }
  }
  outcome.pictures.push_back(correlations(records, conditions));
  outcome.pictures.push_back(against_friction(records, conditions, "collision time",
                                              &Numbers::collision_time, &Theory::collision_time));
  outcome.pictures.push_back(
      against_friction(records, conditions, "Prandtl number", &Numbers::prandtl, &Theory::prandtl));
  outcome.pictures.push_back(
      against_friction(records, conditions, "Schmidt number", &Numbers::schmidt, &Theory::schmidt));
  const auto fluid = fluid_at(all_points(conditions).front(), conditions);
  outcome.remarks.push_back(fmt::format(
      "Collision time and D from the velocity autocorrelation up to t = 4 in equilibrium ({:g} "
      "units "
      "of time); viscosity from the decay of a shear wave of the box's length {:g} along z, {} "
      "replicas; conductivity between slabs. D and viscosity are those of this box.",
      equilibrium_duration(conditions.effort), fluid.lengths[2],
      shear_replicas(conditions.effort)));
  outcome.remarks.push_back(
      "No number of the paper is known to us, and its eq. 17-26 without their symbols; the "
      "analytic "
      "values are those of "
      "Groot and Warren 1997 and Mackie, Bonet Avalos and Navas 1999 with diffusion of internal "
      "energy added (derived), without structure (g = 1), from the measured collision time. A "
      "priori: "
      "with that of friction alone. c_p = phi + 5 k/2 + T (dp/dT)^2/(rho^2 dp/drho).");
  return outcome;
}

}  // namespace

const Experiment soleymani_2020_figure_8{
    .name = "soleymani-2020-figure-8",
    .source = "So20 Fig. 8, eq. 17-26",
    .title = "Collision time, analytic conductivity, Prandtl and Schmidt number",
    .question =
        "Soleymani et al. take a collision time from the velocity autocorrelation and derive an "
        "analytic conductivity, Prandtl and Schmidt numbers from it. Here each is measured, with "
        "and without repulsion, at frictions from 2.25 to 18, by the paper's scheme (at 4.5 by "
        "shardlow-s1 too), beside the analytic values.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
