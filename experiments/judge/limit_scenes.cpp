#include "experiments/judge/limit_scenes.hpp"

namespace driftless::judge {
namespace {

/// At depth full and at depth quick.
struct Tolerance {
  double full, quick;
};

// A fault of the fluctuation-dissipation balance by a few per cent of k/phi shows in a temperature
// as so much, in a variance as a few times that.
constexpr Tolerance temperature = {0.01, 0.05}, variance = {0.03, 0.15}, skewness = {0.05, 0.25};
constexpr double distance = 0.009;  // that of the laws of two variances 10 % apart

LimitObservable ratio(const char* name, const char* words, Tolerance tolerance) {
  return {name, words, tolerance.full, tolerance.quick};
}

LimitObservable number(const char* name, const char* words, Tolerance tolerance) {
  return {name, words, tolerance.full, tolerance.quick, false, false};
}

LimitObservable square(const char* name, const char* words) {
  return {name, words, distance * distance, distance * distance, true, false};
}

std::vector<LimitObservable> ideal() {
  return {ratio("kinetic_temperature", "the kinetic temperature", temperature),
          ratio("internal_temperature", "the internal temperature", temperature),
          ratio("internal_energy_variance", "the variance of u", variance),
          number("internal_energy_skewness", "the skewness of u", skewness),
          square("internal_energy_distance", "the distribution of u"),
          square("momentum_distance", "the distribution of momenta")};
}

std::vector<LimitObservable> soft() {
  auto all = ideal();
  all.push_back(
      ratio("kinetic_share", "the kinetic share of kinetic plus internal energy", temperature));
  all.push_back(
      ratio("configurational_temperature", "the configurational temperature", temperature));
  all.push_back(ratio("internal_energy_mean", "the mean of u", temperature));
  all.push_back(ratio("potential_energy", "the potential energy", temperature));
  all.push_back(ratio("pressure", "the pressure", temperature));
  return all;
}

std::vector<LimitObservable> pairs() {
  return {ratio("kinetic_temperature", "the kinetic temperature", temperature),
          ratio("kinetic_energy_square", "the mean square of the kinetic energy", variance),
          ratio("internal_energy_variance", "the variance of u", variance),
          number("internal_energy_third", "the third moment of u (in cubed deviations)", skewness),
          number("difference", "the mean of u_i - u_j (in deviations)", {0.03, 0.15}),
          ratio("difference_square", "the mean square of u_i - u_j", variance),
          ratio("difference_fourth", "the mean fourth power of u_i - u_j", variance)};
}

}  // namespace

const std::vector<LimitObservable>& limit_observables(Family family) {
  static const auto of_pairs = pairs(), of_ideal = ideal(), of_soft = soft();
  if (family == Family::pairs) return of_pairs;
  return family == Family::soft ? of_soft : of_ideal;
}

std::string to_string(Family family) {
  switch (family) {
    case Family::pairs:
      return "isolated pairs";
    case Family::conducting:
      return "ideal fluid with conduction";
    case Family::not_conducting:
      return "ideal fluid without conduction";
    case Family::soft:
      break;
  }
  return "soft fluid";
}

std::vector<LimitScene> limit_scenes(const Conditions& conditions) {
  auto all = pair_limit_scenes(conditions);
  for (auto& scene : fluid_limit_scenes(conditions)) all.push_back(std::move(scene));
  return all;
}

}  // namespace driftless::judge
