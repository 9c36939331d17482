#include <fmt/format.h>

#include <array>
#include <cmath>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/path_fluid.hpp"
#include "experiments/judge/path_records.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double step = 1.0 / 16;
constexpr unsigned cells = 4;  // of a step: its half can still be cut in two
constexpr std::uint64_t samples_a_unit = 4;
constexpr std::array<unsigned, 4> durations = {1, 2, 4, 8};
const MethodChoice partner{"shardlow-s2", {}};

/// Observables, averaged over the run so far.
enum Observable { kinetic, variance, observables };

std::string words(Observable observable) {
  return observable == kinetic ? "kinetic energy" : "variance of u";
}

/// The three runs of a replica.
enum Run { own, half_step, other_method, runs };

/// The column of a run's average.
Eigen::Index column(Run run, std::size_t duration, Observable observable) {
  return static_cast<Eigen::Index>((run * durations.size() + duration) * observables + observable);
}

/// Averages over the durations.
void append_averages(const PathFluid& fluid, const Candidate& candidate, const PathRun& run,
                     std::vector<double>& row) {
  const auto states = run_on_path(fluid, candidate, run);
  std::array<double, observables> sums = {};
  std::size_t taken = 0;
  for (const unsigned duration : durations) {
    for (; taken < duration * samples_a_unit; ++taken) {
      sums[kinetic] += kinetic_energy_of(fluid.fluid(), states[taken]);
      sums[variance] += energy_variance_of(fluid.fluid(), states[taken]);
    }
    for (const double sum : sums) row.push_back(sum / static_cast<double>(taken));
  }
}

bool has_partner(const Candidate& candidate) { return candidate.choice.name != partner.name; }

/// Averages of all runs of a replica.
std::vector<double> row(const PathFluid& fluid, const Candidate& candidate, std::uint64_t seed,
                        std::uint64_t replica) {
  const auto halves = [&](unsigned parts) {
    return PathRun{PathStart::exact,
                   step / parts,
                   cells / parts,
                   durations.back() * 16 * parts,
                   16 / samples_a_unit * parts,
                   seed,
                   replica};
  };
  std::vector<double> values;
  append_averages(fluid, candidate, halves(1), values);
  append_averages(fluid, candidate, halves(2), values);
  append_averages(fluid, has_partner(candidate) ? Candidate{partner} : candidate, halves(1),
                  values);
  return values;
}

/// ln of the ratio of standard errors of a difference, of independent runs to runs on one path.
/// Independent runs have the sum of the two variances.
std::optional<Estimate> log_factor(const PathRecords& records, Run run, std::size_t duration,
                                   Observable observable) {
  const auto one = column(own, duration, observable), two = column(run, duration, observable);
  const double mean_one = records.mean(one).mean, mean_two = records.mean(two).mean;
  const auto squares = records.transformed([=](const Eigen::RowVectorXd& row) {
    const double a = row[one] - mean_one, b = row[two] - mean_two;
    Eigen::RowVectorXd apart(2);
    apart << a * a + b * b, (a - b) * (a - b);
    return apart;
  });
  return squares.derived(
      [](const Eigen::VectorXd& means) { return 0.5 * std::log(means[0] / means[1]); });
}

struct Comparison {
  Run run;
  std::string words;
};

std::vector<Comparison> comparisons(const Candidate& candidate) {
  std::vector<Comparison> all = {{half_step, "step against half step"}};
  if (has_partner(candidate)) all.push_back({other_method, "against " + partner.name});
  return all;
}

Finding finding(const std::string& subject, const Comparison& comparison, unsigned duration,
                Observable observable, const std::optional<Estimate>& log_factor) {
  Finding found;
  found.subject = subject;
  if (!log_factor || !std::isfinite(log_factor->error)) {
    found.verdict = Verdict::not_resolved;
    found.sentence = "The runs say nothing of the factor.";
    return found;
  }
  const double width = interval_quantile * log_factor->error;
  found.value = std::exp(log_factor->mean);
  found.lower = std::exp(log_factor->mean - width);
  found.upper = std::exp(log_factor->mean + width);
  found.sentence = fmt::format(
      "The error bar of the difference in the mean {} over {} units of time, {}, is smaller on one "
      "path than from independent runs by a factor of {:.3g} (95 % interval {:.3g} to {:.3g}).",
      words(observable), duration, comparison.words, *found.value, *found.lower, *found.upper);
  return found;
}

