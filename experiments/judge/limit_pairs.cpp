#include <fmt/format.h>

#include <cmath>

#include "experiments/judge/limit_scenes.hpp"
#include "experiments/judge/two_body/measure.hpp"

// Isolated pairs at a fixed distance: everything relaxes in about one unit of time, what is known
// of the noise is taken out of the averages, and a pair that fails takes no other along. So of all
// scenes they see the smallest errors, and they see methods at low heat capacities at all.
namespace driftless::judge {
namespace {

using nlohmann::json;
using two_body::Bench;

constexpr const char* observables[two_body::moments] = {"kinetic_temperature",
                                                        "kinetic_energy_square",
                                                        "internal_energy_variance",
                                                        "internal_energy_third",
                                                        "difference",
                                                        "difference_square",
                                                        "difference_fourth"};

constexpr std::size_t pairs_per_ensemble = 50;

json run(const Bench& bench, const Candidate& candidate, const two_body::Schedule& schedule) {
  const auto pairs = schedule.ensembles * schedule.pairs.count;
  try {
    const auto outcome = two_body::measure(
        bench, [&] { return candidate.make(); }, schedule);
    json record = {{"runs", pairs},
                   {"failed", std::lround(outcome.failed_fraction * static_cast<double>(pairs))},
                   {"observables", json::object()}};
    for (int m = 0; m < two_body::moments; ++m) {
      const auto& found = outcome.deviations[static_cast<std::size_t>(m)];
      if (!std::isfinite(found.mean) || !std::isfinite(found.error)) continue;
      record["observables"][observables[m]] = {{"value", found.mean}, {"error", found.error}};
    }
    return record;
  } catch (const StepFailure& failure) {
    return {{"runs", pairs},
            {"failed", pairs},
            {"failure", {{"cause", to_string(failure.cause())}}},
            {"observables", json::object()}};
  }
}

LimitScene scene(double phi_over_k, FrictionClosure closure, HeatForm form,
                 const Conditions& conditions) {
  // At low heat capacities a noise that is large beside u makes explicit methods fail.
  const double coarsest = phi_over_k > 50 ? 0.2 : phi_over_k > 10 ? 0.1 : 0.05;
  const Bench bench = two_body::make_bench(phi_over_k, closure, form);
  two_body::Schedule schedule;
  schedule.settle = 5;
  schedule.measure = 20;
  const bool quick = conditions.depth == Depth::quick;
  const std::size_t ensembles = phi_over_k > 50 ? 80 : phi_over_k > 10 ? 40 : 24;
  schedule.ensembles = quick ? ensembles : 2 * ensembles;
  schedule.pairs.count = pairs_per_ensemble;
  LimitScene result{Family::pairs,
                    fmt::format("isolated pairs, {} closure, {} form of conduction, phi/k = {:g}",
                                to_string(closure), to_string(form), phi_over_k),
                    bench.fluid,
                    {coarsest, coarsest / 2, coarsest / 4, coarsest / 16},
                    quick ? 1U : 8U,
                    0,
                    {}};
  constexpr double seconds_per_pair_step = 2.5e-7;
  result.cost_per_inverse_step =
      seconds_per_pair_step * 25 * static_cast<double>(schedule.ensembles * schedule.pairs.count);
  const auto seed = conditions.seed;
  result.run = [bench, schedule, seed](const Candidate& candidate, double time_step,
                                       unsigned number) {
    auto own = schedule;
    own.dt = time_step;
    own.pairs.seed = seed * 1000 + number;
    return driftless::judge::run(bench, candidate, own);
  };
  return result;
}

}  // namespace

std::vector<LimitScene> pair_limit_scenes(const Conditions& conditions) {
  std::vector<LimitScene> all;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const double phi_over_k : {100.0, 20.0, 5.0}) {
      all.push_back(scene(phi_over_k, closure, HeatForm::inverse_temperature, conditions));
    }
    all.push_back(scene(20, closure, HeatForm::temperature, conditions));
  }
  return all;
}

}  // namespace driftless::judge
