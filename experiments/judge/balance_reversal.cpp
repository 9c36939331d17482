#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/balance.hpp"
#include "experiments/judge/balance_runs.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double tolerance = 0.05;    ///< of a correlation that may go unseen where one "holds"
constexpr double most_failed = 0.01;  ///< of the copies; survivors of more are a selection

double z(const MeasuredVector& vector, Eigen::Index n) {
  return vector.error(n) > 0 ? vector.mean[n] / vector.error(n) : 0;
}

Eigen::Index clearest(const MeasuredVector& vector) {
  Eigen::Index best = 0;
  for (Eigen::Index n = 0; n < vector.mean.size(); ++n) {
    if (std::abs(z(vector, n)) > std::abs(z(vector, best))) best = n;
  }
  return best;
}

/// "0.012 +- 0.003".
std::string with_interval(const MeasuredVector& vector, Eigen::Index n) {
  return fmt::format("{:.3g} +- {:.2g}", vector.mean[n], interval_quantile * vector.error(n));
}

/// What was seen at one step.
struct Look {
  double step;
  MeasuredVector vector;
  ChanceTest moments;
  std::optional<ChanceTest> transitions;

  bool violated() const {
    return moments.certainly_not_chance() || (transitions && transitions->certainly_not_chance());
  }
  double largest_error() const { return std::sqrt(vector.covariance.diagonal().maxCoeff()); }
};

/// One case at all its steps, those left out at which too many copies failed.
struct Ladder {
  std::string name;
  FluidParameters fluid;
  std::vector<std::string> columns;
  std::vector<Look> looks;  ///< the largest step first
  std::string left_out = {};
};

Look look_at(double step, const json& record) {
  const auto vector = measured_vector(record["reversal"]);
  Look look{step, vector, hotelling(vector), {}};
  if (!record.contains("transitions")) return look;
  const auto rows = record["transitions"].get<std::vector<std::vector<double>>>();
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd counts(size, size);
  for (Eigen::Index a = 0; a < size; ++a) {
    for (Eigen::Index b = 0; b < size; ++b) counts(a, b) = rows[a][b];
  }
  look.transitions = two_way_test(counts);
  return look;
}

Ladder ladder_of(std::string name, const FluidParameters& fluid, std::vector<std::string> columns,
                 const std::vector<double>& steps, const Records& records) {
  Ladder ladder{std::move(name), fluid, std::move(columns), {}};
  for (const double step : steps) {
    const auto found = records.find(reversal_part(ladder.name, step));
    if (found == records.end()) continue;
    const json& record = found->second;
    if (record["failed"] <= most_failed && record.contains("reversal")) {
      ladder.looks.push_back(look_at(step, record));
      continue;
    }
    ladder.left_out += fmt::format(" At step {:g} {:.2g} % of the copies failed ({}).", step,
                                   100 * record["failed"].get<double>(),
                                   record["failure"]["cause"].get<std::string>());
  }
  return ladder;
}

std::string tests_of(const Look& look) {
  std::string text =
      fmt::format("T^2 = {:.4g} for {:g} moments (chance {:.1g})", look.moments.statistic,
                  look.moments.freedom, look.moments.probability);
  if (look.transitions) {
    text += fmt::format(", transitions chi^2 = {:.4g} for {:g} pairs of bins (chance {:.1g})",
                        look.transitions->statistic, look.transitions->freedom,
                        look.transitions->probability);
  }
  return text;
}

void put(const MeasuredVector& vector, Eigen::Index n, Finding& finding) {
  finding.value = vector.mean[n];
  finding.lower = vector.mean[n] - interval_quantile * vector.error(n);
  finding.upper = vector.mean[n] + interval_quantile * vector.error(n);
}

/// Detailed balance at the largest step that could be looked at.
Finding at_a_step(const Ladder& ladder) {
  const Look& look = ladder.looks.front();
  Finding finding;
  finding.subject = fmt::format("detailed balance of {}, step {:g}", ladder.name, look.step);
  const auto column = clearest(look.vector);
  put(look.vector, column, finding);
  finding.resolution = certain * look.largest_error();
  if (look.violated()) {
    finding.verdict = Verdict::reported;
    finding.sentence =
        fmt::format("Forwards and backwards differ: {}; the clearest correlation, of {}, by {}.",
                    tests_of(look), ladder.columns[column], with_interval(look.vector, column));
  } else {
    finding.verdict = *finding.resolution <= tolerance ? Verdict::holds : Verdict::not_resolved;
    finding.sentence = fmt::format(
        "Forwards and backwards look alike: {}; correlations that differ by {:.2g} would be seen.",
        tests_of(look), *finding.resolution);
  }
  finding.sentence += ladder.left_out;
  return finding;
}

