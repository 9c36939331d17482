#include <fmt/format.h>

#include <numbers>

#include "experiments/avalos_mackie_fluid.hpp"
#include "experiments/reproduce/estimates.hpp"
#include "experiments/reproduce/experiments.hpp"
#include "experiments/transport/ideal_runs.hpp"
#include "experiments/transport/theory.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// The range, and how wide the box is across the wave.
struct Case {
  double range, width, published;
  const char* name;
};
constexpr Case few_case = {am99::few, 5, 0.363, "n = 8"};
constexpr Case many_case = {am99::many, 6, 0.894, "n = 100"};

std::vector<double> wavelengths(const Case& which, Effort effort) {
  const bool quick = effort == Effort::quick;
  if (which.range == am99::few) {
    return quick ? std::vector<double>{4, 5, 6, 10, 20}
                 : std::vector<double>{4, 5, 6, 8, 10, 14, 20, 30, 45, 65};
  }
  return quick ? std::vector<double>{6, 10, 20} : std::vector<double>{6, 8, 10, 14, 20, 30};
}

/// Ranges between those of the paper, for the dependence on Z at one wavelength.
constexpr double common_wavelength = 10;
std::vector<double> ranges_between(Effort effort) {
  return effort == Effort::quick ? std::vector<double>{1.96}
                                 : std::vector<double>{1.56, 1.96, 2.3, 2.6};
}

FluidParameters fluid_of(double range) { return am99::fluid(range, 0); }
double scaling(double range) { return std::pow(range, 5); }
double mean_field(double range, double wavelength) {
  return transport::mean_field_viscosity(fluid_of(range), 1, 2 * pi / wavelength);
}
/// eta_diss + rho k T/(2 w_0).
double long_wave_limit(double range) { return mean_field(range, 1e4); }

double step_of(double range) {
  return std::min(0.1, 0.2 / transport::collision_rate(fluid_of(range), 1));
}

struct Plan {
  transport::IdealRun run;
  transport::WaveSchedule schedule;
  double seconds() const {
    const double pairs = 4 * pi / 6 * std::pow(run.fluid.friction_range, 3);
    return run.replicas * schedule.impositions * schedule.samples * schedule.stride *
           static_cast<double>(run.box.particles) * (1.2e-7 + 6e-8 * pairs);
  }
};

Plan plan_of(double range, double width, double wavelength, const Conditions& conditions) {
  const auto box = transport::fluid_box(wavelength, width, 1);
  Plan plan{{fluid_of(range), box}, {}};
  plan.run.method = conditions.method_or(plan.run.method);
  plan.run.seed = conditions.seed;
  plan.run.replicas = 10;
  auto& schedule = plan.schedule;
  schedule.step = step_of(range);
  const double k = 2 * pi / wavelength;
  const double window = 4.5 / (mean_field(range, wavelength) * k * k);
  schedule.samples = 80;
  schedule.stride = transport::stride_of(window, schedule.samples, schedule.step);
  // So many that the noise of a few thousand particles is left.
  const double particles = conditions.effort == Effort::quick ? 1.5e4 : 1.2e5;
  schedule.impositions = static_cast<unsigned>(
      std::max(1.0, particles / static_cast<double>(plan.run.replicas * box.particles)));
  return plan;
}

json measure(const Plan& plan, double wavelength) {
  // Friction and streaming are linear in transverse velocities, so that they need not be small.
  const transport::Waves waves{{0}, 1, 0.8, 0, 0};
  const auto records = transport::relax_replicas(plan.run, waves, plan.schedule);
  const double k = 2 * pi / wavelength;
  return to_json(transport::viscosity(records, k, plan.run.fluid, 1));
}

std::string name_of(double range, double wavelength) {
  return fmt::format("r* = {:g}, wavelength {:g}", range, wavelength);
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  const auto add = [&](double range, double width, double wavelength) {
    const Plan plan = plan_of(range, width, wavelength, conditions);
    all.push_back({name_of(range, wavelength), plan.seconds(), false,
                   [=](const Workplace&) { return measure(plan, wavelength); }});
  };
  for (const Case& which : {few_case, many_case}) {
    for (const double wavelength : wavelengths(which, conditions.effort)) {
      add(which.range, which.width, wavelength);
    }
  }
  for (const double range : ranges_between(conditions.effort)) add(range, 6, common_wavelength);
  return all;
}

