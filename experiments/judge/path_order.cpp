#include "experiments/judge/path_order.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "experiments/judge/observed_order.hpp"
#include "experiments/judge/path_fluid.hpp"
#include "experiments/judge/path_records.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

// Every step is compared with its half; the smallest step is of two cells, so that methods that cut
// a step in halves see the same path.
constexpr double duration = 1, largest_step = 1.0 / 8;
constexpr unsigned halvings = 4;

/// What is noted of a step against its half.
enum Column { momenta, energies, kinetic, variance, columns };

double step_of(unsigned halving) { return std::ldexp(largest_step, -static_cast<int>(halving)); }

PathRun path_run(const Conditions& conditions, unsigned halving, std::uint64_t replica) {
  PathRun run;
  run.start = PathStart::off;
  run.step = step_of(halving);
  run.cells = 2U << (halvings - halving);
  run.steps = static_cast<std::uint64_t>(std::lround(duration / run.step));
  run.interval = run.steps;
  run.seed = conditions.seed;
  run.replica = replica;
  return run;
}

/// Squared distances in thermal units, means over particles, and differences of averages.
std::array<double, columns> compare(const Fluid& fluid, const State& coarse, const State& fine) {
  double velocity = 0, energy = 0;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    velocity += (coarse.velocity[i] - fine.velocity[i]).squaredNorm();
    energy += std::pow(coarse.internal_energy[i] - fine.internal_energy[i], 2);
  }
  const auto& f = fluid.parameters();
  const auto count = static_cast<double>(coarse.size());
  const double thermal_energy = f.boltzmann * f.temperature;
  return {velocity * f.mass / (3 * thermal_energy) / count,
          energy / (f.heat_capacity * f.temperature * thermal_energy) / count,
          kinetic_energy_of(fluid, coarse) - kinetic_energy_of(fluid, fine),
          energy_variance_of(fluid, coarse) - energy_variance_of(fluid, fine)};
}

/// One replica at all steps: the columns of every step against its half.
std::vector<double> row(const PathFluid& fluid, const Candidate& candidate,
                        const Conditions& conditions, std::uint64_t replica) {
  std::vector<double> values;
  State coarse;
  for (unsigned halving = 0; halving <= halvings; ++halving) {
    auto fine = run_on_path(fluid, candidate, path_run(conditions, halving, replica)).back();
    if (halving > 0) {
      for (const double value : compare(fluid.fluid(), coarse, fine)) values.push_back(value);
    }
    coarse = std::move(fine);
  }
  return values;
}

std::string part_name(const PathFluid& fluid, unsigned share) {
  return fmt::format("one path, {}, {}", fluid.name(), share);
}

unsigned shares(const Conditions& conditions) { return conditions.depth == Depth::quick ? 1 : 20; }

/// The mean of a column at every step.
std::vector<Deviation> deviations(const PathRecords& records, Column column) {
  std::vector<Deviation> all;
  for (unsigned halving = 0; halving < halvings; ++halving) {
    const auto found = records.mean(columns * halving + column);
    all.push_back({step_of(halving), found.mean, found.error});
  }
  return all;
}

/// Root mean square distances.
std::vector<Deviation> distances(const PathRecords& records, Column column) {
  auto all = deviations(records, column);
  for (auto& one : all) {
    one.value = std::sqrt(one.value);
    one.error /= 2 * one.value;
  }
  return all;
}

/// The slope of the logarithms of distances over the last steps by least squares, with an error
/// that knows that all steps see the same paths.
std::optional<OrderFit> distance_order(const PathRecords& records, Column column, unsigned last) {
  const auto slope = [=](const Eigen::VectorXd& means) {
    double sum = 0, squares = 0;
    for (unsigned n = 0; n < last; ++n) {
      const double x = 0.5 * (last - 1) - n;  // log2 of the step, from its mean
      sum += x * 0.5 * std::log2(means[columns * (halvings - last + n) + column]);
      squares += x * x;
    }
    return sum / squares;
  };
  const auto found = records.derived(slope);
  if (!found || !std::isfinite(found->error)) return std::nullopt;
  return OrderFit{found->mean, found->error, last};
}

Finding strong_finding(const std::string& subject, const std::string& what,
                       const PathRecords& records, Column column) {
  auto finding =
      reported_order({subject, "the distance of " + what + " from those at half the step",
                      distances(records, column), distance_order(records, column, halvings)});
  if (const auto end = distance_order(records, column, 2)) {
    finding.sentence += fmt::format(" At the smallest two it is {:.2f} +- {:.2f}.", end->order,
                                    interval_quantile * end->error);
  }
  return finding;
}

Finding no_strong_order(const std::string& subject) {
  return {subject, Verdict::not_applicable,
          "Uniform variates decide in a step, which no Wiener path fixes: there is no strong order "
          "to speak of."};
}

struct Question {
  Column column;
  std::string what;
};

void conclude_weak(const PathFluid& fluid, const PathRecords& records,
                   std::vector<Finding>& findings, Chart& chart) {
  for (const auto& question :
       {Question{kinetic, "kinetic energy"}, Question{variance, "variance of u"}}) {
    const auto all = deviations(records, question.column);
    const auto name = question.what + ", " + fluid.name();
    findings.push_back(
        reported_order({"finite time: " + name,
                        "the change of the mean " + question.what + " at half the step", all}));
    chart.series.push_back(order_series(name, all));
  }
}

void conclude_strong(const PathFluid& fluid, const PathRecords& records, bool has_path,
                     std::vector<Finding>& findings, Chart& chart) {
  for (const auto& question :
       {Question{momenta, "momenta"}, Question{energies, "internal energies"}}) {
    const auto name = question.what + ", " + fluid.name();
    const auto subject = "strong: " + name;
    findings.push_back(has_path ? strong_finding(subject, question.what, records, question.column)
                                : no_strong_order(subject));
    chart.series.push_back(order_series(name, distances(records, question.column)));
  }
}

}  // namespace

std::vector<Part> path_order_parts(const Candidate& candidate, const Conditions& conditions) {
  const unsigned replicas = conditions.depth == Depth::quick ? 1024 : 2048;
  std::vector<Part> parts;
  for (const auto& fluid : path_fluids(candidate)) {
    for (unsigned share = 0; share < shares(conditions); ++share) {
      parts.push_back({part_name(fluid, share), 0.003 * replicas, [=] {
                         return path_record(replicas, replicas * share, [=](std::uint64_t replica) {
                           return row(fluid, candidate, conditions, replica);
                         });
                       }});
    }
  }
  return parts;
}

void conclude_path_orders(const Candidate& candidate, const Conditions& conditions,
                          const Records& records, Conclusion& conclusion) {
  Chart weak{"Averages at the end of a run, a step against its half, on the same path",
             {"step, units of time", true},
             {"difference, thermal units", true},
             {}};
  Chart strong{"Particles at the end of a run, a step against its half, on the same path",
               {"step, units of time", true},
               {"root mean square distance, thermal units", true},
               {}};
  for (const auto& fluid : path_fluids(candidate)) {
    PathRecords found;
    for (unsigned share = 0; share < shares(conditions); ++share) {
      found.add(records.at(part_name(fluid, share)));
    }
    if (found.too_many_failed()) {
      conclusion.findings.push_back(found.broken("one path, " + fluid.name()));
      continue;
    }
    conclude_weak(fluid, found, conclusion.findings, weak);
    conclude_strong(fluid, found, !draws_uniforms(candidate, fluid), conclusion.findings, strong);
  }
  conclusion.charts.push_back(std::move(weak));
  conclusion.charts.push_back(std::move(strong));
}

}  // namespace driftless::judge
