#include <fmt/format.h>

#include <array>
#include <cmath>

#include "experiments/judge/isolated_runs.hpp"
#include "experiments/reproduce/entropy_rows.hpp"
#include "experiments/reproduce/experiments.hpp"
#include "experiments/scene_keys.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr std::size_t species_count = 3;
constexpr double settle = 10;  ///< before averages, longer than velocities take to forget
constexpr double resolution = 0.02;

const MethodChoice published{"marsh-coveney", {}};

judge::Candidate candidate(const Conditions& conditions) {
  return {conditions.method_or(published)};
}

/// Each half of the one before, as the extrapolation has the last two.
const std::array<double, 3>& steps() {
  static const std::array<double, 3> all = {0.02, 0.01, 0.005};
  return all;
}

enum class Kind { isothermal, energy_conserving };
constexpr std::array<Kind, 2> kinds = {Kind::isothermal, Kind::energy_conserving};

struct Size {
  std::size_t particles;
  unsigned replicas;
  double duration;
};

Size size_of(Effort effort) {
  if (effort == Effort::quick) return {300, 16, 110};
  return {1500, 20, 410};
}

Scene scene_of(Kind kind, std::size_t particles) {
  Scene scene = find_preset("marsh-coveney-1998-mixture")->scene;
  scene.particles = particles;
  if (kind == Kind::isothermal) {
    auto& f = scene.fluid;
    f.isothermal = true;
    f.heat_form = HeatForm::none;
    f.conduction = 0;
    for (auto& pair : f.pairs) pair.conduction.reset();
    scene.initial_state = InitialState::canonical;
  }
  return scene;
}

/// Kinetic temperature of each species, then 1/theta averaged over its particles and those of all.
using Temperatures = std::array<double, 2 * species_count + 1>;

Temperatures temperatures(const System& system) {
  const auto& state = system.state();
  double mass = 0;
  for (std::size_t i = 0; i < system.size(); ++i) mass += system.mass(i);
  std::array<double, species_count> kinetic{}, degrees{}, inverse{}, count{};
  for (std::size_t i = 0; i < system.size(); ++i) {
    const auto species = state.species_of(i);
    kinetic[species] += system.mass(i) * state.velocity[i].squaredNorm();
    degrees[species] += 3 * (1 - system.mass(i) / mass);
    count[species] += 1;
    if (system.fluid().isothermal()) continue;
    inverse[species] += 1 / system.equation_of_state(i).temperature(state.internal_energy[i]);
  }
  Temperatures found{};
  for (std::size_t s = 0; s < species_count; ++s) {
    found[s] = kinetic[s] / (degrees[s] * system.fluid().boltzmann());
    found[species_count + s] = inverse[s] / count[s];
    found.back() += inverse[s] / static_cast<double>(system.size());
  }
  return found;
}

/// Means over one run: {"means"}, or {"failure"} in words.
json run(Kind kind, double step, unsigned replica, const Conditions& conditions) {
  const Size size = size_of(conditions.effort);
  // One replica more than are used: the last one starts off equilibrium.
  const auto& prepared =
      judge::prepared_once(scene_of(kind, size.particles), conditions.seed, size.replicas + 1);
  const auto stride = static_cast<std::uint64_t>(std::lround(0.1 / step));
  const auto count = static_cast<std::uint64_t>(std::llround(size.duration / step));
  Temperatures sums{};
  double samples = 0;
  const auto failure = judge::run_isolated(candidate(conditions), prepared, replica, Vector::Zero(),
                                           step, count, stride, [&](System& system, double time) {
                                             if (time < settle) return;
                                             const auto found = temperatures(system);
                                             for (std::size_t n = 0; n < sums.size(); ++n)
                                               sums[n] += found[n];
                                             ++samples;
                                           });
  if (failure) {
    return {{"failure", fmt::format("{} at t = {:.3g}", to_string(failure->cause), failure->time)}};
  }
  for (double& sum : sums) sum /= samples;
  return {{"means", sums}};
}

