#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/mackie_box.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr std::size_t particles = 30000;
constexpr double time_step = 0.01, sample_every = 0.5, margin = 2.5;
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr Interval paper_energy{33828, 33827, 33829}, paper_pressure{1.137, 1.132, 1.142};

const MethodChoice splitting{"shardlow-s1", {}};
const MethodChoice exact{"avalos-mackie-midpoint", {}};
const MethodChoice never_negative{"metropolized-splitting", {}};

/// A box between reservoirs in equilibrium.
struct Run {
  MethodChoice method;
  WallRepulsion repulsion;
  int walled_axes;
  unsigned replicas;
  double settle, duration;
  bool gives_energy;  ///< long enough for it

  std::string name() const {
    const auto wall = repulsion.strength == 0 ? std::string("hard walls")
                                              : fmt::format("walls of range {:g} and strength {:g}",
                                                            repulsion.range, repulsion.strength);
    return fmt::format("{}, {} on {} faces", to_string(method), wall, 2 * walled_axes);
  }
  std::string part(unsigned replica) const { return fmt::format("{}, run {}", name(), replica); }
  WallLayer layer() const {
    return wall_layer(repulsion, mackie_parameters(mackie_liquid).boltzmann, mackie_temperature);
  }
  Box box() const {
    const auto fluid = mackie_parameters(mackie_liquid);
    return mackie_cube(particles, mackie_reservoir(fluid, mackie_temperature, repulsion),
                       walled_axes);
  }
  double side() const { return box().lengths[0]; }
  /// All of them, as wide as the box.
  double wall_area() const { return 2 * walled_axes * side() * side(); }
  MackieBulk bulk() const { return mackie_bulk(particles, repulsion, walled_axes); }
  /// Near an edge the other walls keep particles away: what an area as wide as the box feels.
  double pressure() const {
    const double share = std::pow(bulk().side / side(), walled_axes - 1);
    return bulk().density * share * mackie_temperature;
  }
  /// Of the particles in the walls' layers, over phi T_R.
  double wall_energy() const {
    const double area = wall_area() * std::pow(bulk().side / side(), walled_axes - 1);
    return layer().potential * bulk().density * area /
           mackie_parameters(mackie_liquid).heat_capacity;
  }
  /// What heat made at a rate per particle adds to U* when it has to leave through the walls.
  double heated_by(double rate) const;
};

/// Mean of the solution of -laplacian(w) = 1 in a unit cube, 0 on the faces of so many axes.
double mean_of_heated_cube(int walled_axes) {
  if (walled_axes == 1) return 1.0 / 12;
  const double pi = std::numbers::pi;
  double sum = 0;
  for (int l = 1; l < 60; l += 2) {
    for (int m = 1; m < 60; m += 2) {
      for (int n = 1; n < 60; n += 2) {
        const double product = l * m * n;
        sum += 512 / (std::pow(pi, 8) * product * product * (l * l + m * m + n * n));
      }
    }
  }
  return sum;
}

double Run::heated_by(double rate) const {
  const auto fluid = mackie_parameters(mackie_liquid);
  const double warming = rate * bulk().density * bulk().side * bulk().side *
                         mean_of_heated_cube(walled_axes) / mackie_conductivity(bulk().density);
  return particles * (fluid.heat_capacity + 2.5 * fluid.boltzmann) * warming / fluid.heat_capacity;
}

constexpr WallRepulsion hard_walls{0, 1}, steep_walls{43, 0.62};

std::vector<Run> runs_of(const Conditions& conditions) {
  const bool full = conditions.effort == Effort::full;
  const double settle = full ? 100 : 20, brief = full ? 420 : 70;
  const auto methods = conditions.methods_or(mackie_explicit, {splitting});
  std::vector<Run> runs;
  for (const auto& method : methods) {
    runs.push_back(
        {method, mackie_repulsion, 3, full ? 2U : 1U, settle, full ? 2600.0 : brief, full});
  }
  runs.push_back({methods.front(), mackie_repulsion, 1, 1, settle, brief, false});
  runs.push_back({conditions.method_or(splitting), hard_walls, 3, 1, settle, brief, false});
  for (const auto& method : methods) {
    runs.push_back({method, steep_walls, 3, 1, settle, brief, false});
  }
  return runs;
}

