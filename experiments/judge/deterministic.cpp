#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "experiments/judge/examinations.hpp"
#include "experiments/judge/noise_free.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double order_tolerance = 0.2;
/// Whatever converges does so at a higher order than this, whatever does not at a lower one.
constexpr double converging = 0.5;

constexpr Difference all_differences[] = {
    Difference::position,     Difference::velocity,       Difference::internal_energy,
    Difference::total_energy, Difference::kinetic_energy, Difference::internal_temperature,
    Difference::norm};

std::string_view name_of(Difference which) {
  return difference_names[static_cast<std::size_t>(which)];
}

double time_step(const NoiseFreePlan& plan, std::size_t place) {
  return noise_free_duration / plan.steps[place];
}

std::string interval(const Averaged& value) {
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", value.mean, value.mean - value.half_width(),
                     value.mean + value.half_width());
}

std::string order_interval(const Averaged& order) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", order.mean, order.mean - order.half_width(),
                     order.mean + order.half_width());
}

/// What one case of a method says; `claim` is what the method claims of its order there.
class Case {
 public:
  Case(const Method& method, const Options& options, const NoiseFreePlan& plan, const Terms& terms,
       const json& record)
      : plan_(plan),
        terms_(terms),
        record_(record),
        claim_(terms.potential ? std::min(method.noise_free_order, 1) : method.noise_free_order),
        consistent_(is_consistent(method, options, Fluid(small_fluid(terms, 0)))) {
    if (failed()) return;
    order_ = noise_free_order(record, Difference::norm);
    limit_ = noise_free_limit(record, Difference::norm);
    limit_order_ = noise_free_limit_order(record, Difference::norm);
    finest_ = noise_free_difference(record, Difference::norm, plan.steps.size() - 1);
  }

  const Terms& terms() const { return terms_; }
  const json& record() const { return record_; }
  const Averaged& order() const { return order_; }
  bool failed() const { return record_.contains("failure"); }
  bool consistent() const { return consistent_; }
  bool has_limit() const {
    const auto stays = [](const Averaged& order) {
      return order.starts > 0 && order.mean + order.certain() < converging;
    };
    return stays(order_) || stays(limit_order_);
  }

  Finding finding() const {
    Finding finding;
    finding.subject = "order, " + terms_.name();
    finding.claimed = consistent_;
    if (failed()) return stopped(std::move(finding));
    if (order_.starts == 0) return exact(std::move(finding));
    finding.value = order_.mean;
    finding.lower = order_.mean - order_.half_width();
    finding.upper = order_.mean + order_.half_width();
    return has_limit() ? astray(std::move(finding)) : converges(std::move(finding));
  }

 private:
  Finding stopped(Finding finding) const {
    const auto& failure = record_["failure"];
    finding.verdict = Verdict::fails;
    finding.sentence =
        fmt::format("With {} the noise-free run at the step {:.3g} stops: {}.", terms_.name(),
                    failure["time_step"].get<double>(), failure["cause"].get<std::string>());
    return finding;
  }

  Finding exact(Finding finding) const {
    finding.verdict = Verdict::holds;
    finding.sentence =
        fmt::format("With {} it agrees with the reference to {:.2g}, as far as that is known.",
                    terms_.name(), finest_.mean);
    return finding;
  }

  Finding converges(Finding finding) const {
    const double needed = consistent_ ? claim_ - order_tolerance : converging;
    if (order_.mean + order_.certain() < needed) {
      finding.verdict = Verdict::fails;
    } else {
      const bool vanishes =
          limit_order_.starts == 0 || limit_order_.mean - limit_order_.half_width() >= converging;
      const bool sure = *finding.lower >= needed && vanishes;
      finding.verdict = sure ? Verdict::holds : Verdict::not_resolved;
    }
    finding.resolution = order_.certain();
    finding.sentence = fmt::format(
        "With {} the error falls as the step to the power {}: it is {:.2g} at the step {:.3g}, "
        "and {:.1g} is left when extrapolated to the step zero; {}.",
        terms_.name(), order_interval(order_), finest_.mean,
        time_step(plan_, plan_.steps.size() - 1), limit_.mean,
        consistent_ ? fmt::format("claimed is an order of {} at least", claim_)
                    : "no convergence is claimed");
    return finding;
  }

