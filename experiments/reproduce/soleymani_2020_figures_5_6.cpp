#include <fmt/format.h>

#include <cmath>

#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/soleymani_2020.hpp"

namespace driftless::reproduce {
namespace {

using namespace so20;
using nlohmann::json;

constexpr double heat_flux = 6;

/// Strengths of conduction, by which the share of what particles carry is varied. Without any, the
/// paper's scheme never evens out two particles' energies: what each gets in a slab it keeps.
const std::vector<double>& conductions() {
  static const std::vector<double> all = {10, 30, 100, 300, 1000};
  return all;
}

struct Point {
  Combination combination;
  MethodChoice method;
  double conduction;

  std::string name() const {
    return fmt::format("{}, {}, conduction {:g}", combination.name(), to_string(method),
                       conduction);
  }
};

/// The combinations of Fig. 5 (without repulsion) and of Fig. 6 (with it).
const std::vector<Combination>& shown() {
  static const std::vector<Combination> all = {{0, HeatForm::inverse_temperature},
                                               {25, HeatForm::inverse_temperature}};
  return all;
}

std::vector<Point> all_points(const Conditions& conditions) {
  const auto both = methods(conditions);
  std::vector<Point> points;
  for (const auto& combination : shown()) {
    for (const double conduction : conductions()) {
      points.push_back({combination, both.front(), conduction});
    }
    if (both.size() == 1) continue;
    for (const double conduction : {10.0, 300.0}) {
      points.push_back({combination, both.back(), conduction});
    }
  }
  return points;
}

flux::SlabRun run_of(const Point& point, const Conditions& conditions) {
  auto fluid = box_of(point.combination, point.method, conditions);
  fluid.fluid.conduction = point.conduction;
  // Pairs that conduct much in a step need a smaller one.
  if (point.conduction >= 1000) fluid.step = 0.005;
  auto run = slabs_of(fluid, heat_flux, conditions.effort);
  // What diffuses alone takes longer to follow.
  if (point.conduction < 100) run.settle *= 1.5;
  run.planes = true;
  return run;
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& point : all_points(conditions)) {
    const auto run = run_of(point, conditions);
    all.push_back({point.name(), 1.1 * cost_of(run.fluid, run.settle + run.duration), false,
                   [run](const Workplace&) {
                     return or_failure([&] { return flux::run_between_slabs(run); });
                   }});
  }
  return all;
}

std::string setting(const Point& point) {
  return fmt::format("{}; {}, step {:g}; conduction {:g}", point.combination.name(),
                     to_string(point.method), point.conduction >= 1000 ? 0.005 : 0.01,
                     point.conduction);
}

Row plain_row(std::string quantity, const Point& point, const Interval& ours,
              std::string explanation) {
  return {std::move(quantity), setting(point),        "energy/(area time)", {}, "", ours,
          Verdict::ours_alone, std::move(explanation)};
}

void add_rows(const Point& point, const json& record, Outcome& outcome) {
  const json& crossed = record["crossed"];
  const auto flux_of = [&](const char* key) { return interval_of(crossed[key]); };
  Row sum = plain_row(
      "heat flux: carried + conduction and work by the laws of pairs", point,
      flux_of("sum by laws"),
      "What particles carry is counted particle by particle; what pairs conduct and work is the "
      "mean by the fluid's laws at sampled instants, so that the sum could be wrong.");
  sum.paper = exactly(heat_flux);
  sum.paper_text = "the sum equals the imposed flux";
  sum.verdict = compare(sum.ours, *sum.paper, 0.15);
  outcome.rows.push_back(sum);

  outcome.rows.push_back(
      plain_row("diffusive flux of internal energy", point, flux_of("internal"), ""));
  outcome.rows.push_back(
      plain_row("diffusive flux of kinetic energy", point, flux_of("kinetic"), ""));
  if (point.combination.repulsion != 0) {
    outcome.rows.push_back(plain_row("diffusive flux of potential energy", point,
                                     flux_of("potential"), "Half of a pair's belongs to each."));
  }
  outcome.rows.push_back(plain_row("flux through pairs, exact", point, flux_of("pairs"),
                                   "Energies of the two sides before and after every step, less "
                                   "what particles carry: nothing of the method is assumed."));
  outcome.rows.push_back(
      plain_row("conductive flux by the law", point, flux_of("law conduction"), ""));
  const bool pays_alone = same(point.method, published);
  const Interval friction = flux_of("law friction work"), repulsion = flux_of("law repulsion work");
  const double half =
      0.5 * std::hypot(friction.high - friction.low, repulsion.high - repulsion.low);
  const double work = friction.value + repulsion.value;
  outcome.rows.push_back(plain_row(
      "flux by the work of pair forces, by their law", point, {work, work - half, work + half},
      pays_alone ? "The model has it, this method does not: each particle pays for its own kinetic "
                   "and potential energy, so that no work crosses a plane."
                 : ""));
}

Picture shares(const Combination& combination, const MethodChoice& method, const Records& records) {
  judge::Chart chart{"shares of the heat flux", {"conduction L_0", true}, {"heat flux"}, {}};
  const std::vector<std::pair<const char*, const char*>> shown_keys = {
      {"pairs", "through pairs (conductive)"},
      {"internal", "diffusive, internal"},
      {"kinetic", "diffusive, kinetic"},
      {"potential", "diffusive, potential"},
      {"sum by laws", "sum, by the laws of pairs"}};
  for (const auto& key : shown_keys) {
    judge::Series series{key.second, {}};
    for (const double conduction : conductions()) {
      const json& record = records.at(Point{combination, method, conduction}.name());
      if (failed(record)) continue;
      series.points.push_back(point_of(conduction, interval_of(record["crossed"][key.first])));
    }
    chart.series.push_back(std::move(series));
  }
  chart.series.push_back(
      {"imposed",
       {{conductions().front(), heat_flux, {}, {}}, {conductions().back(), heat_flux, {}, {}}},
       judge::Marks::line});
  return {fmt::format("So20 Fig. {}: conductive and diffusive flux, {}",
                      combination.repulsion == 0 ? 5 : 6, combination.name()),
          fmt::format("{}; through the two planes midway between the slabs.", to_string(method)),
          std::move(chart),
          {}};
}

/// What comes from the hot and from the cold side, by kind.
Picture sides(const Combination& combination, const MethodChoice& method, const Records& records) {
  judge::Chart chart{"what particles carry from either side",
                     {"conduction L_0", true},
                     {"energy carried per area and time"},
                     {}};
  for (const char* side : {"hot", "cold"}) {
    for (const char* kind : {"internal", "kinetic", "potential"}) {
      judge::Series series{fmt::format("from the {} side, {}", side, kind), {}};
      for (const double conduction : conductions()) {
        const json& record = records.at(Point{combination, method, conduction}.name());
        if (failed(record)) continue;
        const auto carried = interval_of(record["crossed"][fmt::format("{} {}", side, kind)]);
        series.points.push_back(point_of(conduction, carried));
      }
      chart.series.push_back(std::move(series));
    }
  }
  return {
      fmt::format("So20 Fig. {}: what comes from the hot and from the cold side, {}",
                  combination.repulsion == 0 ? 5 : 6, combination.name()),
      "Internal energies counted from their mean in the box; as many particles cross either way. "
      "A particle that crosses several times counts every time.",
      std::move(chart),
      {}};
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  outcome.remarks = common_remarks(conditions);
  for (const auto& point : all_points(conditions)) {
    if (const auto* record = record_or_remark(records, point.name(), outcome)) {
      add_rows(point, *record, outcome);
    }
  }
  for (const auto& combination : shown()) {
    outcome.pictures.push_back(shares(combination, leading_method(conditions), records));
    outcome.pictures.push_back(sides(combination, leading_method(conditions), records));
  }
  outcome.remarks.push_back(
      "Balance of a plane, exact for every step: a side's energy changes by what crossing "
      "particles "
      "carry, (e + e')/2 each with e before and e' after the step, and by what the pairs give to "
      "those that are there, half to those that cross. Beyond the imposed heat both sides change "
      "by "
      "nothing else.");
  if (same(leading_method(conditions), published)) {
    outcome.remarks.push_back(
        "In the paper's scheme a particle's own energy, kinetic, internal and half of the "
        "potential, changes by conduction alone (eq. 27-31): pairs do no work across a plane, and "
        "without conduction nothing but particles would carry heat.");
  }
  outcome.remarks.push_back(
      "By symmetry each of the two planes between the slabs passes half of the heat; the fluxes "
      "are "
      "means of both.");
  return outcome;
}

}  // namespace

const Experiment soleymani_2020_figures_5_6{
    .name = "soleymani-2020-figures-5-6",
    .source = "So20 Fig. 5, 6",
    .title = "What carries the heat through a plane",
    .question =
        "Soleymani et al. split the heat flux through a plane between two slabs into what pairs "
        "conduct and what particles carry as internal, kinetic and potential energy, from the hot "
        "and from the cold side, and find that the sum is the imposed flux. Here without and with "
        "repulsion, for conductions from none to one that outweighs diffusion, by the paper's "
        "scheme and by shardlow-s1; the work of the pair forces, which the paper's scheme does not "
        "pass, is measured too.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