json run(const Run& run, std::uint64_t seed, unsigned replica, const Workplace& workplace) {
  const auto fluid = mackie_parameters(mackie_liquid);
  const Box box = run.box();
  const Noise noise(seed, replica);
  System system(
      Fluid(fluid), box,
      mackie_in_law(fluid, box, particles, mackie_temperature, run.layer().excluded, noise), noise);
  BoxSeries series(time_step, margin);
  const auto every = static_cast<std::uint64_t>(std::llround(sample_every / time_step));
  const auto from = static_cast<std::uint64_t>(std::llround(run.settle / time_step));
  run_box(system, run.method, time_step, run.duration, {{"series", &series, every, from}},
          workplace);
  return series.to_json();
}

/// A closed box, hard walls without temperature, from rest.
struct Closed {
  MethodChoice method;
  double B;
  std::string name() const { return fmt::format("closed box, {}, B = {:g}", to_string(method), B); }
};

std::vector<Closed> closed_boxes(const Conditions& conditions) {
  std::vector<Closed> all;
  for (const auto& method : conditions.methods_or(mackie_explicit, {exact})) {
    all.push_back({method, 0.01});
  }
  // With B = 0.1 and this conduction a step's noise is half of what internal energies scatter by:
  // schemes that add it would take some of them below zero.
  all.push_back({conditions.method_or(never_negative), 0.1});
  return all;
}

constexpr std::size_t closed_particles = 2000;
constexpr double closed_settle = 30;

json run_closed(const Closed& closed, double duration, std::uint64_t seed,
                const Workplace& workplace) {
  const auto fluid = mackie_parameters({closed.B, mackie_liquid.C, mackie_liquid.range});
  const Box box = mackie_cube(closed_particles, Wall{});
  const Noise noise(seed, 0);
  System system(Fluid(fluid), box, mackie_at_rest(fluid, box, closed_particles, 1, 0, noise),
                noise);
  BoxSeries series(time_step);
  try {
    run_box(system, closed.method, time_step, duration, {{"series", &series, 50, 0}}, workplace);
  } catch (const LongRunFailure& failure) {
    return {{"failure", failure.what()}};
  }
  return series.to_json();
}

/// Energy in and energy stored, step by step, between hard reservoirs.
std::vector<MethodChoice> bookkeepers(const Conditions& conditions) {
  return conditions.methods_or(mackie_explicit, {exact, splitting});
}

constexpr std::size_t booked_particles = 300;
constexpr double booked_start = 1;

json run_books(const MethodChoice& method, std::uint64_t seed, const Workplace& workplace) {
  const auto fluid = mackie_parameters(mackie_liquid);
  const Box box =
      mackie_cube(booked_particles, mackie_reservoir(fluid, mackie_temperature, hard_walls));
  const Noise noise(seed, 0);
  System system(Fluid(fluid), box,
                mackie_at_rest(fluid, box, booked_particles, booked_start, 0, noise), noise);
  BoxSeries series(time_step);
  run_box(system, method, time_step, 20, {{"series", &series, 1, 0}}, workplace);
  return series.to_json();
}

std::string books_name(const MethodChoice& method) {
  return fmt::format("books at every step, {}", to_string(method));
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  const std::uint64_t seed = conditions.seed;
  for (const auto& asked : runs_of(conditions)) {
    for (unsigned replica = 0; replica < asked.replicas; ++replica) {
      all.push_back(
          {asked.part(replica), 3.2e-7 * particles * asked.duration / time_step, false,
           [=](const Workplace& workplace) { return run(asked, seed, replica, workplace); }});
    }
  }
  const double duration = conditions.effort == Effort::full ? 330 : 80;
  for (const auto& closed : closed_boxes(conditions)) {
    all.push_back({closed.name(), 5e-7 * closed_particles * duration / time_step, false,
                   [=](const Workplace& workplace) {
                     return run_closed(closed, duration, seed, workplace);
                   }});
  }
  for (const auto& method : bookkeepers(conditions)) {
    all.push_back({books_name(method), 0.3, false,
                   [=](const Workplace& workplace) { return run_books(method, seed, workplace); }});
  }
  return all;
}

/// What the walls have received less what the fluid has lost, kinetic and potential energy
/// included: what the scheme has made of nothing.
Eigen::VectorXd made_of_nothing(const json& series) {
  Eigen::VectorXd sum = column_from(series, "kinetic") + column_from(series, "internal") +
                        column_from(series, "potential");
  for (const char* heat : {"heat_0", "heat_1", "heat_2", "heat_3", "heat_4", "heat_5"}) {
    sum += column_from(series, heat);
  }
  return sum.array() - sum[0];
}

Eigen::VectorXd rates(const Eigen::VectorXd& values, double interval) {
  const Eigen::Index n = values.size() - 1;
  return (values.tail(n) - values.head(n)) / interval;
}

