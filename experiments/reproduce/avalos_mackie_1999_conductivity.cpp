#include <fmt/format.h>

#include <numbers>

#include "experiments/avalos_mackie_fluid.hpp"
#include "experiments/reproduce/estimates.hpp"
#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/interval_arithmetic.hpp"
#include "experiments/transport/ideal_runs.hpp"
#include "experiments/transport/network.hpp"
#include "experiments/transport/theory.hpp"

// Conductivities are those of the paper's units, over phi.
namespace driftless::reproduce {
namespace {

using nlohmann::json;
using std::numbers::pi;

constexpr double box_length = 10;
const double wavenumber = 2 * pi / box_length;

std::vector<double> scalings(double range, Effort effort) {
  if (effort == Effort::full) return {0.03, 0.1, 0.3, 1, 3, 10, 30, 50, 100, 200, 500, 1000};
  if (range == am99::few) return {0.1, 0.3, 1, 10, 50, 200, 1000};
  return {0.1, 0.3, 10, 50, 200};
}

/// A gradient is the slower way: of a quick run only here.
bool has_gradient(double range, double scaling, Effort effort) {
  if (effort == Effort::full) return true;
  return scaling == 200 || (range == am99::few && scaling == 0.3);
}

std::string neighbours(double range) { return range == am99::few ? "n = 8" : "n = 100"; }

FluidParameters fluid_of(double range, double scaling) {
  return am99::fluid(range, scaling / std::pow(range, 5));
}

/// lambda*: 2 pi X/315 of the theory of long waves, and the mean field at a wavenumber.
double long_wave_theory(double scaling) { return 2 * pi / 315 * scaling; }
double mean_field(double range, double scaling) {
  const auto f = fluid_of(range, scaling);
  return transport::mean_field_conductivity(f, 1, wavenumber) / f.heat_capacity;
}

transport::IdealRun run_of(double range, double scaling, const Conditions& conditions) {
  transport::IdealRun run{fluid_of(range, scaling),
                          transport::fluid_box(box_length, box_length, 1)};
  run.method = conditions.method_or(run.method);
  run.seed = conditions.seed;
  const bool quick = conditions.effort == Effort::quick;
  run.replicas = range == am99::few ? (quick ? 6 : 16) : (quick ? 4 : 8);
  return run;
}

/// A twentieth of the time at which a particle's internal energy relaxes.
double step_of(double range, double scaling) {
  return std::min(0.05, 0.05 / transport::heat_rate(fluid_of(range, scaling), 1));
}

/// The predicted time of a wave's decay.
double wave_time(double range, double scaling) {
  return 1 / (mean_field(range, scaling) * wavenumber * wavenumber);
}

json relaxation(double range, double scaling, double step, const Conditions& conditions) {
  const auto run = run_of(range, scaling, conditions);
  const double window = 5 * wave_time(range, scaling);
  transport::WaveSchedule schedule;
  schedule.step = step;
  schedule.samples = 100;
  schedule.stride = transport::stride_of(window, schedule.samples, step);
  schedule.impositions = range == am99::few ? 2 : 1;
  const transport::Waves waves{{0, 1, 2}, 1, 0, 0, 0.05};
  const auto records = transport::relax_replicas(run, waves, schedule);
  const auto found = transport::conductivity(records, wavenumber, run.fluid, 1);
  return to_json(scaled(found, 1 / run.fluid.heat_capacity));
}

/// Predicted times of a wave's decay in which a gradient is measured.
double gradient_times(Effort effort) { return effort == Effort::quick ? 12 : 30; }

json gradient(double range, double scaling, double step, const Conditions& conditions) {
  const auto run = run_of(range, scaling, conditions);
  const double time = wave_time(range, scaling);
  transport::SourceSchedule schedule;
  schedule.step = step;
  schedule.warm_up = static_cast<std::uint64_t>(6 * time / step);
  schedule.steps = static_cast<std::uint64_t>(gradient_times(conditions.effort) * time / step);
  schedule.stride = std::max<std::uint64_t>(1, std::llround(0.05 * time / step));
  schedule.rate = 0.05 * run.fluid.heat_capacity / time;
  const auto found = transport::heat_replicas(run, schedule);
  auto record = to_json(scaled(found.conductivity, 1 / run.fluid.heat_capacity));
  record["amplitude"] = found.amplitude;
  return record;
}

/// Particles that lie still where chance has put them.
json network(double range, const Conditions& conditions) {
  const bool quick = conditions.effort == Effort::quick;
  std::vector<std::vector<double>> all;
  for (unsigned n = 0; n < (quick ? 6u : 24u); ++n) {
    const double inside = 4 * pi / 3 * std::pow(range, 3);
    const auto found =
        transport::random_network(quick ? 1000 : 4000, inside, 2, 1000 * conditions.seed + n);
    all.push_back({found.conductivity, found.viscosity});
  }
  json record = to_json(transport::jackknife(all, [](const auto& mean) { return mean[0]; }));
  record["viscosity"] =
      to_json(transport::jackknife(all, [](const auto& mean) { return mean[1]; }));
  return record;
}

std::string name_of(const std::string& way, double range, double scaling) {
  return fmt::format("{}, {}, X = {:g}", way, neighbours(range), scaling);
}

/// The X at which the step is halved.
constexpr double checked_scaling = 50;

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const double range : {am99::few, am99::many}) {
    // Few neighbours take more iterations.
    const double networks = conditions.effort == Effort::quick ? 1 : 20;
    all.push_back({"network, " + neighbours(range), (range == am99::few ? 6 : 2) * networks, false,
                   [=](const Workplace&) { return network(range, conditions); }});
    const auto add = [&](const std::string& way, double scaling, double step, auto* measure,
                         double times) {
      const double pairs = 4 * pi / 6 * std::pow(range, 3);
      const double steps =
          times * wave_time(range, scaling) / step * run_of(range, scaling, conditions).replicas;
      all.push_back({name_of(way, range, scaling), 1000 * steps * (1.6e-7 + 8e-8 * pairs), false,
                     [=](const Workplace&) { return measure(range, scaling, step, conditions); }});
    };
    for (const double scaling : scalings(range, conditions.effort)) {
      const double step = step_of(range, scaling);
      const double times = range == am99::few ? 10 : 5;
      add("wave", scaling, step, relaxation, times);
      if (scaling == checked_scaling) {
        add("wave, half the step", scaling, step / 2, relaxation, times);
      }
      if (has_gradient(range, scaling, conditions.effort)) {
        add("gradient", scaling, step, gradient, 6 + gradient_times(conditions.effort));
      }
    }
  }
  return all;
}

