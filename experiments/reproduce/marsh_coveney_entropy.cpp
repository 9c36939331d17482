#include <fmt/format.h>

#include "experiments/judge/balance.hpp"
#include "experiments/judge/balance_runs.hpp"
#include "experiments/reproduce/experiments.hpp"

namespace driftless::reproduce {
namespace {

/// The papers' own integrators.
const std::vector<judge::Candidate>& candidates() {
  static const std::vector<judge::Candidate> all = {{{"marsh-coveney", {}}},
                                                    {{"avalos-mackie-explicit", {}}}};
  return all;
}

std::string part_name(const judge::Candidate& candidate, const std::string& judged) {
  return candidate.name() + ": " + judged;
}

std::vector<Part> parts(const Conditions& conditions) {
  const bool quick = conditions.effort == Effort::quick;
  const std::size_t copies = quick ? 100000 : 1000000;
  const double seconds = quick ? 3 : 30;  // of the smallest step
  std::vector<Part> all;
  for (const auto& candidate : candidates()) {
    for (const auto& asked : judge::pair_cases(candidate)) {
      if (!asked.relaxes) continue;
      for (const double step : judge::entropy_steps()) {
        const std::uint64_t seed = 1000 * conditions.seed + all.size();
        all.push_back(
            {part_name(candidate, judge::entropy_part(asked, step)),
             seconds * judge::entropy_steps().front() / step, false, [=](const Workplace&) {
               return judge::run_entropy_course(candidate, asked.bench, step, copies, seed);
             }});
      }
    }
  }
  return all;
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

Outcome conclude(const Conditions&, const Records& records) {
  Outcome outcome;
  for (const auto& candidate : candidates()) {
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
      outcome.pictures.push_back(
          {fmt::format("{}: {}", candidate.name(), chart.title),
           "The distance may only shrink. Where it is drawn out as a plateau the method's own "
           "stationary law is another one than the exact law, the further the larger the step.",
           std::move(chart),
           {}});
    }
  }
  outcome.remarks = {
      "The functionals are those of the exact process: at a finite step a method has a stationary "
      "law of its own, and what must be monotone is the distance from that one. A fall of S[P] "
      "close to the plateau is the difference of the two laws, not an instability.",
      "What is given is the largest of many differences, and so above zero by chance; it is "
      "negative where the distance shrinks between any two times."};
  return outcome;
}

}  // namespace

const Experiment marsh_coveney_entropy{
    .name = "marsh-coveney-1998-entropy",
    .source = "MC98 VI, MAN 3.15-3.17",
    .title = "Free energy and entropy of an ensemble change one way only",
    .question =
        "The H-theorems of the models: the free energy F[P] = <H> + k T <ln P> of the isothermal "
        "model may only fall [MC98 7, 8], the entropy S[P] = <sum s/k> - <ln P> of the isolated "
        "energy-conserving one only rise [MC98 31, 32; MAN 3.15-3.17]; a change the other way is "
        "proposed there as the sign of a numerical instability. Isolated pairs at a fixed "
        "distance, phi/k = 10, friction and conduction relaxing alike, and isothermal pairs start "
        "in a narrow smooth cloud far from equilibrium with several times its kinetic energy. P(t) "
        "is a histogram of many copies, of (v, u_i - u_j) or of v alone, followed for 8 relaxation "
        "times of the relative velocity at steps of 0.1, 0.2, 0.4 and 0.8 of it. The clearest "
        "change the wrong way between any two times is given; it counts as one where chance alone "
        "would bring it about, among all pairs of times, less than once in a million times.",
    .parts = parts,
    .conclude = conclude};

}  // namespace driftless::reproduce
