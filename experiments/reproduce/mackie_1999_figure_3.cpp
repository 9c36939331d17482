#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/mackie_box.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr std::size_t particles = 30000;
constexpr double time_step = 0.01, duration = 120, sample_every = 0.1;
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double fit_from = 20, fit_to = 70;
constexpr double start_temperature = 1;
constexpr WallRepulsion repulsion = mackie_repulsion;

struct Run {
  MethodChoice method;
  int walled_axes;
  unsigned replicas;
  double contact = 1;  ///< the walls' conduction over that of two particles

  std::string name() const {
    const auto weaker = contact == 1 ? "" : fmt::format(", conduction {:g}", contact);
    return fmt::format("{}, walls on {} faces{}", to_string(method), 2 * walled_axes, weaker);
  }
  std::string part(unsigned replica) const { return fmt::format("{}, run {}", name(), replica); }
};

/// Three kinds of walls under the paper's method, then the first of them under others.
std::vector<Run> runs_of(const Conditions& conditions) {
  const unsigned replicas = conditions.effort == Effort::full ? 8 : 2;
  const auto methods = conditions.methods_or(mackie_explicit, {{"shardlow-s1", {}}});
  std::vector<Run> runs = {{methods[0], 3, replicas}, {methods[0], 1, 2}, {methods[0], 3, 2, 0.1}};
  for (std::size_t n = 1; n < methods.size(); ++n) runs.push_back({methods[n], 3, 2});
  return runs;
}

json run(const Run& run, std::uint64_t seed, unsigned replica, const Workplace& workplace) {
  const auto fluid = mackie_parameters(mackie_liquid);
  Wall wall = mackie_reservoir(fluid, mackie_temperature, repulsion);
  wall.conduction *= run.contact;
  const Box box = mackie_cube(particles, wall, run.walled_axes);
  const Noise noise(seed, replica);
  const double inset = wall_layer(repulsion, fluid.boltzmann, mackie_temperature).excluded;
  System system(Fluid(fluid), box,
                mackie_at_rest(fluid, box, particles, start_temperature, inset, noise), noise);
  BoxSeries series(time_step);
  const auto every = static_cast<std::uint64_t>(std::llround(sample_every / time_step));
  run_box(system, run.method, time_step, duration, {{"series", &series, every, 0}}, workplace);
  const auto all = series.to_json();
  json record;
  for (const char* name : {"time", "kinetic", "internal", "inverse"}) record[name] = all[name];
  return record;
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& asked : runs_of(conditions)) {
    for (unsigned replica = 0; replica < asked.replicas; ++replica) {
      all.push_back({asked.part(replica), 3.2e-7 * particles * duration / time_step, false,
                     [asked, replica, seed = conditions.seed](const Workplace& workplace) {
                       return run(asked, seed, replica, workplace);
                     }});
    }
  }
  return all;
}

/// The runs of one kind: their temperatures over time.
class Courses {
 public:
  Courses(const Run& run, const Records& records) {
    for (unsigned replica = 0; replica < run.replicas; ++replica) {
      const json& record = records.at(run.part(replica));
      times_ = column_from(record, "time");
      const double boltzmann = mackie_parameters(mackie_liquid).boltzmann;
      kinetic_.push_back(column_from(record, "kinetic") / (1.5 * particles * boltzmann));
      mean_.push_back(column_from(record, "internal") * mackie_liquid.B / boltzmann / particles);
      internal_.push_back(column_from(record, "inverse").cwiseInverse());
    }
  }
  using Series = std::vector<Eigen::VectorXd>;
  const Eigen::VectorXd& times() const { return times_; }
  const Series& kinetic() const { return kinetic_; }    ///< 2K/(3 N k)
  const Series& mean() const { return mean_; }          ///< <theta>
  const Series& internal() const { return internal_; }  ///< 1/<1/theta>

