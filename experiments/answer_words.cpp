#include "experiments/answer_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/deviations.hpp"
#include "experiments/observables.hpp"

namespace driftless {
namespace {

std::string subject(const Choice& choice) {
  const std::string& observable = choice.observable;
  if (observable == equilibrium_observable) {
    if (choice.isothermal) return "the kinetic temperature";
    return "temperatures and the variance of the internal energy";
  }
  std::string words = observable;
  std::replace(words.begin(), words.end(), '_', ' ');
  return "the " + words;
}

std::string unit_of(const std::string& observable) {
  const std::string unit(observable_spec(observable).unit);
  return unit == "1" ? "" : " " + unit;
}

std::string at(const Candidate& candidate) {
  return fmt::format("{} at step {:g}", candidate.method, candidate.time_step);
}

/// So many digits, and all before the point.
std::string number(double value, int digits) {
  return std::abs(value) < std::pow(10.0, digits) - 0.5 ? fmt::format("{:.{}g}", value, digits)
                                                        : fmt::format("{:.0f}", value);
}

/// Up to the next number of two digits: a bound is never rounded below itself.
double rounded_up(double value) {
  if (!(value > 0)) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return unit * std::ceil(value / unit * (1 - 1e-12));
}

constexpr const char* other_limit = "but its limit is not the model";

/// Why nothing is shown.
std::string nothing(const Choice& choice) {
  if (choice.lacks_exact_value) return "it has no exact value there to compare with";
  std::string text = "no method and step of this study is shown to be";
  if (choice.resolution) {
    text += "; " + resolution_text(choice);
  }
  return text;
}

}  // namespace

std::string percent(double share) { return number(100 * share, 2) + " %"; }

std::string deviation_text(const std::string& observable, double value) {
  if (is_relative(observable)) return percent(value);
  return number(value, 2) + unit_of(observable);
}

std::string bound_text(const std::string& observable, double bound) {
  return deviation_text(observable, rounded_up(bound));
}

std::string tolerance_text(const std::string& observable, double tolerance) {
  if (is_relative(observable)) return fmt::format("{:g} %", 100 * tolerance);
  return fmt::format("{:g}{}", tolerance, unit_of(observable));
}

std::string cost_text(double core_seconds_per_time) {
  return number(core_seconds_per_time, 3) + " core-s per unit time";
}

std::string tolerance_clause(const Choice& cheapest, double tolerance) {
  std::string text = fmt::format("For {}, to have {} within {}: ", cheapest.scene,
                                 subject(cheapest), tolerance_text(cheapest.observable, tolerance));
  if (cheapest.ranked.empty()) {
    text += nothing(cheapest);
  } else {
    const auto& best = cheapest.ranked.front();
    text += fmt::format("{}, {}, wrong by at most {} at {:g} % confidence", at(best),
                        cost_text(best.cost), bound_text(cheapest.observable, best.bound),
                        100 * bounds_level);
  }
  if (cheapest.ranked.size() > 1) {
    const auto& next = cheapest.ranked[1];
    text += fmt::format("; next {}, {} times the cost", at(next),
                        number(next.cost / cheapest.ranked.front().cost, 2));
  }
  if (const auto& other = cheapest.better_inconsistent) {
    text += fmt::format("; {} passes for {}, {}", at(*other), number(other->cost, 3), other_limit);
  }
  return text;
}

std::string tolerance_sentence(const Choice& cheapest, double tolerance) {
  return tolerance_clause(cheapest, tolerance) + ".";
}

std::string resolution_text(const Choice& choice) {
  return "the smallest error that this study can see is " +
         bound_text(choice.observable, choice.resolution.value());
}

std::string budget_clause(const Choice& most_accurate, double budget,
                          std::optional<double> tolerance) {
  const std::string& observable = most_accurate.observable;
  std::string text =
      fmt::format("For {}, to have {} as accurate as {} allow: ", most_accurate.scene,
                  subject(most_accurate), cost_text(budget));
  if (most_accurate.ranked.empty()) {
    text += most_accurate.cells_compared > 0 ? "no method and step of this study costs so little"
                                             : nothing(most_accurate);
  } else {
    const auto& best = most_accurate.ranked.front();
    text +=
        fmt::format("{}, {}, wrong by at most {} at {:g} % confidence", at(best),
                    cost_text(best.cost), bound_text(observable, best.bound), 100 * bounds_level);
    if (tolerance) {
      text += fmt::format(", so {}shown to be within {}", best.bound <= *tolerance ? "" : "not ",
                          tolerance_text(observable, *tolerance));
    }
  }
  if (most_accurate.ranked.size() > 1) {
    const auto& next = most_accurate.ranked[1];
    text += fmt::format("; next {}, by at most {}", at(next), bound_text(observable, next.bound));
  }
  if (const auto& other = most_accurate.better_inconsistent) {
    text += fmt::format("; {} is wrong by at most {}, {}", at(*other),
                        bound_text(observable, other->bound), other_limit);
  }
  return text;
}

}  // namespace driftless