using Replicas = std::vector<Eigen::VectorXd>;

/// A series of every replica of a run.
template <class Make>
Replicas replicas(const Run& run, const Records& records, Make&& make) {
  Replicas all;
  for (unsigned replica = 0; replica < run.replicas; ++replica) {
    all.push_back(make(records.at(run.part(replica))));
  }
  return all;
}

Row& add(Outcome& outcome, const std::string& quantity, const std::string& setting,
         const std::string& unit, const Interval& ours, const std::string& explanation = {}) {
  outcome.rows.push_back(mackie_row(quantity, setting, unit, ours));
  outcome.rows.back().explanation = explanation;
  return outcome.rows.back();
}

void compare_with(Row& row, const Interval& paper, double resolution) {
  row.paper = paper;
  row.verdict = compare(row.ours, paper, resolution);
}

/// U* = (K + U)/(phi T_R) of the theory, N (1 + 5 B/2) T*.
double theory_energy() { return particles * (1 + 2.5 * mackie_liquid.B) * mackie_temperature; }

/// The part N B T* of that which is the fluctuation of u: <theta> is above 1/<1/theta> by it.
double theory_fluctuation() { return particles * mackie_liquid.B * mackie_temperature; }

void add_energy(Outcome& outcome, const Run& run, const Records& records) {
  const double phi = mackie_parameters(mackie_liquid).heat_capacity;
  const auto mean = [&](bool potential) {
    return interval_of(estimate_mean(replicas(run, records, [&](const json& series) {
      Eigen::VectorXd energy = column_from(series, "kinetic") + column_from(series, "internal");
      if (potential) energy += column_from(series, "potential");
      return Eigen::VectorXd(energy / phi);
    })));
  };
  Row& without =
      add(outcome, "U* of kinetic and internal energies", run.name(), "phi T_R", mean(false),
          fmt::format("Theory: {:.0f}. Reservoirs hold <1/theta>, so that a variance of u that is "
                      "1 % too large lifts U* by {:.1f}, beside what the scheme makes (below). The "
                      "fluid's energy fluctuates by 19: an error of 1 takes 400 independent "
                      "samples.",
                      theory_energy(), 0.01 * theory_fluctuation()));
  compare_with(without, paper_energy, 1e-4);
  Row& with =
      add(outcome, "U* with the potential energy at the walls", run.name(), "phi T_R", mean(true),
          fmt::format("Theory with these walls' repulsion: {:.1f}.",
                      theory_energy() + run.wall_energy()));
  compare_with(with, paper_energy, 1e-4);
}

/// Momentum that walls receive, densities, and what they say of the pressure.
void add_pressure(Outcome& outcome, const Run& run, const Records& records) {
  const double boltzmann = mackie_parameters(mackie_liquid).boltzmann;
  const auto pressure = interval_of(estimate_mean(replicas(run, records, [&](const json& series) {
    return Eigen::VectorXd(rates(column_from(series, "pushed"), sample_every) /
                           (run.wall_area() * boltzmann));
  })));
  const double bulk_volume = std::pow(run.side() - 2 * margin, run.walled_axes) *
                             std::pow(run.side(), 3 - run.walled_axes);
  const auto bulk = interval_of(estimate_mean(replicas(run, records, [&](const json& series) {
    return Eigen::VectorXd(column_from(series, "bulk") / bulk_volume);
  })));
  Row& row = add(outcome, "wall pressure P*", run.name(), "P*", pressure,
                 fmt::format("The walls keep particles out of layers of {:.3f}. Predicted from "
                             "that and the ideal gas: {:.4f}.",
                             run.layer().excluded, run.pressure()));
  compare_with(row, paper_pressure, 0.01);
  const double T = mackie_temperature, law = run.bulk().density * T;
  Row& density = add(outcome, "bulk pressure rho_bulk T*", run.name(), "P*",
                     {bulk.value * T, bulk.low * T, bulk.high * T},
                     fmt::format("Ideal gas at the density counted further than {:g} from every "
                                 "wall.{}",
                                 margin,
                                 run.walled_axes > 1 ? " It is above the pressure on the walls "
                                                       "because no particle comes near the edges "
                                                       "of a wall's area."
                                                     : ""));
  put_theory(density, law, "ideal gas between the layers that the walls exclude", 0.01);
}

