#include "experiments/judge/noise_free.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>

#include "experiments/order_fit.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

/// Differences below are the reference's own, or rounding.
constexpr double floor_of_differences = 1e-8;

double inverse_mean_temperature(const Fluid& fluid, const State& state) {
  double sum = 0;
  for (const double u : state.internal_energy) sum += 1 / fluid.temperature(u);
  return static_cast<double>(state.size()) / sum;
}

/// Where the ends of runs tend to as the step shrinks, from the two finest, one at half the other's
/// step: of an error of first order nothing is left, of a higher one less than before.
State extrapolated(const State& fine, const State& coarse) {
  State limit = fine;
  const Box box = small_box();
  for (std::size_t i = 0; i < fine.size(); ++i) {
    limit.position[i] =
        box.wrap(fine.position[i] + box.minimum_image(fine.position[i] - coarse.position[i]));
    limit.velocity[i] = 2 * fine.velocity[i] - coarse.velocity[i];
    limit.internal_energy[i] = 2 * fine.internal_energy[i] - coarse.internal_energy[i];
  }
  return limit;
}

double norm(const Fluid& fluid, const State& state, const State& exact) {
  const Box box = small_box();
  double squares = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    squares += box.minimum_image(state.position[i] - exact.position[i]).squaredNorm() +
               (state.velocity[i] - exact.velocity[i]).squaredNorm() +
               std::pow(fluid.temperature(state.internal_energy[i] - exact.internal_energy[i]), 2);
  }
  return std::sqrt(squares / static_cast<double>(state.size()));
}

Differences differences(const Fluid& fluid, const State& state, const State& exact) {
  const Box box = small_box();
  const auto d = distance(box, state, exact);
  System one(fluid, box, state, Noise(0, 0)), other(fluid, box, exact, Noise(0, 0));
  return {d.position,
          d.velocity,
          d.internal_energy,
          std::abs(one.total_energy() - other.total_energy()),
          std::abs(one.kinetic_energy() - other.kinetic_energy()),
          std::abs(inverse_mean_temperature(fluid, state) - inverse_mean_temperature(fluid, exact)),
          norm(fluid, state, exact)};
}

/// The end of a run, or why there is none.
struct Run {
  std::optional<State> end;
  json failure;
};

Run run_case(const Method& method, const Options& options, const FluidParameters& fluid,
             const State& start, int steps, std::uint64_t seed) {
  System system(Fluid(fluid), small_box(), start, Noise(seed, 0));
  const auto integrator = method.make(options);
  const double time_step = noise_free_duration / steps;
  for (int n = 1; n <= steps; ++n) {
    try {
      system.set_step(static_cast<std::uint64_t>(n));
      integrator->step(system, time_step);
    } catch (const StepFailure& failure) {
      return {std::nullopt,
              {{"cause", to_string(failure.cause())}, {"step", n}, {"time_step", time_step}}};
    }
  }
  return {system.state(), nullptr};
}

Averaged averaged(const std::vector<double>& values) {
  Averaged result;
  result.starts = static_cast<unsigned>(values.size());
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / count;
  double squares = 0;
  for (const double value : values) squares += std::pow(value - result.mean, 2);
  result.error = values.size() < 2 ? std::numeric_limits<double>::infinity()
                                   : std::sqrt(squares / (count - 1) / count);
  return result;
}

/// Averages over the starts one place of what was recorded of each.
Averaged at(const json& starts, Difference which, std::size_t place) {
  std::vector<double> values;
  for (const auto& start : starts) values.push_back(start[place][static_cast<std::size_t>(which)]);
  return averaged(values);
}

/// The slope over the places, each of half the step of the one before.
Averaged order(const json& starts, Difference which) {
  std::vector<double> orders;
  for (const auto& start : starts) {
    std::vector<Deviation> deviations;
    double step = 1;  // a common factor of the steps does not matter
    for (const auto& found : start) {
      const double value = found[static_cast<std::size_t>(which)];
      if (value > floor_of_differences) deviations.push_back({step, value, 0});
      step /= 2;
    }
    if (deviations.size() < start.size()) return {};
    const auto fit = fit_order(deviations);
    if (fit) orders.push_back(fit->order);
  }
  return averaged(orders);
}

}  // namespace

double Averaged::half_width() const { return student_quantile(starts - 1.0, 0.025) * error; }
double Averaged::certain() const {
  constexpr double beyond = 2.87e-7;  // one side of five standard errors
  return student_quantile(starts - 1.0, beyond) * error;
}

NoiseFreePlan noise_free_plan(const Conditions& conditions) {
  NoiseFreePlan plan;
  plan.seed = conditions.seed;
  if (conditions.depth == Depth::full) plan = {60, {200, 400, 800, 1600, 3200, 6400}, plan.seed};
  return plan;
}

const State& noise_free_reference(const Terms& terms, std::uint64_t seed) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::uint64_t>, State> solved;
  const auto key = std::pair(terms.name(), seed);
  {
    const std::lock_guard lock(mutex);
    if (const auto found = solved.find(key); found != solved.end()) return found->second;
  }
  const auto fluid = small_fluid(terms, 0);
  auto state = reference_solution(Fluid(fluid), small_box(), small_state(fluid, seed), false,
                                  noise_free_duration);
  const std::lock_guard lock(mutex);
  return solved.emplace(key, std::move(state)).first->second;
}

const std::vector<Terms>& noise_free_cases() {
  static const auto cases = [] {
    std::vector<Terms> all;
    for (const bool potential : {false, true}) {
      for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
        for (const auto heat : all_heat_forms()) all.push_back({closure, heat, potential});
      }
    }
    return all;
  }();
  return cases;
}

json noise_free_record(const Method& method, const Options& options, const Terms& terms,
                       const NoiseFreePlan& plan) {
  const auto fluid = small_fluid(terms, 0);
  json record = {{"differences", json::array()}, {"limits", json::array()}};
  for (unsigned n = 0; n < plan.starts; ++n) {
    const std::uint64_t seed = plan.seed + n;
    const State start = small_state(fluid, seed);
    const State& exact = noise_free_reference(terms, seed);
    json found = json::array(), limits = json::array();
    std::optional<State> coarse, fine;
    for (const int steps : plan.steps) {
      auto run = run_case(method, options, fluid, start, steps, seed);
      if (!run.end) {
        record["failure"] = run.failure;
        return record;
      }
      coarse = std::move(fine);
      fine = std::move(run.end);
      found.push_back(differences(Fluid(fluid), *fine, exact));
      if (coarse) {
        limits.push_back(differences(Fluid(fluid), extrapolated(*fine, *coarse), exact));
      }
    }
    record["differences"].push_back(found);
    record["limits"].push_back(limits);
  }
  return record;
}

Averaged noise_free_difference(const json& record, Difference which, std::size_t place) {
  return at(record["differences"], which, place);
}

Averaged noise_free_limit(const json& record, Difference which) {
  return at(record["limits"], which, record["limits"][0].size() - 1);
}

Averaged noise_free_order(const json& record, Difference which) {
  return order(record["differences"], which);
}

Averaged noise_free_limit_order(const json& record, Difference which) {
  return order(record["limits"], which);
}

}  // namespace driftless::judge