std::optional<Estimate> found_at(const Records& records, double range, double wavelength) {
  const auto found = records.find(name_of(range, wavelength));
  return found == records.end() ? std::nullopt : read_estimate(found->second);
}

void wavelength_rows(const Case& which, const Conditions& conditions, const Records& records,
                     Outcome& outcome) {
  for (const double wavelength : wavelengths(which, conditions.effort)) {
    const auto found = found_at(records, which.range, wavelength);
    if (!found) continue;
    Row row;
    row.quantity = "viscosity eta*";
    row.setting =
        fmt::format("{}, r* = {:g}, at a wavelength of {:g}", which.name, which.range, wavelength);
    row.unit = "zeta_0/l";
    row.paper = Interval{which.published, which.published, which.published};
    row.ours = interval_of(*found);
    row.verdict = compare(row.ours, *row.paper, 0.1);
    row.explanation =
        fmt::format("mean field at this wavelength {:.3f}; of long waves {:.3f}",
                    mean_field(which.range, wavelength), long_wave_limit(which.range));
    outcome.rows.push_back(row);
  }
}

/// Where a curve of points crosses a level, linear in the logarithm; nothing if nowhere.
std::optional<double> crossing(const std::vector<std::pair<double, double>>& points, double level) {
  for (std::size_t n = 1; n < points.size(); ++n) {
    const auto& [x, y] = points[n - 1];
    const auto& [next_x, next_y] = points[n];
    if ((y - level) * (next_y - level) > 0 || y == next_y) continue;
    return x * std::pow(next_x / x, (level - y) / (next_y - y));
  }
  return {};
}

/// The wavelength at which ours is the paper's value.
void crossing_row(const Case& which, const Conditions& conditions, const Records& records,
                  Outcome& outcome) {
  std::vector<std::pair<double, double>> middle, low, high;
  for (const double wavelength : wavelengths(which, conditions.effort)) {
    const auto found = found_at(records, which.range, wavelength);
    if (!found) continue;
    const Interval one = interval_of(*found);
    middle.emplace_back(wavelength, one.value);
    low.emplace_back(wavelength, one.low);
    high.emplace_back(wavelength, one.high);
  }
  const auto at = crossing(middle, which.published);
  if (!at || middle.empty()) {
    outcome.remarks.push_back(
        fmt::format("{}: no wavelength that was run gives the published {:g}; the limit of long "
                    "waves is {:.3f} in the mean field.",
                    which.name, which.published, long_wave_limit(which.range)));
    return;
  }
  Row row;
  row.quantity = "wavelength at which the viscosity is the paper's";
  row.setting = which.name;
  row.unit = "l";
  row.paper_text = "the wavelength of a small box";
  row.ours = {*at, crossing(high, which.published).value_or(middle.front().first),
              crossing(low, which.published).value_or(middle.back().first)};
  row.explanation =
      fmt::format("a cubic box of this side holds {:.0f} particles", std::pow(*at, 3));
  outcome.rows.push_back(row);
}

/// The longest wave, carried on to infinite length by the mean field's ratio.
void limit_row(const Case& which, const Conditions& conditions, const Records& records,
               Outcome& outcome) {
  const double longest = wavelengths(which, conditions.effort).back();
  const auto found = found_at(records, which.range, longest);
  if (!found) return;
  const auto f = fluid_of(which.range);
  const double carried = 0.5 / (2 * transport::collision_rate(f, 1));
  const double factor = long_wave_limit(which.range) / mean_field(which.range, longest);
  Row row;
  row.quantity = "viscosity eta* of long waves";
  row.setting = fmt::format("{}, at a wavelength of {:g}, times the mean field's ratio {:.3f}",
                            which.name, longest, factor);
  row.unit = "zeta_0/l";
  const double theory = transport::dissipative_viscosity(f, 1) + carried;
  row.ours = interval_of(scaled(*found, factor));
  put_theory(row, theory, "2 pi r*^5/1575 + rho k T/(2 w_0)", 0.2);
  row.explanation = fmt::format(
      "friction {:.4f}, carried momentum {:.4f}; the paper gives {:g}. Friction's share is that of "
      "a uniform gradient: the network of particles where chance puts them has less",
      transport::dissipative_viscosity(f, 1), carried, which.published);
  outcome.rows.push_back(row);
}

