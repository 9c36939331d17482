#include "experiments/judge/drift_findings.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "experiments/order_fit.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

/// About what Verlet methods drift at the usual step, in kT per particle and unit of time.
constexpr double usual_drift = 5e-3;

}  // namespace

Finding power_finding(const std::string& subject, const std::string& of,
                      const std::vector<MeasuredDrift>& all,
                      double (*variable)(const DriftSetting&), double expected,
                      bool theory_applies) {
  std::vector<Deviation> points;
  for (const auto& one : all) {
    const double x = variable(one.setting);
    if (x > 0) points.push_back({x, one.drift, one.error});
  }
  Finding finding;
  finding.subject = subject;
  const auto fit = fit_order(points);
  if (!fit || fit->points < 3) {
    finding.verdict = Verdict::not_resolved;
    finding.sentence =
        fmt::format("Fewer than three drifts stand out of the noise: no power of {}.", of);
    return finding;
  }
  finding.value = fit->order;
  finding.lower = fit->order - interval_quantile * fit->error;
  finding.upper = fit->order + interval_quantile * fit->error;
  finding.sentence = fmt::format(
      "The drift goes with the power {:.2f} ({:.2f} to {:.2f}) of {}; theory, for methods "
      "that drift by the Verlet step alone, says {:g}.",
      fit->order, *finding.lower, *finding.upper, of, expected);
  if (!theory_applies) return finding;
  // The law is one of small steps and weak friction: a quarter is left to the next terms. A power
  // that could as well be the next one is not resolved.
  const double away = std::abs(fit->order - expected);
  finding.resolution = certain * fit->error;
  const bool is_sharp = *finding.resolution < 1;
  finding.verdict = away > 0.25 + certain * fit->error ? Verdict::fails
                    : is_sharp && away <= 0.25 + interval_quantile * fit->error
                        ? Verdict::holds
                        : Verdict::not_resolved;
  return finding;
}

Finding sign_finding(const std::vector<MeasuredDrift>& all, bool theory_applies) {
  Finding finding;
  finding.subject = "sign of the drift";
  int rising = 0, falling = 0;
  double steepest_fall = 0;
  for (const auto& one : all) {
    if (one.certainty() > certain) ++rising;
    if (one.certainty() < -certain) {
      ++falling;
      steepest_fall = std::min(steepest_fall, one.drift);
    }
  }
  finding.verdict = falling > 0  ? Verdict::fails
                    : rising > 0 ? Verdict::holds
                                 : Verdict::not_resolved;
  if (!theory_applies) finding.verdict = Verdict::reported;
  finding.sentence = fmt::format(
      "Of {} settings the energy certainly rises in {} and falls in {}{}.", all.size(), rising,
      falling,
      falling > 0
          ? fmt::format(" (by up to {:.2g} kT per particle and unit of time)", -steepest_fall)
          : "");
  return finding;
}

Finding frictionless_finding(const std::vector<MeasuredDrift>& frictional) {
  Finding finding;
  finding.subject = "drift without friction";
  finding.verdict = Verdict::not_resolved;
  finding.sentence = fmt::format("Runs without friction broke at step {:g}.", usual_step);
  for (const auto& one : frictional) {
    if (one.setting.friction > 0) continue;
    finding = zero_finding(finding.subject, one.drift, one.error, 0.1 * usual_drift);
    finding.unit = "kT per particle and unit of time";
    finding.sentence = fmt::format(
        "Without friction the energy moves by {:.2g} ({:.2g} to {:.2g}) kT per particle and unit "
        "of time at step {:g}; theory says 0.",
        one.drift, *finding.lower, *finding.upper, usual_step);
    finding.verdict = Verdict::reported;
  }
  return finding;
}

Finding fluctuation_finding(const std::vector<MeasuredDrift>& all, bool theory_applies) {
  Finding finding;
  finding.subject = "variance of E - E(0) over 2 kT times the mean drift";
  double weights = 0, sum = 0;
  for (const auto& one : all) {
    if (one.certainty() < certain || one.walk_lower <= 0) continue;
    const double walk_error = (one.walk_upper - one.walk_lower) / (2 * interval_quantile);
    const double ratio = one.walk / (2 * one.drift);
    const double error = ratio * std::hypot(walk_error / one.walk, one.error / one.drift);
    weights += 1 / (error * error);
    sum += ratio / (error * error);
  }
  if (weights == 0) {
    finding.verdict = theory_applies ? Verdict::not_resolved : Verdict::reported;
    finding.sentence = "No setting shows both a drift and a walk of the energy out of the noise.";
    return finding;
  }
  const double ratio = sum / weights, error = 1 / std::sqrt(weights);
  finding = zero_finding(finding.subject, ratio - 1, error, 0.5);
  finding.value = ratio;
  *finding.lower += 1;
  *finding.upper += 1;
  if (!theory_applies) finding.verdict = Verdict::reported;
  finding.sentence = fmt::format(
      "The energy's variance grows at {:.2f} ({:.2f} to {:.2f}) times 2 kT times its mean; the "
      "fluctuation theorem says 1.",
      ratio, *finding.lower, *finding.upper);
  return finding;
}

