#include "experiments/reproduce/soleymani_2020.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftless::reproduce::so20 {

using nlohmann::json;

MethodChoice leading_method(const Conditions& conditions) {
  return conditions.method_or(published);
}

std::vector<MethodChoice> methods(const Conditions& conditions) {
  return conditions.methods_or(published, {contrast});
}

std::string Combination::name() const {
  const std::string heat =
      heat_form == HeatForm::temperature ? "temperature" : "inverse-temperature";
  const std::string strength = thermal_repulsion != 0
                                   ? fmt::format("repulsion a = {:g} T", thermal_repulsion)
                               : repulsion == 0 ? "no repulsion"
                                                : fmt::format("repulsion a = {:g}", repulsion);
  return strength + ", heat form " + heat;
}

const std::vector<Combination>& combinations() {
  static const std::vector<Combination> all = {{0, HeatForm::inverse_temperature},
                                               {0, HeatForm::temperature},
                                               {25, HeatForm::inverse_temperature},
                                               {25, HeatForm::temperature}};
  return all;
}

const std::vector<Combination>& all_combinations() {
  static const std::vector<Combination> all = [] {
    auto list = combinations();
    for (const auto form : {HeatForm::inverse_temperature, HeatForm::temperature}) {
      list.push_back({0, form, 25});
    }
    return list;
  }();
  return all;
}

std::optional<std::string> unsuited(const MethodChoice& method) {
  std::vector<FluidParameters> fluids;
  for (const auto& combination : combinations()) fluids.push_back(fluid_of(combination));
  return first_refusal(method, fluids);
}

bool runs(const MethodChoice& method, const Combination& combination) {
  return !first_refusal(method, {fluid_of(combination)});
}

std::vector<MethodChoice> methods_for(const Combination& combination,
                                      const Conditions& conditions) {
  auto all = methods(conditions);
  std::erase_if(all, [&](const MethodChoice& one) { return !runs(one, combination); });
  return all;
}

FluidParameters fluid_of(const Combination& combination) {
  return {.boltzmann = 1,
          .mass = 1,
          .temperature = 1,
          .heat_capacity = 60,
          .repulsion = combination.repulsion,
          .thermal_repulsion = combination.thermal_repulsion,
          .repulsion_range = 1,
          .friction = 4.5,
          .friction_closure = FrictionClosure::noise,
          .friction_range = 1,
          .conduction = 300,
          .heat_form = combination.heat_form,
          .heat_range = 1,
          .weight_exponent = 2};
}

flux::PeriodicFluid box_of(const Combination& combination, const MethodChoice& method,
                           const Conditions& conditions) {
  flux::PeriodicFluid fluid;
  fluid.fluid = fluid_of(combination);
  fluid.lengths = conditions.effort == Effort::quick ? Vector(4, 4, 14) : Vector(6, 6, 20);
  fluid.method = method;
  fluid.seed = conditions.seed;
  return fluid;
}

flux::SlabRun slabs_of(const flux::PeriodicFluid& fluid, double heat_flux, Effort effort) {
  flux::SlabRun run;
  run.fluid = fluid;
  run.heat_flux = heat_flux;
  const double length = fluid.lengths[2];
  run.bins = static_cast<std::size_t>(std::llround(2 * length));
  // About seven relaxation times of the longest wave of temperature.
  run.settle = std::round(0.4 * length * length);
  run.duration = effort == Effort::quick ? 150 : 800;
  return run;
}

double equilibrium_duration(Effort effort) { return effort == Effort::quick ? 36 : 240; }

double cost_of(const flux::PeriodicFluid& fluid, double duration) {
  const double particle_step = 6e-8 * (2 + fluid.density) * (fluid.fluid.repulsion == 0 ? 1 : 1.3);
  return particle_step * static_cast<double>(fluid.particles()) * duration / fluid.step;
}

json or_failure(const std::function<json()>& work) {
  try {
    return work();
  } catch (const StepFailure& failure) {
    return {{"failure", to_string(failure.cause())}};
  }
}

bool failed(const json& record) { return record.contains("failure"); }

const json* record_or_remark(const Records& records, const std::string& part, Outcome& outcome) {
  const json& record = records.at(part);
  if (!failed(record)) return &record;
  outcome.remarks.push_back(part + " failed: " + record["failure"].get<std::string>() + ".");
  return nullptr;
}

Interval interval_of(const json& estimate) {
  const double mean = estimate.at("mean");
  // An infinite error is null in JSON.
  const auto& error = estimate.at("error");
  const double half = interval_quantile * (error.is_null() ? HUGE_VAL : error.get<double>());
  return {mean, mean - half, mean + half};
}

judge::Point point_of(double x, const Interval& interval) {
  return {x, interval.value, interval.low, interval.high};
}

Interval exactly(double value) { return {value, value, value}; }

std::string setting_of(const std::string& name, const MethodChoice& method,
                       const std::string& more) {
  return fmt::format("{}; {}, step 0.01{}{}", name, to_string(method), more.empty() ? "" : "; ",
                     more);
}

Row about_row(std::string quantity, std::string setting, std::string words,
              const std::vector<RatioAt>& ratios) {
  constexpr double about = 0.25;
  const auto off = [](const RatioAt& one) { return std::abs(one.ratio.value - 1); };
  const auto farthest = std::max_element(
      ratios.begin(), ratios.end(),
      [&](const RatioAt& one, const RatioAt& other) { return off(one) < off(other); });
  Row row{std::move(quantity), std::move(setting), "1", Interval{1, 1 - about, 1 + about},
          std::move(words),    farthest->ratio};
  row.verdict = compare(row.ours, *row.paper, about);
  row.explanation = fmt::format("Of {} the one farthest from 1: {}. What is within {:g} % agrees.",
                                ratios.size(), farthest->where, 100 * about);
  return row;
}

std::vector<std::string> common_remarks(const Conditions& conditions) {
  const auto fluid = box_of(combinations().front(), published, conditions);
  const auto run = slabs_of(fluid, 1, conditions.effort);
  return {
      "The paper's parameters are not known to us. Chosen: m = k = r_c = 1, density 3, mean "
      "temperature 1, friction 4.5 at T = 1 with the noise closure, heat capacity 60 k, conduction "
      "300 (so that conduction and diffusion carry comparable heat), weights (1 - r)^2, repulsion "
      "a = 0 or 25 (in Fig. 2 and 3 also 25 T), time step 0.01.",
      fmt::format("Periodic box of {:g} x {:g} x {:g}; hot and cold slab of thickness 1 across z, "
                  "a quarter and three quarters up the box. Every step the internal energies of "
                  "the hot slab receive and those of the cold slab give the same heat, shared "
                  "equally by a slab's particles; energy in is energy stored to rounding.",
                  fluid.lengths[0], fluid.lengths[1], fluid.lengths[2]),
      fmt::format("Measured for {:g} units of time after {:g}; errors count autocorrelation.",
                  run.duration, run.settle)};
}

}  // namespace driftless::reproduce::so20