judge::Chart against_wavelength(const Conditions& conditions, const Records& records) {
  judge::Chart chart{
      "Viscosity against wavelength", {"wavelength/l", true}, {"viscosity eta*", false}, {}};
  for (const Case& which : {few_case, many_case}) {
    judge::Series ours{which.name, {}, judge::Marks::points};
    for (const double wavelength : wavelengths(which, conditions.effort)) {
      const auto found = found_at(records, which.range, wavelength);
      if (found) ours.points.push_back(point(wavelength, *found));
    }
    chart.series.push_back(ours);
    const std::string name = which.name;
    chart.series.push_back(line(name + ", mean field", 4, 100, [&](double wavelength) {
      return mean_field(which.range, wavelength);
    }));
    chart.series.push_back(
        line(name + ", the paper's value", 4, 100, [&](double) { return which.published; }));
  }
  return chart;
}

judge::Chart against_scaling(const Conditions& conditions, const Records& records) {
  judge::Chart chart{
      "AM99 Fig. 3: viscosity against Z", {"Z = rho*^2 r*^5", true}, {"viscosity eta*", true}, {}};
  judge::Series ours{"at a wavelength of 10", {}, judge::Marks::points};
  auto ranges = ranges_between(conditions.effort);
  ranges.insert(ranges.begin(), am99::few);
  ranges.push_back(am99::many);
  for (const double range : ranges) {
    const auto found = found_at(records, range, common_wavelength);
    if (found) ours.points.push_back(point(scaling(range), *found));
  }
  chart.series.push_back(ours);
  const double from = scaling(am99::few), to = scaling(am99::many);
  const auto range_of = [](double z) { return std::pow(z, 0.2); };
  chart.series.push_back(line("mean field at a wavelength of 10", from, to, [&](double z) {
    return mean_field(range_of(z), common_wavelength);
  }));
  chart.series.push_back(line("mean field of long waves", from, to,
                              [&](double z) { return long_wave_limit(range_of(z)); }));
  chart.series.push_back(line("2 pi Z/1575", from, to, [](double z) { return 2 * pi * z / 1575; }));
  judge::Series paper{"the paper", {}, judge::Marks::points};
  for (const Case& which : {few_case, many_case}) {
    paper.points.push_back({scaling(which.range), which.published, {}, {}});
  }
  chart.series.push_back(paper);
  return chart;
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  for (const Case& which : {few_case, many_case}) {
    crossing_row(which, conditions, records, outcome);
    limit_row(which, conditions, records, outcome);
    wavelength_rows(which, conditions, records, outcome);
  }
  outcome.pictures.push_back(
      {"AM99 Fig. 3: viscosity against Z",
       "Z is taken as the scaling of what friction transports over its range.",
       against_scaling(conditions, records),
       {}});
  outcome.pictures.push_back({"Viscosity against wavelength",
                              "With few neighbours a particle flies further than a small box.",
                              against_wavelength(conditions, records),
                              {}});
  outcome.remarks.insert(
      outcome.remarks.begin(),
      fmt::format("rho* = T* = 1, no conduction (it does not change the viscosity), B = 0.01, "
                  "method {} at a step of 0.1 and at most a fifth of the collision time: ours. Z "
                  "= rho*^2 r*^5 is ours too. The viscosity is rho m/(k^2 int C dt) of the imposed "
                  "velocity wave C.",
                  to_string(conditions.method_or(transport::IdealRun().method))));
  return outcome;
}

}  // namespace

const Experiment avalos_mackie_1999_viscosity = {
    .name = "avalos-mackie-1999-viscosity",
    .source = "AM99 Fig. 3",
    .title = "Viscosity of the ideal fluid, and the wavelength at which it is read",
    .question =
        "The paper gives eta* = 0.363 with 8 particles within the range and 0.894 with 100. "
        "Transverse "
        "velocity waves of 0.8 thermal velocities are imposed along the long side of a box and "
        "left to decay, at several wavelengths: at which one are the paper's values found, and "
        "what is the limit of long waves? Beside them the mean field at each wavelength, which "
        "tends to 2 pi rho^2 zeta_0 r^5/1575 + rho k T/(2 w_0).",
    .parts = parts,
    .conclude = conclude,
    .unsuited = [](const MethodChoice& method) {
      return first_refusal(method, {fluid_of(am99::many)});
    }};

}  // namespace driftless::reproduce