std::optional<Estimate> record_of(const Records& records, const std::string& name) {
  const auto found = records.find(name);
  return found == records.end() ? std::nullopt : read_estimate(found->second);
}

void value_rows(const Conditions& conditions, const Records& records, Outcome& outcome) {
  for (const double range : {am99::few, am99::many}) {
    for (const double scaling : scalings(range, conditions.effort)) {
      for (const char* way : {"wave", "gradient"}) {
        const auto found = record_of(records, name_of(way, range, scaling));
        if (!found) continue;
        Row row;
        row.quantity = "thermal conductivity lambda*";
        row.setting =
            fmt::format("{}, X = {:g}, by a {}, wavelength 10", neighbours(range), scaling, way);
        row.unit = "phi zeta_0/(m l)";
        row.ours = interval_of(*found);
        row.explanation = fmt::format(
            "theory of long waves 2 pi X/315 = {:.3g}; mean field at this wavelength, with what "
            "particles carry, {:.3g}",
            long_wave_theory(scaling), mean_field(range, scaling));
        outcome.rows.push_back(row);
      }
    }
  }
}

/// The mean of two ways to the same number, weighted by errors.
std::optional<Estimate> both_ways(const Records& records, double range, double scaling) {
  const auto one = record_of(records, name_of("wave", range, scaling));
  const auto other = record_of(records, name_of("gradient", range, scaling));
  if (!one || !other) return one ? one : other;
  const double a = 1 / (one->error * one->error), b = 1 / (other->error * other->error);
  Estimate mean = *one;
  mean.mean = (a * one->mean + b * other->mean) / (a + b);
  mean.error = 1 / std::sqrt(a + b);
  return mean;
}

std::string network_words(const Records& records, double range) {
  const auto found = record_of(records, "network, " + neighbours(range));
  if (!found) return "";
  return fmt::format(
      "; particles that lie still where chance puts them conduct {:.3f} +- {:.3f} of theory (their "
      "network solved), as the steepest gradients lie where few neighbours are",
      found->mean, interval_quantile * found->error);
}

