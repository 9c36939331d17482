#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/study_parts.hpp"
#include "experiments/value_rule.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr double fewest_samples = 10, most_samples = 1e7;
constexpr double most_steps = 1e12;  // the noise counts steps in 40 bits
constexpr double tolerance = 1e-9;   // relative, of a whole number of steps or samples
constexpr std::size_t most_time_steps = 1000;

const std::vector<Field>& duration_fields() {
  static const std::vector<Field> fields = {
      {"equilibrate", ValueRule::not_negative(), true, "simulated time before the first sample"},
      {"measure", ValueRule::positive(), true, "simulated time with samples"},
      {"sample_every", ValueRule::positive(), true,
       "simulated time between samples; every time step divides it"},
  };
  return fields;
}

const std::vector<Field>& ladder_fields() {
  static const std::vector<Field> fields = {
      {"from", ValueRule::positive(), true, "the smallest step"},
      {"to", ValueRule::positive(), true, "the largest step"},
      {"count", ValueRule::integer(2, most_time_steps), true, "how many steps"},
      {"spacing", ValueRule::word({"log", "linear"}), false,
       "whether the steps' ratios or their differences are alike; log if not given"},
  };
  return fields;
}

/// How many parts make the whole, if it is a whole number.
std::optional<double> whole_number(double whole, double part) {
  const double count = std::round(whole / part);
  const bool divides = count >= 1 && std::abs(count * part - whole) <= tolerance * whole;
  return divides ? std::optional(count) : std::nullopt;
}

/// The step nearest to `step` that divides `whole`.
double nearest_divisor(double whole, double step) {
  const double fewer = std::max(1.0, std::floor(whole / step)), more = fewer + 1;
  return std::abs(whole / fewer - step) <= std::abs(whole / more - step) ? whole / fewer
                                                                         : whole / more;
}

/// A duration is a whole number of samples.
void check_multiple(double value, double sample_every, const Location& location) {
  if (value == 0 || whole_number(value, sample_every)) return;
  const double near = std::max(1.0, std::round(value / sample_every)) * sample_every;
  location.refuse(fmt::format("is {}, no multiple of sample_every {}; allowed is for example {}",
                              describe(value), describe(sample_every), describe(near)));
}

void check_step(double step, const Location& location, const Study& study) {
  if (!whole_number(study.sample_every, step)) {
    location.refuse(fmt::format(
        "is {}, which does not divide duration.sample_every {}; allowed is a step that fits a "
        "whole number of times, the nearest is {}",
        describe(step), describe(study.sample_every),
        describe(nearest_divisor(study.sample_every, step))));
  }
  const double steps = (study.equilibrate + study.measure) / step;
  if (steps > most_steps) {
    location.refuse(fmt::format("is {}, which takes {:.3g} steps; allowed is at most 1e12 of them",
                                describe(step), steps));
  }
}

bool alike(double a, double b) { return std::abs(a - b) <= tolerance * std::max(a, b); }

std::vector<double> read_list(const json& list, const Location& location, const Study& study) {
  if (list.empty() || list.size() > most_time_steps) {
    location.refuse("is " + describe(list) + "; allowed is 1 to 1000 numbers > 0, or an object " +
                    "with from, to and count");
  }
  std::vector<double> steps;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Location place = location.element(i);
    ValueRule::positive().check(list[i], place);
    const auto step = list[i].get<double>();
    check_step(step, place, study);
    for (const double other : steps) {
      if (!alike(step, other)) continue;
      place.refuse("is " + describe(step) + " a second time; allowed is each time step once");
    }
    steps.push_back(step);
  }
  return steps;
}

std::vector<double> read_ladder(const json& ladder, const Location& location, const Study& study) {
  check_fields(ladder, location, "a ladder of time steps", ladder_fields());
  const auto from = ladder["from"].get<double>(), to = ladder["to"].get<double>();
  const auto count = to_integer(ladder["count"]);
  if (from >= to) {
    location.member("from").refuse("is " + describe(from) + "; allowed is a number > 0 and below " +
                                   "to, which is " + describe(to));
  }
  check_step(from, location.member("from"), study);
  check_step(to, location.member("to"), study);
  const bool linear = ladder.value("spacing", "log") == "linear";
  std::vector<double> steps = {from};
  for (std::uint64_t i = 1; i + 1 < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double step = linear ? from + share * (to - from) : from * std::pow(to / from, share);
    steps.push_back(nearest_divisor(study.sample_every, step));
  }
  steps.push_back(to);
  const auto crowded = std::adjacent_find(steps.begin(), steps.end(), alike);
  if (crowded != steps.end()) {
    location.member("count").refuse(fmt::format(
        "is {}, more steps than divide duration.sample_every {} near {}; allowed is fewer", count,
        describe(study.sample_every), describe(*crowded)));
  }
  return steps;
}

}  // namespace

void read_duration(const json& value, const Location& location, Study& study) {
  require_object(value, location, "{\"equilibrate\": 10, \"measure\": 100, \"sample_every\": 0.5}");
  check_fields(value, location, "a duration", duration_fields());
  study.equilibrate = value["equilibrate"].get<double>();
  study.measure = value["measure"].get<double>();
  study.sample_every = value["sample_every"].get<double>();
  const double samples = study.measure / study.sample_every;
  if (samples < fewest_samples * (1 - tolerance) || samples > most_samples * (1 + tolerance)) {
    location.member("sample_every")
        .refuse(fmt::format("is {}, which makes {:.4g} samples of measure {}; allowed is a number "
                            "from {} to {}",
                            describe(study.sample_every), samples, describe(study.measure),
                            describe(study.measure / most_samples),
                            describe(study.measure / fewest_samples)));
  }
  check_multiple(study.measure, study.sample_every, location.member("measure"));
  check_multiple(study.equilibrate, study.sample_every, location.member("equilibrate"));
}

std::vector<double> read_time_steps(const json& value, const Location& location,
                                    const Study& study) {
  if (value.is_array()) return read_list(value, location, study);
  require_object(value, location,
                 "{\"from\": 0.01, \"to\": 0.16, \"count\": 5} or a list of numbers > 0");
  return read_ladder(value, location, study);
}

std::uint64_t steps_per_sample(const Study& study, double time_step) {
  return static_cast<std::uint64_t>(std::llround(study.sample_every / time_step));
}

json duration_schema() { return fields_schema(duration_fields()); }

json time_steps_schema() {
  return {{"anyOf",
           {{{"type", "array"},
             {"items", ValueRule::positive().schema()},
             {"minItems", 1},
             {"maxItems", most_time_steps},
             {"uniqueItems", true}},
            fields_schema(ladder_fields())}}};
}

}  // namespace driftless
