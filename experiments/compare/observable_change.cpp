#include "experiments/compare/observable_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/statistics.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr double conserved_below = 1e-9, broken_above = 1e-7;  // kT, or sqrt(m kT), per particle
constexpr double surely = 5;  // standard errors, of a number that is to be rounding alone

// A reference value is measured by a Monte Carlo run of a few hundred samples, which know their
// error at least so well.
constexpr double reference_degrees_of_freedom = 20;

bool is_distance(const std::string& name) { return name.ends_with("_distance"); }

bool is_number_of_its_own(const std::string& name) {
  return is_distance(name) || name.ends_with("_skewness");
}

const json& entry_of(const json& cell, const std::string& observable) {
  return cell["observables"][observable];
}

Measurement measurement(const std::string& observable, const json& entry) {
  const double mean = entry["mean"], widened = entry["error"];
  if (observable == "energy_walk") {
    return {mean, widened, std::max(1.0, entry.value("effective_samples", 1.0))};
  }
  const double freedom = entry.value("degrees_of_freedom", std::numeric_limits<double>::infinity());
  return {mean, widened / student_factor(freedom), freedom};
}

Measurement as_deviation(Measurement measured, const json& entry) {
  measured.mean -= entry["exact"].get<double>();
  if (const double error = entry.value("exact_error", 0.0); error > 0) {
    measured.error = std::hypot(measured.error, error);
    measured.degrees_of_freedom =
        std::min(measured.degrees_of_freedom, reference_degrees_of_freedom);
  }
  return measured;
}

bool energies_differ(const CommonCell& cell) {
  const double base = cell.base_scene->value("energy_per_particle", 0.0);
  const double changed = cell.new_scene->value("energy_per_particle", 0.0);
  return std::abs(base - changed) > 1e-9 * std::max(std::abs(base), std::abs(changed));
}

/// The unit in which a difference is an effect.
double scale_of(const std::string& observable, const json& base, const Run& run) {
  if (observable == "energy_drift") return 1 / run.measured_time;
  if (observable == "energy_walk") return run.particles / run.measured_time;
  if (is_number_of_its_own(observable)) return 1;
  const double size =
      std::abs(base.contains("exact") ? base["exact"].get<double>() : base["mean"].get<double>());
  return size > 0 ? size : 1;
}

std::optional<double> error_growth(const std::string& observable, const json& base,
                                   const json& changed) {
  const double one = base["mean"], other = changed["mean"];
  if (observable == "energy_walk" || is_distance(observable)) return other - one;
  if (!base.contains("exact") || !changed.contains("exact")) return std::nullopt;
  return std::abs(other - changed["exact"].get<double>()) -
         std::abs(one - base["exact"].get<double>());
}

/// The most, in kT or sqrt(m kT) per particle, that a conserved number may have moved in a run.
double largest_loss(const std::string& observable, const json& entry, const Run& run) {
  const double mean = entry["mean"], error = entry["error"];
  if (observable == "energy_drift") return (std::abs(mean) + surely * error) * run.measured_time;
  if (observable == "energy_walk") {
    return std::sqrt((mean + surely * error) * run.measured_time / run.particles);
  }
  return mean;
}

}  // namespace

double ObservableChange::effect_of(double size) const {
  return is_square ? std::sqrt(size / scale) : size / scale;
}

double ObservableChange::effect() const { return effect_of(std::abs(difference.value)); }
double ObservableChange::base_effect() const { return effect_of(std::abs(base)); }
const char* ObservableChange::grows() const { return is_share ? "deviation" : "size"; }

std::optional<ObservableChange> observable_change(const std::string& observable,
                                                  const CommonCell& cell, const Run& run) {
  if (observable == "momentum_error") return std::nullopt;  // a maximum, which has no error
  const json& base = entry_of(*cell.base, observable);
  const json& changed = entry_of(*cell.changed, observable);
  if (!base["mean"].is_number() || !changed["mean"].is_number()) return std::nullopt;
  Measurement one = measurement(observable, base), other = measurement(observable, changed);
  if (energies_differ(cell) && observable != "energy_walk") {
    if (!base.contains("exact") || !changed.contains("exact")) return std::nullopt;
    one = as_deviation(one, base);
    other = as_deviation(other, changed);
  }
  const bool is_walk = observable == "energy_walk";
  ObservableChange change;
  change.difference = is_walk ? difference_of_variances(one, other) : difference(one, other);
  change.base = one.mean;
  change.changed = other.mean;
  change.scale = scale_of(observable, base, run);
  change.is_square = is_walk || is_distance(observable);
  change.is_share = !is_walk && observable != "energy_drift" && !is_number_of_its_own(observable);
  change.growth = error_growth(observable, base, changed);
  return change;
}

std::optional<std::string> conservation_verdict(const std::string& observable,
                                                const CommonCell& cell, const Run& run) {
  if (observable != "momentum_error" && observable != "energy_drift" &&
      observable != "energy_walk") {
    return std::nullopt;
  }
  const double base = largest_loss(observable, entry_of(*cell.base, observable), run);
  const double changed = largest_loss(observable, entry_of(*cell.changed, observable), run);
  if (base < conserved_below && changed > broken_above) return "worse";
  if (changed < conserved_below && base > broken_above) return "better";
  if (base < broken_above && changed < broken_above) return "same";
  return std::nullopt;
}

}  // namespace driftless