void large_rows(const Records& records, double scaling, Outcome& outcome) {
  for (const double range : {am99::few, am99::many}) {
    const auto found = both_ways(records, range, scaling);
    if (!found) continue;
    const bool is_few = range == am99::few;
    Row row;
    row.quantity = "conductivity over the theory of long waves, 2 pi X/315";
    row.setting = fmt::format("{}, X = {:g}, wavelength 10", neighbours(range), scaling);
    row.unit = "1";
    row.paper = is_few ? Interval{0.5, 0.4, 0.6} : Interval{1, 0.9, 1.1};
    row.paper_text = is_few ? "half of theory" : "follows theory";
    row.ours = interval_of(scaled(*found, 1 / long_wave_theory(scaling)));
    row.verdict = compare(row.ours, *row.paper, 0.2);
    row.explanation = fmt::format("mean field at this wavelength {:.3f}",
                                  mean_field(range, scaling) / long_wave_theory(scaling)) +
                      network_words(records, range);
    outcome.rows.push_back(row);
  }
}

/// What few neighbours cost where nothing moves.
void network_rows(const Records& records, Outcome& outcome) {
  for (const double range : {am99::few, am99::many}) {
    const auto record = records.find("network, " + neighbours(range));
    if (record == records.end()) continue;
    for (const bool is_heat : {true, false}) {
      const auto found = read_estimate(is_heat ? record->second : record->second["viscosity"]);
      if (!found) continue;
      Row row;
      row.quantity = is_heat ? "conductivity of resting particles over theory"
                             : "viscosity of resting particles' friction over theory";
      row.setting = neighbours(range) + ", random places, the network solved";
      row.unit = "1";
      row.ours = interval_of(*found);
      row.explanation = is_heat ? "below 1 as heat cannot take the straight way; moving particles "
                                  "lie between this and 1"
                                : "[MAN 3.27] lacks the same share";
      outcome.rows.push_back(row);
    }
  }
}

/// The conductivity at small X does not know L_0.
void small_rows(const Records& records, Outcome& outcome) {
  for (const double range : {am99::few, am99::many}) {
    const auto less = both_ways(records, range, 0.1), more = both_ways(records, range, 0.3);
    if (!less || !more) continue;
    Row row;
    row.quantity = "conductivity at X = 0.3 over that at X = 0.1";
    row.setting = neighbours(range) + ", wavelength 10";
    row.unit = "1";
    row.paper = Interval{1, 0.9, 1.1};
    row.paper_text = "independent of L_0";
    row.ours = ratio(interval_of(*more), interval_of(*less));
    row.verdict = compare(row.ours, *row.paper, 0.5);
    row.explanation = fmt::format(
        "mean field {:.3f}: what a particle carries shrinks with L_0 as soon as conduction takes "
        "its internal energy as fast as friction its velocity",
        mean_field(range, 0.3) / mean_field(range, 0.1));
    outcome.rows.push_back(row);
  }
}

/// The first X from which on the conductivity is within a fifth of its law at the largest X.
std::optional<Interval> crossover(const Conditions& conditions, const Records& records,
                                  double range) {
  const auto all = scalings(range, conditions.effort);
  const auto last = both_ways(records, range, all.back());
  if (!last) return {};
  const double law = last->mean / all.back();
  for (std::size_t n = all.size() - 1; n > 0; --n) {
    const auto found = both_ways(records, range, all[n - 1]);
    if (!found) return {};
    const double ratio = found->mean / (law * all[n - 1]);
    if (ratio > 1.2) return Interval{std::sqrt(all[n] * all[n - 1]), all[n - 1], all[n]};
  }
  return {};
}

void crossover_rows(const Conditions& conditions, const Records& records, Outcome& outcome) {
  for (const double range : {am99::few, am99::many}) {
    const auto found = crossover(conditions, records, range);
    if (!found) continue;
    Row row;
    row.quantity = "X from which the conductivity grows as X, to a fifth";
    row.setting = neighbours(range) + ", between two X that were run";
    row.unit = "1";
    row.paper = Interval{50, 30, 80};
    row.paper_text = "above about 50";
    row.ours = *found;
    row.verdict = found->low <= 80 && found->high >= 30 ? Verdict::agrees : Verdict::differs;
    row.explanation =
        "below, energy that particles carry along counts, the more the fewer they interact with";
    if (range == am99::few) {
      row.explanation +=
          "; with 8 neighbours the conductivity over X goes on falling from the mean field, where "
          "motion mixes neighbours faster than they conduct, to the network of resting particles";
    }
    outcome.rows.push_back(row);
  }
}

