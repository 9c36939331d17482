#include <fmt/format.h>

#include <set>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/limit_charts.hpp"
#include "experiments/judge/trade.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& scene : limit_scenes(conditions)) {
    if (refusal(candidate.method(), scene.fluid)) continue;
    for (std::size_t step = 0; step < scene.time_steps.size(); ++step) {
      for (unsigned block = 0; block < scene.blocks; ++block) {
        const auto number = static_cast<unsigned>(step) * scene.blocks + block;
        const double time_step = scene.time_steps[step];
        all.push_back({part_name(scene, step, block), scene.cost_per_inverse_step / time_step,
                       [scene, candidate, time_step, number] {
                         return scene.run(candidate, time_step, number);
                       }});
      }
    }
    if (!scene.seconds_per_time) continue;
    all.push_back({timing_name(scene), 0.4, [scene, candidate] {
                     return json{{"seconds_per_time", scene.seconds_per_time(candidate)}};
                   }});
  }
  return all;
}

/// A finding for each closure that the method refuses.
void add_refusals(const Candidate& candidate, const std::vector<LimitScene>& scenes,
                  Conclusion& conclusion) {
  std::set<std::string> told;
  for (const auto& scene : scenes) {
    const auto reason = refusal(candidate.method(), scene.fluid);
    if (!reason || !told.insert(*reason).second) continue;
    Finding finding;
    finding.subject =
        fmt::format("{} closure", to_string(scene.fluid.parameters().friction_closure));
    finding.verdict = Verdict::not_applicable;
    finding.sentence = *reason + ".";
    conclusion.findings.push_back(std::move(finding));
  }
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  Conclusion conclusion;
  const auto scenes = limit_scenes(conditions);
  LimitCharts charts;
  Table trade = empty_trade_table();
  for (const auto& scene : scenes) {
    if (refusal(candidate.method(), scene.fluid)) continue;
    const auto cells = limit_cells(scene, records);
    std::vector<Finding> findings;
    if (!can_be_run(cells)) findings.push_back(unseen_finding(scene, cells));
    for (const auto& observable : limit_observables(scene.family)) {
      const LimitCase asked{scene, observable, cells};
      if (can_be_run(cells)) findings.push_back(limit_finding(asked, conditions.depth));
      charts.add(asked);
      add_trade(asked, records, trade);
    }
    for (auto& finding : findings) {
      finding.claimed = is_consistent(candidate.method(), candidate.choice.options, scene.fluid);
      conclusion.findings.push_back(std::move(finding));
    }
  }
  add_refusals(candidate, scenes, conclusion);
  conclusion.charts = std::move(charts).take();
  if (!trade.rows.empty()) conclusion.tables.push_back(std::move(trade));
  return conclusion;
}

}  // namespace

const Examination limits{
    "limits",
    "Right in the limit of vanishing time steps",
    "Is every average of equilibrium right in the limit of vanishing time steps? Isolated pairs, "
    "the isolated ideal fluid with and without conduction and a soft fluid are run at four time "
    "steps, each observable's deviation from its exact value (for the soft fluid: from that of a "
    "Monte Carlo chain, whose error counts) is extrapolated to step zero by the parabola through "
    "the three finest steps, whatever order is claimed; by how much the coarsest one, as a point "
    "of a cubic, would move the limit counts as an error too. A deviation beyond five standard "
    "errors fails, one beyond three is not resolved. Nor is anything where five errors are more "
    "than 1 % of a temperature, 3 % of a variance or 0.05 of a skewness (at depth quick five times "
    "as much), or than a distance of 0.009 between distributions (that of two variances 10 % "
    "apart). A step at which over one in twenty runs fails does not count.",
    parts,
    conclude,
};

}  // namespace driftless::judge
