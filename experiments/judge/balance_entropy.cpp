#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "experiments/judge/balance.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double tolerance = 0.02;    ///< of a fall in k that may go unseen where one "holds"
constexpr double most_failed = 0.01;  ///< of the copies; survivors of more are a selection

std::string failures(const json& record) {
  if (!record.contains("failure")) return "";
  const auto& first = record["failure"];
  const std::string when = first.contains("time") ? fmt::format(", first in step {} at time {:.3g}",
                                                                first["step"].get<std::uint64_t>(),
                                                                first["time"].get<double>())
                                                  : "";
  return fmt::format(" {:.2g} % of the copies failed ({}{}).", 100 * record["failed"].get<double>(),
                     first["cause"].get<std::string>(), when);
}

/// How many standard errors are `certain` for the worst of so many comparisons.
double certain_of_many(double comparisons) {
  const boost::math::normal normal;
  return -quantile(normal, cdf(normal, -certain) / comparisons);
}

/// S[P] of pairs that keep their energy may only rise, F[P] of isothermal ones only fall.
struct Words {
  const char *quantity, *unit, *right, *wrong, *side, *law;
};

Words words_of(const PairCase& asked) {
  if (asked.bench.fluid.isothermal())
    return {"F[P]", "k T", "falls", "rise", "above", "Maxwell's law"};
  return {"S[P]", "k", "rises", "fall", "below", "the exact law"};
}

bool claimed(const PairCase& asked, const Method& method) {
  return asked.bench.fluid.isothermal() ? method.isothermal_pair_law_exact : method.pair_law_exact;
}

Finding finding_of(const PairCase& asked, double step, const Candidate& candidate,
                   const json& record) {
  Finding finding;
  const Words words = words_of(asked);
  finding.subject = entropy_part(asked, step);
  finding.unit = words.unit;
  if (claimed(asked, candidate.method())) finding.claimed = true;
  if (!record.contains("relative")) {
    finding.verdict = Verdict::reported;
    finding.sentence = std::string(words.quantity) + "(t) cannot be followed." + failures(record);
    return finding;
  }
  const auto times = record["times"].get<std::vector<double>>();
  const auto relative = record["relative"].get<std::vector<double>>();
  const auto& fall = record["fall"];
  const auto count = static_cast<double>(times.size());
  const double needed = certain_of_many(count * (count - 1) / 2);
  const double depth = fall["depth"], error = fall["error"];
  const double from = times[fall["from"]], to = times[fall["to"]];
  const double end_error = record["error"].back();
  finding.value = depth;
  finding.lower = depth - interval_quantile * error;
  finding.upper = depth + interval_quantile * error;
  finding.resolution = needed * std::sqrt(2.0) * end_error;
  const bool falls = depth > needed * error;
  const bool selected = record["failed"].get<double>() > most_failed;
  const std::string course = fmt::format(
      "{} {} by {:.4g} {} in {:g} relaxation times, to {:.2g} +- {:.1g} {} {} that of {}",
      words.quantity, words.right, relative.front() - relative.back(), words.unit, times.back(),
      relative.back(), interval_quantile * end_error, words.unit, words.side, words.law);
  const std::string clearest =
      fmt::format("{:.3g} +- {:.2g} {} from t = {:g} to t = {:g} ({:.1f} standard errors)", depth,
                  interval_quantile * error, words.unit, from, to, depth / error);
  if (falls) {
    finding.verdict = Verdict::fails;
    finding.sentence = fmt::format("{}, but {}s by {}.", course, words.wrong, clearest);
  } else {
    const bool sharp = *finding.resolution <= tolerance;
    finding.verdict = sharp ? Verdict::holds : Verdict::not_resolved;
    finding.sentence = fmt::format(
        "{}, and does not {} beyond the noise: at the clearest by {}; near equilibrium a {} of "
        "{:.1g} {} would be certain.",
        course, words.wrong, clearest, words.wrong, *finding.resolution, words.unit);
  }
  if (selected) finding.verdict = Verdict::reported;
  finding.sentence += failures(record);
  if (selected) finding.sentence += " The others are a selection.";
  return finding;
}

Series series_of(double step, const json& record) {
  Series series{fmt::format("step {:g}", step), {}};
  const auto times = record["times"].get<std::vector<double>>();
  for (std::size_t n = 0; n < times.size(); ++n) {
    const double value = record["relative"][n], error = record["error"][n];
    const double margin = interval_quantile * error;
    if (value <= 0) continue;  // has no place on a logarithmic axis
    Point point{times[n], value, {}, value + margin};
    if (value > margin) point.lower = value - margin;
    series.points.push_back(point);
  }
  return series;
}

}  // namespace

void conclude_entropy(const Candidate& candidate, const Records& records, Conclusion& conclusion) {
  for (const auto& asked : pair_cases(candidate)) {
    if (!asked.relaxes) continue;
    const Words words = words_of(asked);
    Chart chart{
        fmt::format("How far {}(t) is {} its equilibrium, {}", words.quantity, words.side,
                    asked.name),
        {"time, relaxation times"},
        {fmt::format("distance of {} from {}, {}", words.quantity, words.law, words.unit), true},
        {}};
    for (const double step : entropy_steps()) {
      const auto found = records.find(entropy_part(asked, step));
      if (found == records.end()) continue;
      conclusion.findings.push_back(finding_of(asked, step, candidate, found->second));
      if (found->second.contains("relative")) {
        chart.series.push_back(series_of(step, found->second));
      }
    }
    conclusion.charts.push_back(std::move(chart));
  }
}

}  // namespace driftless::judge