  Finding astray(Finding finding) const {
    finding.verdict = Verdict::fails;
    const auto internal = noise_free_limit(record_, Difference::internal_energy);
    const auto velocity = noise_free_limit(record_, Difference::velocity);
    finding.sentence = fmt::format(
        "With {} it does not converge to the model: the error is {:.2g} at the step {:.3g} and "
        "falls as the step to the power {}. Extrapolated to the step zero the worst internal "
        "energy, of about {:.3g}, is off by {}, the worst velocity by {}.",
        terms_.name(), finest_.mean, time_step(plan_, plan_.steps.size() - 1),
        order_interval(order_), Fluid(small_fluid(terms_, 0)).internal_energy(1.1),
        interval(internal), interval(velocity));
    return finding;
  }

  const NoiseFreePlan& plan_;
  Terms terms_;
  const json& record_;
  int claim_;
  bool consistent_;
  Averaged order_, finest_, limit_, limit_order_;
};

/// The claim is of the worst case, so one that is never as bad claims too little.
std::optional<Finding> claim_finding(const Method& method, const std::vector<Case>& cases) {
  const Case* worst = nullptr;
  for (const auto& one : cases) {
    if (one.terms().potential || !one.consistent() || one.failed() || one.order().starts == 0) {
      continue;
    }
    if (!worst || one.order().mean < worst->order().mean) worst = &one;
  }
  if (!worst) return std::nullopt;
  const auto& order = worst->order();
  const double away = order.mean - method.noise_free_order;
  Finding finding;
  finding.subject = "lowest order without a potential";
  finding.claimed = true;
  finding.value = order.mean;
  finding.lower = order.mean - order.half_width();
  finding.upper = order.mean + order.half_width();
  finding.sentence = fmt::format(
      "The lowest order of all cases without a potential is {}, with {}; claimed is {}.",
      order_interval(order), worst->terms().name(), method.noise_free_order);
  if (std::abs(away) - order.certain() > order_tolerance) {
    finding.verdict = Verdict::fails;
  } else {
    finding.verdict = std::abs(away) + order.half_width() <= order_tolerance
                          ? Verdict::holds
                          : Verdict::not_resolved;
  }
  return finding;
}

/// How total energy and temperatures follow the reference, in the case with everything in it.
void report_energies(const Case& one, const NoiseFreePlan& plan, Conclusion& conclusion) {
  for (const auto which :
       {Difference::total_energy, Difference::kinetic_energy, Difference::internal_temperature}) {
    const auto error = noise_free_difference(one.record(), which, plan.steps.size() - 1);
    const auto order = noise_free_order(one.record(), which);
    Finding finding;
    finding.subject = fmt::format("{}, {}", name_of(which), one.terms().name());
    finding.value = error.mean;
    finding.lower = error.mean - error.half_width();
    finding.upper = error.mean + error.half_width();
    finding.sentence = fmt::format(
        "With {} the {} at the end is off by {} at the step {:.3g}{}.", one.terms().name(),
        name_of(which), interval(error), time_step(plan, plan.steps.size() - 1),
        order.starts == 0 ? ", too little for an order"
                          : ", falling as the step to the power " + order_interval(order));
    conclusion.findings.push_back(finding);
  }
}

Series series(std::string name, const json& record, Difference which, const NoiseFreePlan& plan) {
  Series result{std::move(name), {}};
  constexpr double rounding = 1e-13;  // nothing to see below it
  for (std::size_t place = 0; place < plan.steps.size(); ++place) {
    const auto error = noise_free_difference(record, which, place);
    if (error.mean < rounding) continue;
    // The lower end of an interval as wide as the value cannot be drawn.
    const double lower = std::max(error.mean - error.half_width(), error.mean / 10);
    result.points.push_back(
        {time_step(plan, place), error.mean, lower, error.mean + error.half_width()});
  }
  return result;
}

Chart chart(std::string title) {
  return {
      std::move(title), {"time step", true}, {"largest difference from the reference", true}, {}};
}

void draw(const std::vector<Case>& cases, const NoiseFreePlan& plan, Conclusion& conclusion) {
  for (const bool potential : {false, true}) {
    auto all = chart(fmt::format("Errors of positions, velocities and temperatures, {} potential",
                                 potential ? "with a" : "without a"));
    for (const auto& one : cases) {
      if (one.failed() || one.terms().potential != potential) continue;
      all.series.push_back(series(fmt::format("closure {}, heat {}", to_string(one.terms().closure),
                                              to_string(one.terms().heat)),
                                  one.record(), Difference::norm, plan));
    }
    if (!all.series.empty()) conclusion.charts.push_back(all);
  }
  for (const auto& one : cases) {
    if (one.failed() || one.terms().heat != HeatForm::inverse_temperature) continue;
    auto each = chart("Error of each quantity, " + one.terms().name());
    for (const auto which : all_differences) {
      if (which == Difference::norm) continue;
      auto curve = series(std::string(name_of(which)), one.record(), which, plan);
      if (!curve.points.empty()) each.series.push_back(std::move(curve));
    }
    conclusion.charts.push_back(each);
    break;
  }
}