void add_production(Outcome& outcome, const Run& run, const Records& records) {
  const auto made = interval_of(estimate_mean(replicas(run, records, [&](const json& series) {
    return Eigen::VectorXd(rates(made_of_nothing(series), sample_every) / particles);
  })));
  const double unit = mackie_parameters(mackie_liquid).boltzmann * mackie_temperature;
  add(outcome, "energy that the scheme makes, per particle and time", run.name(), "kT/t*",
      {made.value / unit, made.low / unit, made.high / unit},
      "What walls and fluid together gain.");
  const double base = theory_energy();
  Row& row =
      add(outcome, "U* predicted from that", run.name(), "phi T_R",
          {base + run.heated_by(made.value), base + run.heated_by(made.low),
           base + run.heated_by(made.high)},
          "What is made must leave through the walls: it warms the fluid as its conductivity (MAN "
          "3.28) says.");
  if (find_method(run.method.name)->energy_ideal == EnergyClaim::exact) {
    row.explanation = "The scheme keeps the energy of what pairs exchange.";
  } else if (same(run.method, mackie_explicit)) {
    row.explanation += fmt::format(
        " The rate is proportional to the step: the paper's 3 above the theory belong to a step of "
        "{:.4f}.",
        time_step * 3 / run.heated_by(made.value));
  }
  compare_with(row, paper_energy, 1e-4);
}

/// Which strength gives the paper's pressure, for walls of a range: that depends on the layer
/// alone, P* = T* L/(L - 2 layers), on however many faces.
double strength_for(double range) {
  const double boltzmann = mackie_parameters(mackie_liquid).boltzmann;
  const double side = std::cbrt(static_cast<double>(particles));
  const double wanted = 0.5 * side * (1 - mackie_temperature / paper_pressure.value);
  double low = 0, high = 1e6;
  for (int n = 0; n < 200; ++n) {
    const double middle = 0.5 * (low + high);
    (wall_layer({middle, range}, boltzmann, mackie_temperature).excluded < wanted ? low : high) =
        middle;
  }
  return 0.5 * (low + high);
}

void add_candidates(Outcome& outcome) {
  for (const int axes : {1, 3}) {
    for (const double range : {0.55, 0.62, 0.76, 1.24}) {
      const double strength = strength_for(range);
      const Run run{{}, {strength, range}, axes, 0, 0, 0, false};
      const double energy = theory_energy() + run.wall_energy();
      Row& row = add(outcome, "U* with the potential energy at walls that give P* = 1.137",
                     fmt::format("theory, walls of range {:g} and strength {:.3g} on {} faces",
                                 range, strength, 2 * axes),
                     "phi T_R", {energy, energy, energy}, "Canonical law, no simulation.");
      compare_with(row, paper_energy, 1e-4);
    }
  }
}

void add_closed(Outcome& outcome, const Closed& closed, const json& series) {
  if (series.contains("failure")) {
    add(outcome, "final kinetic temperature", closed.name(), "T_R", {none, none, none},
        series["failure"])
        .verdict = Verdict::not_resolved;
    return;
  }
  const auto fluid = mackie_parameters({closed.B, mackie_liquid.C, mackie_liquid.range});
  const double kinetic_degrees = 3.0 * closed_particles;
  const double shape = 0.5 * kinetic_degrees + closed_particles * (1 / closed.B + 1);
  const double energy = closed_particles * fluid.heat_capacity;
  const Eigen::VectorXd kinetic =
      column_from(series, "kinetic", closed_settle) * 2 / (kinetic_degrees * fluid.boltzmann);
  const Eigen::VectorXd inverse = column_from(series, "inverse", closed_settle);
  const auto row = [&](const char* quantity, const Estimate& found, double law) {
    Row& made =
        add(outcome, quantity, closed.name(), "T_R", interval_of(found),
            "Energy conservation: N phi = N (phi + 5k/2) T, with the exact law of a finite "
            "box. A method with too large a variance of u has too low a 1/<1/theta>: 7 % of "
            "it, as under the explicit schemes at step 0.01 (Fig. 2), make 0.07 %.");
    put_theory(made, law, "exact law", 0.005);
  };
  row("final kinetic temperature", estimate_mean({kinetic}), energy / (fluid.boltzmann * shape));
  row("final internal temperature 1/<1/theta>",
      estimate({Eigen::MatrixXd(inverse)}, [](const auto& means) { return 1 / means[0]; }),
      energy / (fluid.boltzmann * (shape - 1)));
  const Eigen::VectorXd made = made_of_nothing(series);
  const double last = made[made.size() - 1] / energy;
  add(outcome, "energy gained by the end, as a share", closed.name(), "1", {last, last, last});
}