std::string part_name(const PathFluid& fluid, unsigned share) {
  return fmt::format("{}, {}", fluid.name(), share);
}
unsigned shares(const Conditions& conditions) { return conditions.depth == Depth::quick ? 1 : 20; }

/// With conduction alone: there the variance of u has a law of its own to relax to.
std::vector<PathFluid> fluids(const Candidate& candidate) {
  std::vector<PathFluid> all;
  for (const auto& fluid : path_fluids(candidate)) {
    if (fluid.conducts && !refusal(Candidate{partner}.method(), fluid.fluid())) {
      all.push_back(fluid);
    }
  }
  return all;
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  constexpr unsigned replicas = 512;
  std::vector<Part> all;
  for (const auto& fluid : fluids(candidate)) {
    for (unsigned share = 0; share < shares(conditions); ++share) {
      all.push_back({part_name(fluid, share), 0.005 * replicas, [=] {
                       return path_record(replicas, replicas * share, [=](std::uint64_t replica) {
                         return row(fluid, candidate, conditions.seed, replica);
                       });
                     }});
    }
  }
  return all;
}

/// Adds the findings of a fluid, and all durations to the chart.
void conclude_fluid(const Candidate& candidate, const PathFluid& fluid, const PathRecords& records,
                    std::vector<Finding>& findings, Chart& chart) {
  for (const auto& comparison : comparisons(candidate)) {
    for (const auto observable : {kinetic, variance}) {
      const auto name = fmt::format("{}, {}, closure {}", comparison.words, words(observable),
                                    to_string(fluid.closure));
      Series series{name, {}};
      for (std::size_t n = 0; n < durations.size(); ++n) {
        const auto factor = log_factor(records, comparison.run, n, observable);
        auto one = finding(fmt::format("{}, duration {}", name, durations[n]), comparison,
                           durations[n], observable, factor);
        if (one.value) {
          series.points.push_back(
              {static_cast<double>(durations[n]), *one.value, one.lower, one.upper});
        }
        const bool first_or_last = n == 0 || n + 1 == durations.size();
        if (first_or_last) findings.push_back(std::move(one));
      }
      chart.series.push_back(std::move(series));
    }
  }
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  Conclusion conclusion;
  Chart chart{"What one path is worth",
              {"duration of the averages, units of time", true},
              {"factor by which error bars shrink", true},
              {}};
  for (const auto& fluid : fluids(candidate)) {
    PathRecords found;
    for (unsigned share = 0; share < shares(conditions); ++share) {
      found.add(records.at(part_name(fluid, share)));
    }
    if (found.too_many_failed()) {
      conclusion.findings.push_back(found.broken(fluid.name()));
    } else {
      conclude_fluid(candidate, fluid, found, conclusion.findings, chart);
    }
  }
  if (conclusion.findings.empty()) {
    conclusion.findings.push_back(
        {"all fluids", Verdict::not_applicable, "No fluid suits both the method and its partner."});
  }
  if (!chart.series.empty()) conclusion.charts.push_back(std::move(chart));
  return conclusion;
}

}  // namespace

const Examination common_noise{
    "common-noise", "Differences by common noise",
    "How much sharper are differences between two runs on one Wiener path than between independent "
    "runs? 27 particles of an ideal conducting fluid run from the exact law, at the step 1/16 and "
    "at half of it, and by shardlow-s2 at the step 1/16, all from the same start with the same "
    "path. The variance of the difference between two runs' averages is set against the sum of "
    "their variances, which independent runs would have. Reported is the ratio of the error bars.",
    parts, conclude};

}  // namespace driftless::judge
