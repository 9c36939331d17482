#pragma once

#include <optional>
#include <string>

#include "experiments/answers.hpp"

namespace driftless {

/// The sentences and numbers of answers, worded here alone: in results, summaries, the page and on
/// the terminal.

/// "3.1 %", with two digits or all before the point.
std::string percent(double share);
/// A deviation in words: in percent, or a number with its unit where that is absolute.
std::string deviation_text(const std::string& observable, double value);
/// The same of a bound: rounded up, never below itself.
std::string bound_text(const std::string& observable, double bound);
/// A tolerance as it was given: as `deviation_text`, with all its digits.
std::string tolerance_text(const std::string& observable, double tolerance);
/// "0.0295 core-s per unit time".
std::string cost_text(double core_seconds_per_time);

/// The cheapest method within a tolerance, the next one, and a cheaper one whose limit is not the
/// model; or that there is none, and the least that the study could have shown.
std::string tolerance_sentence(const Choice& cheapest, double tolerance);

/// The same without its full stop, for more to follow.
std::string tolerance_clause(const Choice& cheapest, double tolerance);

/// The most accurate method within a cost, the next one, and a more accurate one whose limit is not
/// the model; or that there is none. Without a full stop. With a tolerance it says whether the
/// method is shown to be within it.
std::string budget_clause(const Choice& most_accurate, double budget,
                          std::optional<double> tolerance);

/// The least error that a study could have shown; `choice` has a resolution.
std::string resolution_text(const Choice& choice);

}  // namespace driftless