Table table(const std::vector<Case>& cases, const NoiseFreePlan& plan) {
  Table result{fmt::format("Difference at the step {:.3g}, and its order with 95 % half width",
                           time_step(plan, plan.steps.size() - 1)),
               {"case"},
               {}};
  for (const auto which : all_differences) result.columns.emplace_back(name_of(which));
  for (const auto& one : cases) {
    if (one.failed()) continue;
    auto& row = result.rows.emplace_back();
    row.emplace_back(one.terms().name());
    for (const auto which : all_differences) {
      const auto error = noise_free_difference(one.record(), which, plan.steps.size() - 1);
      const auto order = noise_free_order(one.record(), which);
      row.emplace_back(order.starts == 0 ? fmt::format("{:.1e}", error.mean)
                                         : fmt::format("{:.1e}, order {:.2f} ± {:.2f}", error.mean,
                                                       order.mean, order.half_width()));
    }
  }
  return result;
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  std::vector<Part> all;
  const auto plan = noise_free_plan(conditions);
  double steps = 0;
  for (const int count : plan.steps) steps += count;
  for (const auto& terms : noise_free_cases()) {
    if (refusal(candidate.method(), Fluid(small_fluid(terms, 0)))) continue;
    all.push_back({terms.name(), plan.starts * (0.1 + steps * 1.5e-5), [candidate, terms, plan] {
                     return noise_free_record(candidate.method(), candidate.choice.options, terms,
                                              plan);
                   }});
  }
  return all;
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  return conclude_noise_free(candidate.method(), candidate.choice.options,
                             noise_free_plan(conditions), records);
}

}  // namespace

Conclusion conclude_noise_free(const Method& method, const Options& options,
                               const NoiseFreePlan& plan, const Records& records) {
  Conclusion conclusion;
  std::vector<Case> cases;
  for (const auto& terms : noise_free_cases()) {
    if (const auto reason = refusal(method, Fluid(small_fluid(terms, 0)))) {
      if (terms.heat != HeatForm::none || terms.potential) continue;  // said once
      conclusion.findings.push_back({fmt::format("order, closure {}", to_string(terms.closure)),
                                     Verdict::not_applicable, *reason + "."});
    } else {
      cases.emplace_back(method, options, plan, terms, records.at(terms.name()));
      conclusion.findings.push_back(cases.back().finding());
    }
  }
  if (const auto claim = claim_finding(method, cases)) {
    conclusion.findings.insert(conclusion.findings.begin(), *claim);
  }
  for (const bool potential : {false, true}) {
    const auto all_terms = std::find_if(cases.begin(), cases.end(), [&](const Case& one) {
      return one.terms().potential == potential &&
             one.terms().heat == HeatForm::inverse_temperature && !one.failed();
    });
    if (all_terms != cases.end()) report_energies(*all_terms, plan, conclusion);
  }
  draw(cases, plan, conclusion);
  conclusion.tables.push_back(table(cases, plan));
  return conclusion;
}

const Examination deterministic{
    "deterministic", "The deterministic limit",
    "Without fluctuations (k = 0) the model is a set of ordinary differential equations, solved "
    "here to 1e-13 by SUNDIALS CVODE, with ARKODE as its check. How does a method's solution "
    "approach theirs as its step shrinks? 27 particles with friction, both closures, with and "
    "without conduction and a potential, run for half a unit of time from several shaken lattices, "
    "at steps that are halved again and again; orders are slopes over all steps, averaged over the "
    "starts. A case holds if its order is within 0.2 of the one claimed or above, and fails if it "
    "is certainly not; with a potential, whose force has a kink at its range, the first order is "
    "all that can be asked. The solution extrapolated to the step zero must tend to the reference, "
    "too: an order of either certainly below 1/2 is no convergence, and the limit of the "
    "difference is reported then.",
    parts, conclude};

}  // namespace driftless::judge