void add_books(Outcome& outcome, const MethodChoice& method, const json& series) {
  const double thermal = 0.5 * mackie_temperature;
  const Eigen::VectorXd made = made_of_nothing(series) / thermal;
  const double worst = rates(made, 1).cwiseAbs().maxCoeff();
  Row& row = add(outcome, "largest energy of a step that nothing gave",
                 fmt::format("{}, {} particles, {} steps, hard reservoirs", to_string(method),
                             booked_particles, made.size() - 1),
                 "kT", {worst, worst, worst});
  if (find_method(method.name)->energy_ideal != EnergyClaim::exact) {
    row.explanation = "The scheme keeps energy only to an order of the step.";
    return;
  }
  row.paper_text = "energy in = energy stored, to rounding";
  row.verdict = worst < 1e-8 ? Verdict::agrees : Verdict::differs;
  row.explanation = fmt::format("Rounding, of a total of {:.3g} kT.",
                                booked_particles * (1 / mackie_liquid.B) / mackie_temperature);
}

/// How the pressure follows what walls exclude.
Picture pressure_picture(const Outcome& outcome, const std::vector<Run>& runs) {
  judge::Chart chart{"wall pressure", {"layer that a wall excludes"}, {"P*"}, {}};
  judge::Series measured{"measured", {}}, line{"T* L/(L - 2 layers)", {}, judge::Marks::line};
  for (const auto& run : runs) {
    for (const auto& row : outcome.rows) {
      if (row.quantity != "wall pressure P*" || row.setting != run.name()) continue;
      measured.points.push_back(
          {run.layer().excluded, row.ours.value, row.ours.low, row.ours.high});
    }
  }
  std::sort(measured.points.begin(), measured.points.end(),
            [](const auto& a, const auto& b) { return a.x < b.x; });
  const double side = runs.front().side();
  for (const double layer : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    line.points.push_back({layer, mackie_temperature * side / (side - 2 * layer), {}, {}});
  }
  const double layer = 0.5 * side * (1 - mackie_temperature / paper_pressure.value);
  judge::Series paper{"MAN",
                      {{layer, paper_pressure.value, paper_pressure.low, paper_pressure.high}}};
  chart.series = {measured, line, paper};
  return {"Wall pressure and what walls exclude",
          "The paper's point is drawn where its pressure puts it on the line.",
          std::move(chart),
          {}};
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  const auto runs = runs_of(conditions);
  for (const auto& run : runs) {
    if (run.gives_energy) add_energy(outcome, run, records);
    add_pressure(outcome, run, records);
    add_production(outcome, run, records);
  }
  add_candidates(outcome);
  for (const auto& closed : closed_boxes(conditions)) {
    add_closed(outcome, closed, records.at(closed.name()));
  }
  for (const auto& method : bookkeepers(conditions)) {
    add_books(outcome, method, records.at(books_name(method)));
  }
  outcome.pictures = {pressure_picture(outcome, runs)};
  outcome.remarks = {
      "Why is the pressure not 1.1? Because repulsive walls keep particles out of a layer at each "
      "face. With N k T = P (area) (length left between the layers) the pressure over the faces' "
      "whole area is T* L/(L - 2 layers), on two faces or on six; 1.137 takes layers of 0.505, "
      "which a range of 1.24, that of friction and heat, with a strength of 1.8 has: chosen for "
      "it. Hard walls "
      "give 1.1.",
      "Walls on how many faces? The time of the warming (Fig. 3) speaks for six.",
      "Why is the paper's U* above the theory? Its explicit scheme makes energy at a rate that is "
      "proportional to the step, which has to leave through the walls. Exact schemes between the "
      "same walls have the theory's energy. Or U* counts the potential energy at the walls: the "
      "rows of theory say for which walls that would be 3.",
      "Runs that give no U* are too short for it: the energy relaxes within about 40 units of "
      "time."};
  return outcome;
}

}  // namespace

const Experiment mackie_1999_walls{
    .name = "mackie-1999-walls",
    .source = "MAN text",
    .title = "Energy, pressure on the walls, closed boxes",
    .question =
        "30000 particles between walls at T* = 1.1 (C = 17, B = 0.01, r* = 1.24, step 0.01): the "
        "mean energy U* beside the paper's 33828 +- 1 and the theory's 33825, the momentum that "
        "the walls receive beside 1.137 +- 0.005 and the 1.1 of the ideal gas, the density in the "
        "middle, for walls of several ranges and strengths. The final temperature of closed boxes "
        "(hard walls without heat, from rest), and the energy that walls give beside the energy "
        "that the fluid stores, step by step.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = liquid_unsuited};

}  // namespace driftless::reproduce