  /// A number of every run: mean, with the interval of their scatter; no numbers if a run has none.
  template <class Number>
  Interval across(const Series& series, Number&& number) const {
    std::vector<Eigen::VectorXd> values;
    for (const auto& one : series) {
      values.push_back(Eigen::VectorXd::Constant(1, number(one)));
      if (!std::isfinite(values.back()[0])) return {none, none, none};
    }
    return interval_of(estimate_mean(values));
  }
  Interval least(const Series& series) const {
    return across(series, [](const Eigen::VectorXd& one) { return one.minCoeff(); });
  }
  Interval time_of_least(const Series& series) const {
    return across(series, [&](const Eigen::VectorXd& one) {
      Eigen::Index at = 0;
      one.minCoeff(&at);
      return times_[at];
    });
  }
  /// From when on a temperature is above a level for good.
  Interval time_above(const Series& series, double level) const {
    return across(series, [&](const Eigen::VectorXd& one) {
      Eigen::Index at = one.size() - 1;
      if (one[at] < level) return none;
      while (at > 0 && one[at - 1] >= level) --at;
      return times_[at];
    });
  }
  Interval at(const Series& series, double time) const {
    const auto index = static_cast<Eigen::Index>(std::llround(time / sample_every));
    return across(series, [&](const Eigen::VectorXd& one) { return one[index]; });
  }
  /// Time constant of the approach to a limit, by a straight line through the logarithm of what is
  /// missing.
  Interval time_constant(const Series& series, double limit) const {
    return across(series, [&](const Eigen::VectorXd& one) {
      const auto from = static_cast<Eigen::Index>(std::llround(fit_from / sample_every));
      const auto to = static_cast<Eigen::Index>(std::llround(fit_to / sample_every));
      const Eigen::ArrayXd t = times_.segment(from, to - from);
      const Eigen::ArrayXd missing = (limit - one.segment(from, to - from).array()).log();
      const Eigen::ArrayXd about = t - t.mean();
      return -about.square().sum() / (about * (missing - missing.mean())).sum();
    });
  }

 private:
  Eigen::VectorXd times_;
  Series kinetic_, mean_, internal_;
};

/// <theta> = u/phi of an isolated box in which the internal energies have given 3/2 k T a particle.
double mixed_temperature() {
  const double B = mackie_liquid.B;
  return start_temperature * (1 - 1.5 * B / (1 + 2.5 * B));
}

/// Time constant of the slowest wave of temperature between so many walls [MAN 3.28, AM99 4.3].
double slowest_wave(int walled_axes) {
  const auto fluid = mackie_parameters(mackie_liquid);
  const auto bulk = mackie_bulk(particles, repulsion, walled_axes);
  const double heat_capacity = bulk.density * (fluid.heat_capacity + 2.5 * fluid.boltzmann);
  const double wavenumber = std::numbers::pi / bulk.side;
  return heat_capacity /
         (mackie_conductivity(bulk.density) * walled_axes * wavenumber * wavenumber);
}

void add_rows(Outcome& outcome, const Run& run, const Courses& courses) {
  const auto add = [&](const char* quantity, const Interval& ours, std::optional<Interval> paper,
                       double resolution, std::string explanation) {
    Row row = mackie_row(quantity, run.name(), "T_R", ours);
    row.explanation = std::move(explanation);
    if (paper) {
      row.paper = paper;
      row.verdict = compare(ours, *paper, resolution);
    }
    outcome.rows.push_back(row);
  };
  const bool six = run.walled_axes == 3;
  add("least internal temperature <theta>", courses.least(courses.mean()),
      Interval{0.98, 0.97, 0.99}, 0.01,
      fmt::format(
          "Without walls it would go down to {:.4f} and stay; the paper's \"about 0.98\" is "
          "taken as +- 0.01.",
          mixed_temperature()));
  add("least internal temperature 1/<1/theta>", courses.least(courses.internal()),
      Interval{0.98, 0.97, 0.99}, 0.01,
      fmt::format("Without walls it would go down to {:.4f}: the spread of the internal energies, "
                  "which start alike, lowers it further than <theta>.",
                  1 / (1 + 2.5 * mackie_liquid.B)));
  add("time of the least 1/<1/theta>", courses.time_of_least(courses.internal()),
      Interval{1, 0.2, 5}, 0.5, "\"t* about 1\", on a course over decades, is taken as 0.2 to 5.");
  outcome.rows.back().unit = "t*";
  add("time to stay within 1 % of 1.1",
      courses.time_above(courses.internal(), 0.99 * mackie_temperature), Interval{100, 50, 200},
      0.5,
      six ? "\"t* about 100\" is taken as 50 to 200."
          : "Between two walls alone the fluid is far from warm by then.");
  outcome.rows.back().unit = "t*";
  add("time constant of the warming", courses.time_constant(courses.internal(), mackie_temperature),
      std::nullopt, 0,
      fmt::format("From t* = {:g} to {:g}. The slowest wave of temperature, with the conductivity "
                  "of MAN 3.28, has {:.1f}.",
                  fit_from, fit_to, slowest_wave(run.walled_axes)));
  outcome.rows.back().unit = "t*";
  add(
      "kinetic less internal temperature at t* = 100",
      [&] {
        auto difference = courses.kinetic();
        for (std::size_t n = 0; n < difference.size(); ++n) difference[n] -= courses.internal()[n];
        return courses.at(difference, 100);
      }(),
      std::nullopt, 0, "");
}

