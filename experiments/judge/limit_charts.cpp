#include "experiments/judge/limit_charts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/deviations.hpp"
#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

Series deviations_by_step(std::string name, const LimitCase& asked) {
  Series series{std::move(name), {}};
  const double scale = asked.observable.is_relative ? 100 : 1;
  for (const auto& point : points_of(asked)) {
    const double reach = point.error * student_quantile(point.degrees_of_freedom, 0.025) * scale;
    const double value = point.value * scale;
    series.points.push_back({point.time_step, value, value - reach, value + reach});
  }
  return series;
}

std::string series_name(const LimitCase& asked) {
  if (asked.scene.family == Family::soft) return asked.observable.words;
  const auto& f = asked.scene.fluid.parameters();
  const bool other = f.has_conduction() && f.heat_form != HeatForm::inverse_temperature;
  return fmt::format("{} closure, phi/k = {:g}{}", to_string(f.friction_closure),
                     f.heat_capacity / f.boltzmann,
                     other ? fmt::format(", {} form", to_string(f.heat_form)) : "");
}

Chart empty_chart(const LimitCase& asked) {
  const bool soft = asked.scene.family == Family::soft;
  return {soft ? "averages by time step, " + asked.scene.name
               : asked.observable.words + " by time step, " + to_string(asked.scene.family),
          {"time step", true},
          {"deviation from the exact value, %"},
          {}};
}

}  // namespace

void LimitCharts::add(const LimitCase& asked) {
  const bool shown = asked.scene.family == Family::soft
                         ? asked.observable.is_relative
                         : asked.observable.name == "internal_energy_variance";
  if (!shown) return;
  auto series = deviations_by_step(series_name(asked), asked);
  if (series.points.empty()) return;
  auto wanted = empty_chart(asked);
  auto found = std::find_if(charts_.begin(), charts_.end(),
                            [&](const Chart& chart) { return chart.title == wanted.title; });
  if (found == charts_.end()) found = charts_.insert(charts_.end(), std::move(wanted));
  found->series.push_back(std::move(series));
}

void add_trade(const LimitCase& asked, const Records& records, Table& table) {
  const auto timed = records.find(timing_name(asked.scene));
  if (timed == records.end()) return;
  const auto costs = timed->second["seconds_per_time"].get<std::vector<double>>();
  for (std::size_t step = 0; step < asked.cells.size(); ++step) {
    const auto& cell = asked.cells[step];
    const auto found = cell.value(asked.observable.name);
    if (!found || cell.failed > 0 || !(costs[step] > 0)) continue;
    const nlohmann::json entry = {{"mean", found->value},
                                  {"exact", 0},
                                  {"exact_error", cell.reference_error(asked.observable.name)}};
    const auto size =
        deviation(asked.observable.name, entry, {found->error, found->degrees_of_freedom});
    table.rows.push_back({asked.scene.name, asked.observable.name, cell.time_step, costs[step],
                          size["value"].get<double>(), size["lower"].get<double>(),
                          size["upper"].get<double>()});
  }
}

}  // namespace driftless::judge
