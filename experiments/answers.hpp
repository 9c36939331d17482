#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace driftless {

/// The name that stands for the worst of kinetic temperature, internal temperature and variance of
/// the internal energy; in an isothermal scene for the kinetic temperature, the only one there is.
inline constexpr const char* equilibrium_observable = "equilibrium";

/// A cell that an answer can name.
struct Candidate {
  std::string method;  ///< with its options
  double time_step = 0;
  double cost = 0;   ///< core-seconds per unit of simulated time
  double bound = 0;  ///< the deviation is at most this; holds for all cells at once, see deviations
  bool consistent = true;  ///< its limit is the model
};

/// Which method at which step a result recommends for one observable of one scene.
struct Choice {
  std::string scene, observable;
  /// The best step of every method whose limit is the model, best first; empty if none is shown to
  /// be what was asked for.
  std::vector<Candidate> ranked;
  /// The best method of another limit, if it is better than all of `ranked`: right in this study's
  /// equilibrium, it need not be elsewhere.
  std::optional<Candidate> better_inconsistent;
  int cells_compared = 0;  ///< whose bounds hold at once
  /// The least deviation that any of them could have been shown to be within; nothing if there is
  /// none.
  std::optional<double> resolution;
  /// Cells ran to their end, but what they measured has no exact value to compare with.
  bool lacks_exact_value = false;
  bool isothermal = false;  ///< the scene has no internal energies
};

/// The cheapest cells whose bound is within the tolerance. A cell is compared if no replica failed
/// and the observable is resolved; its cost must be known.
Choice cheapest_within(const nlohmann::json& result, const std::string& scene,
                       const std::string& observable, double tolerance);

/// The cells of the least bound that cost at most `budget` core-seconds per unit of simulated time.
Choice most_accurate_within(const nlohmann::json& result, const std::string& scene,
                            const std::string& observable, double budget);

/// Adds to a result what its cells say, anew: the cells' deviations; `orders`, the fitted order at
/// which each method's deviations vanish; and `answers`, the choice and its sentence for every
/// scene, observable and tolerance of `answer_tolerances`.
void add_answers(nlohmann::json& result);

/// The tolerances that a result has answers for.
const std::vector<double>& answer_tolerances();

/// The observables that some cell of the result has an exact value for, `equilibrium` first.
std::vector<std::string> judged_observables(const nlohmann::json& result);

/// The name of a cell's method together with its options, as people tell variants apart.
std::string method_label(const nlohmann::json& cell);

/// The largest of a cell's deviations in an observable, or in the parts of `equilibrium`.
struct WorstDeviation {
  double value = 0, bound = 0;
};
/// Nothing if the cell failed, or has no exact value or does not resolve one of them.
std::optional<WorstDeviation> worst_deviation(const nlohmann::json& cell,
                                              const std::string& observable);

}  // namespace driftless