void step_rows(const Records& records, Outcome& outcome) {
  for (const double range : {am99::few, am99::many}) {
    const auto whole = record_of(records, name_of("wave", range, checked_scaling));
    const auto half = record_of(records, name_of("wave, half the step", range, checked_scaling));
    if (!whole || !half) continue;
    Row row;
    row.quantity = "conductivity at half the step over that at the step";
    row.setting = fmt::format("{}, X = {:g}", neighbours(range), checked_scaling);
    row.unit = "1";
    Estimate ratio = scaled(*half, 1 / whole->mean);
    ratio.error = std::hypot(half->error, whole->error) / whole->mean;
    row.ours = interval_of(ratio);
    row.explanation = "what the time step is worth";
    outcome.rows.push_back(row);
  }
}

/// lambda* against an abscissa made of X and the range.
judge::Chart chart(const Conditions& conditions, const Records& records, const std::string& title,
                   const std::string& axis, const std::function<double(double, double)>& abscissa) {
  judge::Chart chart{title, {axis, true}, {"conductivity lambda*", true}, {}};
  for (const double range : {am99::few, am99::many}) {
    const auto all = scalings(range, conditions.effort);
    for (const char* way : {"wave", "gradient"}) {
      judge::Series series{neighbours(range) + ", by a " + way, {}, judge::Marks::points};
      for (const double scaling : all) {
        const auto found = record_of(records, name_of(way, range, scaling));
        if (found) series.points.push_back(point(abscissa(range, scaling), *found));
      }
      chart.series.push_back(series);
    }
    judge::Series theory{
        neighbours(range) + ", mean field at this wavelength", {}, judge::Marks::line};
    for (const auto& one : line("", all.front(), all.back(), long_wave_theory).points) {
      theory.points.push_back({abscissa(range, one.x), mean_field(range, one.x), {}, {}});
    }
    chart.series.push_back(theory);
  }
  return chart;
}

void pictures(const Conditions& conditions, const Records& records, Outcome& outcome) {
  const auto all = scalings(am99::few, conditions.effort);
  auto first = chart(conditions, records, "AM99 Fig. 1: conductivity against X",
                     "X = C r*^5 rho*^2/T*^2", [](double, double scaling) { return scaling; });
  first.series.push_back(line("2 pi X/315", 1, all.back(), long_wave_theory));
  first.series.push_back(line("half of it", 1, all.back(),
                              [](double scaling) { return 0.5 * long_wave_theory(scaling); }));
  outcome.pictures.push_back(
      {first.title, "Wavelength 10; both ways have the same meaning.", first, {}});
  auto second = chart(conditions, records, "AM99 Fig. 2: conductivity against Y",
                      "Y = T*^3/(C r*^3)", [](double range, double scaling) {
                        return std::pow(range, 5) / (scaling * std::pow(range, 3));
                      });
  outcome.pictures.push_back(
      {second.title,
       "Y is taken as the scaling of what particles carry where conduction is fast, 15 Y/(4 pi).",
       second,
       {}});
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  large_rows(records, 200, outcome);
  large_rows(records, 1000, outcome);
  crossover_rows(conditions, records, outcome);
  small_rows(records, outcome);
  network_rows(records, outcome);
  step_rows(records, outcome);
  value_rows(conditions, records, outcome);
  pictures(conditions, records, outcome);
  outcome.remarks = {
      fmt::format("B = 0.01, rho* = T* = 1, 1000 particles in a box of 10, method {} at a step of "
                  "at most 0.05 and a twentieth of the time in which conduction relaxes a "
                  "particle: ours, where the paper's are not known to us.",
                  to_string(run_of(am99::few, 1, conditions).method)),
      "Both ways give the conductivity that a steady source of heat at the box's wavelength finds: "
      "injected energy over k^2 times the time integral of the temperature wave. It is the same at "
      "constant volume and pressure; c_v [AM99 4.3] or c_p would differ by B, 1 %.",
      "Y is not defined in what we hold of the paper; ours is the scaling of the carried part."};
  return outcome;
}

}  // namespace

const Experiment avalos_mackie_1999_conductivity = {
    .name = "avalos-mackie-1999-conductivity",
    .source = "AM99 Fig. 1, 2",
    .title = "Thermal conductivity of the ideal fluid, from carried to conducted",
    .question =
        "How does the conductivity depend on L_0, with 8 and with 100 particles within the range? "
        "A "
        "temperature wave of 5 % along all three axes of a cubic box of 1000 particles is left to "
        "decay; and a steady source of heat, a cosine along every axis, holds one of about 5 % up. "
        "X = C r*^5 rho*^2/T*^2. Beside them: the theory of long waves, the mean field at the "
        "box's "
        "wavelength, and the network of resting particles, solved.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = [](const MethodChoice& method) {
      return first_refusal(method, {fluid_of(am99::many, 1)});
    }};

}  // namespace driftless::reproduce
