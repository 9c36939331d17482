#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/kept_parts.hpp"
#include "experiments/statistics.hpp"
#include "experiments/study_parts.hpp"

/// The systems, measurements and figures of the papers, each with the paper's values beside ours.
namespace driftless::reproduce {

/// quick: seconds to a minute a part, smaller systems or shorter runs than the paper's, stated in
/// the rows; full: the paper's sizes.
enum class Effort { quick, full };

/// "quick", "full".
std::string to_string(Effort effort);

struct Conditions {
  Effort effort = Effort::quick;
  std::uint64_t seed = 1;
  std::optional<MethodChoice> method = std::nullopt;  ///< in the place of the paper's

  /// The method of the runs that are the paper's under `published`, or ours where it names none.
  MethodChoice method_or(const MethodChoice& published) const { return method.value_or(published); }
  /// That one and behind it the contrasts, each method once.
  std::vector<MethodChoice> methods_or(const MethodChoice& published,
                                       const std::vector<MethodChoice>& contrasts) const;
};

using Workplace = PartPlace;

/// A share of an experiment, computed by itself: a pure function of the conditions, whatever the
/// threads, so that a part that was finished need not be run again.
struct Part {
  std::string name;   ///< unique within the experiment
  double cost;        ///< predicted, in seconds of one core
  bool wide = false;  ///< one big system: runs alone, on all threads
  std::function<nlohmann::json(const Workplace&)> run;
};

/// The records of an experiment's parts by their names.
using Records = std::map<std::string, nlohmann::json>;

/// A number with its 95 % interval; without error bar low = high = value.
struct Interval {
  double value = 0, low = 0, high = 0;
};

/// +- 1.96 standard errors.
Interval interval_of(const Estimate& estimate);

/// Against the paper's value; against theory's where the paper's is not known to us.
enum class Verdict {
  agrees,        ///< our interval, widened by the error of the other, holds the other value
  differs,       ///< it does not
  not_resolved,  ///< it is too wide to tell
  ours_alone     ///< there is no number to compare with
};

/// "agrees", "differs", "not resolved", "ours alone".
std::string to_string(Verdict verdict);

/// One value of a paper, or of theory, beside ours.
struct Row {
  std::string quantity;  ///< "wall pressure P*"
  std::string setting;   ///< method, step, size: what it was measured at
  std::string unit;
  std::optional<Interval> paper;
  std::string paper_text;  ///< where the paper says it in words: "less than 1%"
  Interval ours;
  Verdict verdict = Verdict::ours_alone;
  std::string explanation = {};  ///< of a difference, or what the number shows; a sentence or two
  std::optional<Interval> theory = {};  ///< what a formula or a law says, evaluated by us
  std::string theory_text = {};         ///< which one: "analytic (eq. 17-26)"
};

/// For a value with its interval beside the paper's: differs if the two intervals have nothing in
/// common; else not resolved if ours reaches further than `resolution` of the paper's value (of 1
/// where that is 0) to either side, or is not finite; else agrees.
Verdict compare(const Interval& ours, const Interval& paper, double resolution);

/// What theory says of ours, and the verdict against it.
void put_theory(Row& row, const Interval& theory, std::string text, double resolution);
void put_theory(Row& row, double theory, std::string text, double resolution);

/// Values on a rectangular grid: value(column, row) = values[row * columns + column].
struct Field {
  judge::Axis x, y;
  double x_from = 0, x_to = 1, y_from = 0, y_to = 1;
  std::size_t columns = 0, rows = 0;
  std::string quantity;          ///< what is drawn in colours and contours; empty: arrows alone
  std::vector<double> values;    ///< empty if there is no such quantity
  std::vector<double> contours;  ///< levels to draw lines at; empty: chosen by the page
  std::vector<double> arrow_x, arrow_y;  ///< per cell of the grid; empty: no arrows
};

/// One picture in the paper's axes.
struct Picture {
  std::string title;  ///< "MAN Fig. 3: cooling, then warming by the walls"
  std::string caption;
  std::optional<judge::Chart> chart;  ///< points with error bars beside lines of theory
  std::optional<Field> field;
};

struct Outcome {
  std::vector<Row> rows;
  std::vector<Picture> pictures;
  std::vector<std::string> remarks;  ///< what was chosen where the paper is silent
};

/// What one figure, table or sentence of a paper becomes.
struct Experiment {
  std::string_view name;      ///< as on the command line: "mackie-1999-fig-3"
  std::string_view source;    ///< "MAN Fig. 3"
  std::string_view title;     ///< for people
  std::string_view question;  ///< what is simulated and measured, with every setting; a paragraph
  std::vector<Part> (*parts)(const Conditions&);
  Outcome (*conclude)(const Conditions&, const Records&);
  /// Why a method cannot run it in the place of the paper's, in one sentence without a stop;
  /// nothing if it can. Null: every method can.
  std::optional<std::string> (*unsuited)(const MethodChoice&) = nullptr;
};

/// Why a method cannot run one of the fluids, nothing if it runs them all.
std::optional<std::string> first_refusal(const MethodChoice& choice,
                                         const std::vector<FluidParameters>& fluids);

/// Every experiment, in the order of the report.
const std::vector<const Experiment*>& experiments();

}  // namespace driftless::reproduce
