#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "experiments/energy_drift.hpp"
#include "experiments/judge/drift_prediction.hpp"
#include "experiments/judge/examinations.hpp"
#include "experiments/judge/isolated_runs.hpp"
#include "experiments/order_fit.hpp"
#include "experiments/replica.hpp"
#include "experiments/scene_keys.hpp"

/// The law of the energy drift (see drift_prediction.hpp) in a soft fluid without conduction.
namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr double usual_friction = 4.5, usual_capacity = 60, small_capacity = 6;
constexpr double usual_step = 0.05;
/// About what Verlet methods drift there, in kT per particle and unit of time.
constexpr double usual_drift = 5e-3;

/// One run: where, and at which step.
struct Setting {
  double heat_capacity, friction, time_step;

  std::string name() const {
    return fmt::format("phi/k {:g}, friction {:g}, step {:.4g}", heat_capacity, friction,
                       time_step);
  }
};

std::vector<double> steps(Depth depth) {
  // Whole fractions of the time between samples.
  if (depth == Depth::quick) return {0.4 / 13, 0.04, 0.05, 0.4 / 6};
  return {0.02, 0.025, 0.4 / 13, 0.04, 0.05, 0.4 / 6};
}

std::vector<double> frictions(Depth depth) {
  if (depth == Depth::quick) return {0.5, 1.5, 13.5};
  return {0.17, 0.5, 1.5, 13.5, 40.5};
}

std::vector<Setting> settings(Depth depth) {
  std::vector<Setting> all;
  for (const double capacity : {usual_capacity, small_capacity}) {
    for (const double step : steps(depth)) all.push_back({capacity, usual_friction, step});
  }
  for (const double friction : frictions(depth)) {
    all.push_back({usual_capacity, friction, usual_step});
  }
  for (const double step : steps(depth)) all.push_back({usual_capacity, 0, step});
  return all;
}

Study study_of(const Conditions& conditions) {
  Study study;
  study.equilibrate = 2;
  study.measure = conditions.depth == Depth::quick ? 40 : 200;
  study.sample_every = 0.4;
  study.replicas = 8;
  study.seed = conditions.seed;
  return study;
}

Scene scene_of(const Setting& setting) {
  Scene scene = find_preset("soft-fluid")->scene;
  scene.fluid.heat_capacity = setting.heat_capacity;
  scene.fluid.friction = setting.friction;
  scene.fluid.conduction = 0;
  scene.fluid.heat_form = HeatForm::none;
  return scene;
}

json run(const Candidate& candidate, const Conditions& conditions, const Setting& setting) {
  const Study study = study_of(conditions);
  const auto& scene = prepared_once(scene_of(setting), study.seed, study.replicas);
  std::vector<EnergyTrace> traces;
  json record = {{"failures", json::array()}};
  for (unsigned replica = 0; replica < study.replicas; ++replica) {
    auto result = run_replica(scene, study, candidate.choice, setting.time_step, replica);
    if (result.failure) {
      record["failures"].push_back(to_string(result.failure->cause));
    } else {
      traces.push_back(std::move(result.record.energy));
    }
  }
  if (!record["failures"].empty()) return record;
  const auto drift = energy_drift(traces);
  const auto particles = static_cast<double>(scene.scene().particles);
  record["drift"] = drift.slope.mean;
  record["error"] = drift.slope.error;
  // Of the energy per particle: times N for that of a particle's share.
  record["walk"] = {particles * drift.walk.value, particles * drift.walk.lower,
                    particles * drift.walk.upper};
  System system = scene.start(0);
  const auto theory = predicted_drift(system);
  record["kick_move_kick"] = theory.kick_move_kick * std::pow(setting.time_step, 4);
  record["move_kick_move"] = theory.move_kick_move * std::pow(setting.time_step, 4);
  return record;
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  if (candidate.method().energy_with_potential == EnergyClaim::exact) return {};
  if (refusal(candidate.method(), Fluid(scene_of({usual_capacity, usual_friction, 0}).fluid))) {
    return {};
  }
  std::vector<Part> all;
  for (const auto& setting : settings(conditions.depth)) {
    const auto study = study_of(conditions);
    const double cost =
        4e-4 * (study.equilibrate + study.measure) * study.replicas / setting.time_step;
    all.push_back({setting.name(), cost, [=] { return run(candidate, conditions, setting); }});
  }
  return all;
}

