#include "experiments/reproduce/entropy_rows.hpp"

#include <fmt/format.h>

#include <limits>

#include "experiments/judge/balance_runs.hpp"

namespace driftless::reproduce {
namespace {

std::string part_name(const judge::Candidate& candidate, const std::string& judged) {
  return candidate.name() + ": " + judged;
}

Verdict verdict_of(judge::Verdict verdict) {
  switch (verdict) {
    case judge::Verdict::holds:
      return Verdict::agrees;
    case judge::Verdict::fails:
      return Verdict::differs;
    case judge::Verdict::not_resolved:
      return Verdict::not_resolved;
    default:
      return Verdict::ours_alone;
  }
}

Row row_of(const judge::Candidate& candidate, const judge::Finding& finding) {
  const bool isothermal = finding.subject.starts_with("free energy");
  Row row;
  row.quantity = isothermal ? "clearest rise of F[P](t)" : "clearest fall of S[P](t)";
  const auto of = finding.subject.find(" of ") + 4;
  row.setting = fmt::format("{}, {}", candidate.name(), finding.subject.substr(of));
  row.unit = finding.unit;
  row.paper_text = isothermal ? "F[P] may only fall" : "S[P] may only rise";
  row.verdict = verdict_of(finding.verdict);
  row.explanation = finding.sentence;
  const double none = std::numeric_limits<double>::quiet_NaN();
  row.ours = {finding.value.value_or(none), finding.lower.value_or(none),
              finding.upper.value_or(none)};
  return row;
}

}  // namespace

void add_entropy_parts(const judge::Candidate& candidate, const Wanted& wanted,
                       const Conditions& conditions, std::vector<Part>& all) {
  const bool quick = conditions.effort == Effort::quick;
  const std::size_t copies = quick ? 100000 : 1000000;
  const double seconds = quick ? 0.4 : 4;  // of the smallest step
  for (const auto& asked : judge::pair_cases(candidate)) {
    if (!asked.relaxes || !wanted(asked)) continue;
    for (const double step : judge::entropy_steps()) {
      const std::uint64_t seed = 1000 * conditions.seed + all.size();
      all.push_back({part_name(candidate, judge::entropy_part(asked, step)),
                     seconds * judge::entropy_steps().front() / step, false, [=](const Workplace&) {
                       return judge::run_entropy_course(candidate, asked.bench, step, copies, seed);
                     }});
    }
  }
}

void conclude_entropy(const judge::Candidate& candidate, const Records& records, Outcome& outcome) {
  const std::string prefix = part_name(candidate, "");
  judge::Records judged;
  for (const auto& [name, record] : records) {
    if (name.starts_with(prefix)) judged[name.substr(prefix.size())] = record;
  }
  judge::Conclusion conclusion;
  judge::conclude_entropy(candidate, judged, conclusion);
  for (const auto& finding : conclusion.findings) {
    outcome.rows.push_back(row_of(candidate, finding));
  }
  for (auto& chart : conclusion.charts) {
    if (chart.series.empty()) continue;  // of pairs that were not wanted
    outcome.pictures.push_back(
        {fmt::format("{}: {}", candidate.name(), chart.title),
         "The distance may only shrink. Where it is drawn out as a plateau the method's own "
         "stationary law is another one than the exact law, the further the larger the step.",
         std::move(chart),
         {}});
  }
}

}  // namespace driftless::reproduce