Finding prefactor_finding(const std::vector<MeasuredDrift>& all) {
  Finding finding;
  finding.subject = "drift over that of theory, smallest step that shows it";
  for (const auto& one : all) {
    if (one.certainty() < certain) continue;
    const double ratio = one.drift / one.kick_move_kick, error = one.error / one.kick_move_kick;
    finding.value = ratio;
    finding.lower = ratio - interval_quantile * error;
    finding.upper = ratio + interval_quantile * error;
    finding.sentence = fmt::format(
        "At step {:.3g} the energy rises by {:.3g} kT per particle and unit of time, {:.2f} "
        "({:.2f} to {:.2f}) times what theory says for kick, move, kick, and {:.2f} times that for "
        "move, kick, move.",
        one.setting.time_step, one.drift, ratio, *finding.lower, *finding.upper,
        one.drift / one.move_kick_move);
    return finding;
  }
  finding.verdict = Verdict::not_resolved;
  finding.sentence = "No step shows a drift out of the noise.";
  return finding;
}

Finding bias_finding(const std::vector<MeasuredDrift>& large,
                     const std::vector<MeasuredDrift>& small, bool law_exact) {
  Finding finding;
  finding.subject = "term of third order in the step and first in k/phi";
  std::vector<MeasuredDrift> all = large;
  all.insert(all.end(), small.begin(), small.end());
  if (large.size() < 2 || small.size() < 2) {
    finding.verdict = Verdict::not_resolved;
    finding.sentence = "Too few runs ended for a fit of the two terms.";
    return finding;
  }
  Eigen::MatrixXd design(static_cast<Eigen::Index>(all.size()), 3);
  Eigen::VectorXd values(design.rows());
  for (Eigen::Index n = 0; n < design.rows(); ++n) {
    const auto& one = all[static_cast<std::size_t>(n)];
    const double h = one.setting.time_step;
    // The next even power takes up what large steps add.
    design.row(n) << std::pow(h, 4), std::pow(h, 3) / one.setting.heat_capacity, std::pow(h, 6);
    design.row(n) /= one.error;
    values(n) = one.drift / one.error;
  }
  const Eigen::MatrixXd inverse = (design.transpose() * design).inverse();
  const Eigen::VectorXd fit = inverse * design.transpose() * values;
  const double freedom = static_cast<double>(design.rows() - design.cols());
  const double chi = (values - design * fit).squaredNorm() / freedom;
  const double error = std::sqrt(inverse(1, 1) * std::max(1.0, chi));
  // What matters is the term's share of the drift at the smaller heat capacity.
  const double unit = small.front().setting.heat_capacity / std::pow(usual_step, 3);
  const auto kmk = small.front().kick_move_kick / std::pow(small.front().setting.time_step, 4) *
                   std::pow(usual_step, 4);
  const double share = fit(1) / (unit * kmk), share_error = error / (unit * kmk);
  finding = zero_finding(finding.subject, share, share_error, 0.5);
  if (law_exact && finding.verdict != Verdict::fails) finding.claimed = true;
  if (!law_exact) finding.verdict = Verdict::reported;
  finding.sentence = fmt::format(
      "At phi/k = {:g} and step {:g} the term is {:+.2f} ({:+.2f} to {:+.2f}) times the drift of "
      "theory for kick, move, kick.",
      small_capacity, usual_step, share, *finding.lower, *finding.upper);
  return finding;
}

Finding brief_finding(const std::vector<MeasuredDrift>& brief) {
  Finding finding;
  finding.subject = "drift at small steps";
  finding.unit = "kT per particle and unit of time";
  std::vector<Deviation> points;
  const MeasuredDrift* seen = nullptr;
  for (const auto& one : brief) {
    points.push_back({one.setting.time_step, one.drift, one.error});
    if (!seen && one.certainty() > certain) seen = &one;
  }
  if (!seen) {
    finding.sentence = "In brief runs of small steps no drift stands out of the noise.";
    return finding;
  }
  finding.value = seen->drift;
  finding.lower = seen->drift - interval_quantile * seen->error;
  finding.upper = seen->drift + interval_quantile * seen->error;
  finding.sentence = fmt::format(
      "In brief runs at step {:g} the energy rises by {:.3g} ({:.3g} to {:.3g}) kT per particle "
      "and "
      "unit of time",
      seen->setting.time_step, seen->drift, *finding.lower, *finding.upper);
  if (const auto fit = fit_order(points); fit && fit->points >= 3) {
    finding.sentence += fmt::format(", with the power {:.2f} ({:.2f} to {:.2f}) of the step",
                                    fit->order, fit->order - interval_quantile * fit->error,
                                    fit->order + interval_quantile * fit->error);
  }
  finding.sentence += ".";
  return finding;
}

}  // namespace driftless::judge