// ---- conclusions

/// A measured drift with what is known of its setting.
struct Measured {
  Setting setting;
  double drift, error, walk, walk_lower, walk_upper, kick_move_kick, move_kick_move;

  double certainty() const { return drift / error; }
};

std::vector<Measured> measured(Depth depth, const Records& records) {
  std::vector<Measured> all;
  for (const auto& setting : settings(depth)) {
    const auto found = records.find(setting.name());
    if (found == records.end() || !found->second.contains("drift")) continue;
    const auto& record = found->second;
    all.push_back({setting, record["drift"], record["error"], record["walk"][0], record["walk"][1],
                   record["walk"][2], record["kick_move_kick"], record["move_kick_move"]});
  }
  return all;
}

std::vector<Measured> along_steps(const std::vector<Measured>& all, double capacity,
                                  double friction = usual_friction) {
  std::vector<Measured> some;
  for (const auto& one : all) {
    const auto& setting = one.setting;
    if (setting.heat_capacity == capacity && setting.friction == friction) some.push_back(one);
  }
  return some;
}

std::vector<Measured> along_frictions(const std::vector<Measured>& all) {
  std::vector<Measured> some;
  for (const auto& one : all) {
    const auto& setting = one.setting;
    if (setting.heat_capacity == usual_capacity && setting.time_step == usual_step)
      some.push_back(one);
  }
  return some;
}

/// The power with which the drift goes, beside the one that theory says.
Finding power_finding(const std::string& subject, const std::string& of,
                      const std::vector<Measured>& all, double (*variable)(const Setting&),
                      double expected, bool theory_applies) {
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
  // The law is one of small steps and weak friction: a quarter is left to the next terms.
  const double away = std::abs(fit->order - expected);
  finding.resolution = certain * fit->error;
  finding.verdict = away <= 0.25 + interval_quantile * fit->error ? Verdict::holds
                    : away > 0.25 + certain * fit->error          ? Verdict::fails
                                                                  : Verdict::not_resolved;
  return finding;
}

Finding sign_finding(const std::vector<Measured>& all, bool theory_applies) {
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

/// What the Verlet step does on its own: theory has no drift there, as it keeps h^2 H_2 + E.
Finding frictionless_finding(const std::vector<Measured>& frictional) {
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
        "of "
        "time at step {:g}; theory says 0.",
        one.drift, *finding.lower, *finding.upper, usual_step);
    finding.verdict = Verdict::reported;
  }
  return finding;
}