std::string name_of(Kind kind) {
  return kind == Kind::isothermal ? "isothermal fluid" : "energy-conserving fluid";
}

std::string part_name(Kind kind, double step, unsigned replica) {
  return fmt::format("{}, step {:g}, replica {}", name_of(kind), step, replica);
}

std::vector<Part> parts(const Conditions& conditions) {
  const Size size = size_of(conditions.effort);
  std::vector<Part> all;
  for (const Kind kind : kinds) {
    for (const double step : steps()) {
      for (unsigned replica = 0; replica < size.replicas; ++replica) {
        const double visits = static_cast<double>(size.particles) * size.duration / step;
        all.push_back({part_name(kind, step, replica), 3.5e-7 * visits, false,
                       [=](const Workplace&) { return run(kind, step, replica, conditions); }});
      }
    }
  }
  add_entropy_parts(
      candidate(conditions),
      [](const judge::PairCase& asked) { return asked.bench.fluid.species() > 1; }, conditions,
      all);
  return all;
}

/// What is compared: a name, and a number of a run's means that is 1 in the model.
struct Quantity {
  std::string name;
  std::function<double(const Temperatures&)> ratio;
};

std::vector<Quantity> quantities(Kind kind) {
  std::vector<Quantity> all;
  for (std::size_t s = 0; s < species_count; ++s) {
    if (kind == Kind::isothermal) {
      all.push_back({fmt::format("T_kin/T of species {}", s),
                     [=](const Temperatures& means) { return means[s]; }});
      continue;
    }
    all.push_back({fmt::format("T_kin of species {} over T_int of all", s),
                   [=](const Temperatures& means) { return means[s] * means.back(); }});
  }
  for (std::size_t s = 0; s < species_count && kind == Kind::energy_conserving; ++s) {
    all.push_back(
        {fmt::format("T_int of species {} over that of all", s),
         [=](const Temperatures& means) { return means.back() / means[species_count + s]; }});
  }
  return all;
}

/// Replicas of one kind at one step.
Interval measured(const Conditions& conditions, const Records& records, Kind kind, double step,
                  const Quantity& quantity) {
  std::vector<Eigen::VectorXd> values;
  for (unsigned n = 0; n < size_of(conditions.effort).replicas; ++n) {
    const auto& record = records.at(part_name(kind, step, n));
    if (!record.contains("means")) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      return {none, none, none};
    }
    const double ratio = quantity.ratio(record["means"].get<Temperatures>());
    values.push_back(Eigen::VectorXd::Constant(1, ratio));
  }
  return interval_of(estimate_mean(values));
}

/// At the step zero, on the line through the values at the two smallest steps.
Interval at_vanishing_steps(const std::vector<Interval>& values) {
  const auto& larger = values[1];
  const auto& smaller = values[2];
  const double value = 2 * smaller.value - larger.value;
  const double margin = std::hypot(smaller.high - smaller.low, (larger.high - larger.low) / 2);
  return {value, value - margin, value + margin};
}

Row row_of(const judge::Candidate& candidate, Kind kind, const std::string& quantity,
           const std::string& setting, const Interval& ours) {
  Row row;
  row.quantity = quantity;
  row.setting = fmt::format("{}, {}, {}", candidate.name(), name_of(kind), setting);
  row.unit = "1";
  row.ours = ours;
  return row;
}

/// The paper speaks of the model, that is of vanishing steps.
Row limit_row(const judge::Candidate& candidate, Kind kind, const std::string& quantity,
              const Interval& ours) {
  Row row = row_of(candidate, kind, quantity, "at vanishing steps", ours);
  row.paper = {1, 1, 1};
  row.paper_text = kind == Kind::isothermal ? "every species has the temperature of the bath"
                                            : "one temperature of all species";
  row.verdict = compare(ours, *row.paper, resolution);
  row.explanation = "Extrapolated in a straight line from the two smaller steps.";
  const Fluid fluid(scene_of(kind, 1).fluid);
  if (!is_consistent(candidate.method(), candidate.choice.options, fluid)) {
    row.explanation += " By the method's own claim its limit is another model.";
  }
  return row;
}