judge::Series line(const std::string& name, const Courses& courses, const Courses::Series& series,
                   double until) {
  judge::Series result{name, {}, judge::Marks::line};
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(courses.times().size());
  for (const auto& one : series) mean += one / static_cast<double>(series.size());
  for (Eigen::Index n = 0; n < mean.size() && courses.times()[n] <= until; ++n) {
    result.points.push_back({courses.times()[n], mean[n], {}, {}});
  }
  return result;
}

std::vector<judge::Series> internal_lines(const std::vector<Run>& runs, const Records& records,
                                          double until) {
  const Courses six{runs[0], records}, two{runs[1], records}, weak{runs[2], records};
  return {line("internal, 1/<1/theta>", six, six.internal(), until),
          line("internal, <theta>", six, six.mean(), until),
          line("1/<1/theta>, walls on two faces", two, two.internal(), until),
          line("1/<1/theta>, weaker contact", weak, weak.internal(), until)};
}

Picture whole_course(const std::vector<Run>& runs, const Records& records) {
  const char* const title = "MAN Fig. 3: cooling, then warming by the walls";
  const Courses six{runs[0], records};
  judge::Chart chart{title, {"t*"}, {"T*"}, internal_lines(runs, records, duration)};
  chart.series.insert(chart.series.begin(), line("kinetic", six, six.kinetic(), duration));
  return {title, "Means over the runs; kinetic temperatures start at 0.", std::move(chart), {}};
}

Picture cooling(const std::vector<Run>& runs, const Records& records) {
  const char* const title = "MAN Fig. 3: the cooling";
  judge::Chart chart{title, {"t*"}, {"T*"}, internal_lines(runs, records, 8)};
  return {title, "Means over the runs; all start at 1.", std::move(chart), {}};
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  const auto runs = runs_of(conditions);
  for (const auto& run : runs) add_rows(outcome, run, {run, records});
  outcome.pictures = {whole_course(runs, records), cooling(runs, records)};
  outcome.remarks = {
      "The size of the paper's run is taken to be that of its Fig. 1 and 2, 30000 particles. "
      "Neither how many faces are walls nor how strongly these conduct is known to us. Walls that "
      "conduct as two particles do begin to warm the fluid at once, within their own range: on all "
      "six faces this hides the cooling, on two it takes several hundred t* to warm the fluid. A "
      "weaker contact on six faces cools deeper and warms in time.",
      fmt::format("Walls repel with a range of {:g} and a strength of {:g}; they exchange friction "
                  "as two particles do.",
                  repulsion.range, repulsion.strength)};
  return outcome;
}

}  // namespace

const Experiment mackie_1999_figure_3{
    .name = "mackie-1999-figure-3",
    .source = "MAN Fig. 3",
    .title = "A fluid at rest cools itself, then the walls warm it",
    .question =
        "30000 particles at rest, all at the particle temperature 1, between walls at T* = 1.1 (C "
        "= 17, B = 0.01, r* = 1.24, step 0.01): friction's noise takes the kinetic energy 3/2 kT "
        "out of the internal energies, which cools them to about 0.98 at t* about 1; conduction "
        "from the walls then warms the fluid to 1.1 at t* about 100. Least temperatures, their "
        "times, the time constant of the warming, and both temperatures over time.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = liquid_unsuited};

}  // namespace driftless::reproduce