/// Var(E - E_0) over 2 kT times the mean drift: 1 by the fluctuation theorem.
Finding fluctuation_finding(const std::vector<Measured>& all, bool theory_applies) {
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

Finding prefactor_finding(const std::vector<Measured>& all) {
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

/// B of a drift A h^4 + B h^3 k/phi, both heat capacities and all steps at once. A kernel that
/// conserves energy but has a law of its own can add such a term.
Finding bias_finding(const std::vector<Measured>& large, const std::vector<Measured>& small,
                     bool law_exact) {
  Finding finding;
  finding.subject = "term of third order in the step and first in k/phi";
  std::vector<Measured> all = large;
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

Series series_of(const std::string& name, const std::vector<Measured>& all,
                 double (*variable)(const Setting&)) {
  Series series{name, {}};
  for (const auto& one : all) {
    series.points.push_back({variable(one.setting), one.drift,
                             one.drift - interval_quantile * one.error,
                             one.drift + interval_quantile * one.error});
  }
  return series;
}

Series theory_of(const std::string& name, const std::vector<Measured>& all,
                 double (*variable)(const Setting&), double Measured::*theory) {
  Series series{name, {}, Marks::line};
  for (const auto& one : all) series.points.push_back({variable(one.setting), one.*theory});
  return series;
}

double step_of(const Setting& setting) { return setting.time_step; }
double friction_of(const Setting& setting) { return setting.friction; }

std::vector<Chart> charts(const std::vector<Measured>& all) {
  const auto large = along_steps(all, usual_capacity), small = along_steps(all, small_capacity);
  const auto frictional = along_frictions(all);
  const Axis drift = {"energy drift, kT per particle and unit of time", true};
  return {
      {"Energy drift against step",
       {"time step", true},
       drift,
       {series_of(fmt::format("phi/k = {:g}", usual_capacity), large, step_of),
        series_of(fmt::format("phi/k = {:g}", small_capacity), small, step_of),
        theory_of("theory: kick, move, kick", large, step_of, &Measured::kick_move_kick),
        theory_of("theory: move, kick, move", large, step_of, &Measured::move_kick_move)}},
      {fmt::format("Energy drift against friction at step {:g}", usual_step),
       {"friction", true},
       drift,
       {series_of(fmt::format("phi/k = {:g}", usual_capacity), frictional, friction_of),
        theory_of("theory: kick, move, kick", frictional, friction_of, &Measured::kick_move_kick),
        theory_of("theory: move, kick, move", frictional, friction_of,
                  &Measured::move_kick_move)}}};
}

/// A method without parts, and why.
Conclusion without_drift(const Candidate& candidate) {
  Finding finding;
  finding.subject = "energy drift";
  finding.verdict = Verdict::not_applicable;
  const auto refused =
      refusal(candidate.method(), Fluid(scene_of({usual_capacity, usual_friction, 0}).fluid));
  finding.sentence =
      refused ? *refused : "The method conserves energy to rounding, with a potential too.";
  return {{finding}};
}

std::vector<Finding> failures(const Conditions& conditions, const Records& records) {
  std::vector<Finding> findings;
  for (const auto& setting : settings(conditions.depth)) {
    const auto found = records.find(setting.name());
    if (found == records.end() || found->second["failures"].empty()) continue;
    const auto& causes = found->second["failures"];
    findings.push_back({setting.name(), Verdict::reported,
                        fmt::format("{} of {} runs broke, the first by: {}.", causes.size(),
                                    study_of(conditions).replicas, causes[0].get<std::string>())});
  }
  return findings;
}

Conclusion every_run_broke(const Conditions& conditions, const Records& records) {
  Conclusion conclusion;
  conclusion.findings = failures(conditions, records);
  conclusion.findings.insert(conclusion.findings.begin(),
                             {"energy drift", Verdict::not_resolved,
                              "Not one setting's runs all ended: there is no drift to speak of."});
  return conclusion;
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  if (records.empty()) return without_drift(candidate);
  const Method& method = candidate.method();
  const bool by_verlet_alone = method.energy_ideal == EnergyClaim::exact;
  const bool theory_applies = by_verlet_alone && method.pair_law_exact;
  const auto all = measured(conditions.depth, records);
  if (all.empty()) return every_run_broke(conditions, records);
  const auto large = along_steps(all, usual_capacity), small = along_steps(all, small_capacity);
  const auto still = along_steps(all, usual_capacity, 0);
  Conclusion conclusion;
  conclusion.findings = {
      sign_finding(all, theory_applies),
      power_finding(fmt::format("power of the step, phi/k = {:g}", usual_capacity), "the step",
                    large, step_of, 4, theory_applies),
      power_finding(fmt::format("power of the step, phi/k = {:g}", small_capacity), "the step",
                    small, step_of, 4, theory_applies),
      power_finding("power of the friction", "the friction", along_frictions(all), friction_of, 1,
                    theory_applies),
      frictionless_finding(along_frictions(all)),
      power_finding("power of the step without friction", "the step, without friction", still,
                    step_of, 4, false),
      prefactor_finding(large),
      fluctuation_finding(all, theory_applies)};
  if (by_verlet_alone) {
    conclusion.findings.push_back(bias_finding(large, small, method.pair_law_exact));
  }
  for (auto& finding : failures(conditions, records)) conclusion.findings.push_back(finding);
  conclusion.charts = charts(all);
  return conclusion;
}

}  // namespace

const Examination drift = {
    "drift", "Law of the energy drift",
    "How does the total energy of a soft fluid (a = 25, density 3, closure noise, no conduction) "
    "drift? For methods whose friction keeps energy and the exact law, theory says that the drift "
    "is "
    "the Verlet step's alone: positive, of fourth order in the step, proportional to friction, "
    "with a "
    "variance of 2 kT times the mean; its size is worked out from configurations, without any "
    "integrator. Such methods are held to it; of the others the same numbers are reported. Methods "
    "whose friction keeps energy but not the law are fitted with a further term of third order in "
    "the "
    "step and first in k/phi.",
    parts, conclude};

}  // namespace driftless::judge