void conclude_fluid(Kind kind, const Conditions& conditions, const Records& records,
                    Outcome& outcome) {
  const auto method = candidate(conditions);
  judge::Chart chart{"temperatures of the species", {"time step"}, {"over what it should be"}, {}};
  for (const auto& quantity : quantities(kind)) {
    judge::Series series{quantity.name, {}};
    std::vector<Interval> values;
    for (const double step : steps()) {
      values.push_back(measured(conditions, records, kind, step, quantity));
      const auto& ours = values.back();
      Row row = row_of(method, kind, quantity.name, fmt::format("step {:g}", step), ours);
      if (same(method.choice, published)) {
        row.explanation = "The explicit step is wrong in proportion to it.";
      }
      outcome.rows.push_back(row);
      if (std::isfinite(ours.value)) {
        series.points.push_back({step, ours.value, ours.low, ours.high});
      }
    }
    outcome.rows.push_back(limit_row(method, kind, quantity.name, at_vanishing_steps(values)));
    chart.series.push_back(std::move(series));
  }
  const judge::Point from{0, 1, {}, {}}, to{steps().front(), 1, {}, {}};
  chart.series.push_back({"the model", {from, to}, judge::Marks::line});
  outcome.pictures.push_back(
      {fmt::format("Three species, {}: temperatures by step", name_of(kind)),
       "Of each species; 1 is the temperature of the bath, or the internal one of all particles.",
       std::move(chart),
       {}});
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  for (const Kind kind : kinds) conclude_fluid(kind, conditions, records, outcome);
  conclude_entropy(candidate(conditions), records, outcome);
  const Size size = size_of(conditions.effort);
  outcome.remarks = {
      fmt::format("Masses 1, 4 and 0.5, heat capacities 60, 100 and 30 k; friction 4.5 (pairs 0, "
                  "0), 6 (0, 1), 3 (0, 2), 9 (1, 1), 4 (1, 2), 2 (2, 2), and of conduction 30, 20, "
                  "40, 60, 10 and 15. {} particles of density 3, 40, 30 and 30 % of the species, "
                  "without repulsion; {} runs of {:g} units of time at each step.",
                  size.particles, size.replicas, size.duration),
      "The paper gives conditions for the coefficients and no simulation of several species: its "
      "statement is that fluctuation and dissipation in balance for every pair of species lead "
      "all of them to one temperature, and that F[P] falls."};
  return outcome;
}

std::optional<std::string> unsuited(const MethodChoice& method) {
  std::vector<FluidParameters> fluids;
  for (const Kind kind : kinds) fluids.push_back(scene_of(kind, 1).fluid);
  return first_refusal(method, fluids);
}

}  // namespace

const Experiment marsh_coveney_species{
    .name = "marsh-coveney-1998-species",
    .source = "MC98 III",
    .title = "Several species with coefficients of their own have one temperature",
    .question =
        "Section III has friction and noise of every pair of species balance by themselves: "
        "sigma^2 = 2 k T gamma in the isothermal model, (1/theta_i + 1/theta_j) in the place of "
        "1/T in the energy-conserving one. A fluid of three species of unlike masses, heat "
        "capacities and coefficients for every pair is run by the paper's scheme at three steps "
        "from starts in the exact law: the kinetic temperature of each species is that of the "
        "bath, or the internal temperature of all, and the internal temperatures agree. And F[P] = "
        "<H> + k T <ln P> of isothermal pairs of two species (mass ratio 4), which start in a "
        "narrow cloud far from equilibrium, may only fall.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