/// The differences that the three smallest steps, each half of the one before, leave at a vanishing
/// one, if they are certain, at least half of what is left at the smallest step, and at least twice
/// what the parabola through the three changes of the line through two: less could be the
/// parabola's own error.
std::optional<Finding> remains(const Ladder& ladder, const Finding& asked) {
  const auto& looks = ladder.looks;
  const auto count = looks.size();
  if (count < 3) return {};
  const auto &smallest = looks[count - 1].vector, &next = looks[count - 2].vector;
  const auto limit = at_vanishing_step({looks[count - 3].vector, next, smallest});
  const auto column = clearest(limit);
  const double left = limit.mean[column], line = 2 * smallest.mean[column] - next.mean[column];
  const bool most_of_it = std::abs(left) > 0.5 * std::abs(smallest.mean[column]) &&
                          std::abs(left) > 2 * std::abs(left - line);
  const bool sure = std::abs(z(limit, column)) > certain && hotelling(limit).certainly_not_chance();
  if (!most_of_it || !sure) return {};
  Finding finding = asked;
  put(limit, column, finding);
  finding.resolution = certain * limit.error(column);
  finding.verdict = Verdict::fails;
  finding.sentence = fmt::format(
      "Forwards and backwards differ however small the step: of {} by {} at step {:g} and, "
      "extrapolated, by {} at vanishing steps.",
      ladder.columns[column], with_interval(smallest, column), looks.back().step,
      with_interval(limit, column));
  return finding;
}

/// Whether the violation found at a step has vanished, at order 1/2 or faster, at the smallest.
void judge_shrinking(const Ladder& ladder, const Look& coarse, Finding& finding) {
  const Look& fine = ladder.looks.back();
  const auto column = clearest(coarse.vector);
  const double shrunk = std::sqrt(fine.step / coarse.step);
  const double excess =
      std::abs(fine.vector.mean[column]) - shrunk * std::abs(coarse.vector.mean[column]);
  const double error = std::hypot(fine.vector.error(column), shrunk * coarse.vector.error(column));
  const bool vanishes = &fine != &coarse && excess < -interval_quantile * error;
  put(fine.vector, column, finding);
  finding.resolution = certain * error;
  finding.verdict = vanishes ? Verdict::holds : Verdict::not_resolved;
  finding.sentence = fmt::format(
      "The difference of forwards and backwards, of {}, is {} at step {:g} and {} at step {:g}: "
      "{}.",
      ladder.columns[column], with_interval(coarse.vector, column), coarse.step,
      with_interval(fine.vector, column), fine.step,
      vanishes ? "it vanishes with the step"
               : "that does not tell whether it vanishes with the step");
}

Finding in_the_limit(const Candidate& candidate, const Ladder& ladder) {
  Finding finding;
  finding.subject = fmt::format("detailed balance of {} at vanishing steps", ladder.name);
  finding.claimed =
      is_consistent(candidate.method(), candidate.choice.options, Fluid(ladder.fluid));
  if (const auto left = remains(ladder, finding)) return *left;
  const auto violated = std::find_if(ladder.looks.begin(), ladder.looks.end(),
                                     [](const Look& look) { return look.violated(); });
  if (violated != ladder.looks.end()) {
    judge_shrinking(ladder, *violated, finding);
    return finding;
  }
  const Look& fine = ladder.looks.back();
  put(fine.vector, clearest(fine.vector), finding);
  finding.resolution = certain * fine.largest_error();
  finding.verdict = *finding.resolution <= tolerance ? Verdict::holds : Verdict::not_resolved;
  finding.sentence = fmt::format(
      "Forwards and backwards look alike at every step; at step {:g} a difference of "
      "{:.2g} of a correlation would be seen.",
      fine.step, *finding.resolution);
  return finding;
}

Table table_of(const Ladder& ladder) {
  Table table{"Forwards minus backwards in standard errors, " + ladder.name, {"moments"}, {}};
  for (const auto& look : ladder.looks)
    table.columns.push_back(fmt::format("step {:g}", look.step));
  for (std::size_t n = 0; n < ladder.columns.size(); ++n) {
    auto& row = table.rows.emplace_back();
    row.emplace_back(ladder.columns[n]);
    for (const auto& look : ladder.looks)
      row.emplace_back(z(look.vector, static_cast<Eigen::Index>(n)));
  }
  return table;
}

Series series_of(const Ladder& ladder) {
  const auto column = clearest(ladder.looks.front().vector);
  Series series{ladder.name + ": " + ladder.columns[column], {}};
  for (const auto& look : ladder.looks) {
    const double value = look.vector.mean[column];
    const double margin = interval_quantile * look.vector.error(column);
    series.points.push_back({look.step, value, value - margin, value + margin});
  }
  return series;
}

}  // namespace

void conclude_reversal(const Candidate& candidate, const Records& records, Conclusion& conclusion) {
  std::vector<Ladder> ladders;
  for (const auto& asked : pair_cases(candidate)) {
    if (!is_reversed(asked)) continue;
    ladders.push_back(ladder_of(asked.name, asked.bench.fluid.parameters(), pair_reversal_columns(),
                                pair_steps(), records));
  }
  for (const auto& asked : fluid_cases(candidate)) {
    ladders.push_back(
        ladder_of(asked.name, asked.fluid, fluid_reversal_columns(), fluid_steps(), records));
  }
  Chart chart{"Difference of forwards and backwards, where it is clearest",
              {"step, relaxation times of a pair or units of time of the fluid"},
              {"difference of the correlation"},
              {}};
  for (const auto& ladder : ladders) {
    if (ladder.looks.empty()) {
      conclusion.findings.push_back({.subject = "detailed balance of " + ladder.name,
                                     .verdict = Verdict::not_resolved,
                                     .sentence = "No step could be looked at." + ladder.left_out});
      continue;
    }
    conclusion.findings.push_back(at_a_step(ladder));
    conclusion.findings.push_back(in_the_limit(candidate, ladder));
    conclusion.tables.push_back(table_of(ladder));
    chart.series.push_back(series_of(ladder));
  }
  conclusion.charts.push_back(std::move(chart));
}

}  // namespace driftless::judge
