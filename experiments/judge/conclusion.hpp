#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// What an examination of a method says, in a form that pages and texts show without knowing the
/// examination.
namespace driftless::judge {

/// The answer to one question about a method.
enum class Verdict {
  holds,           ///< true as far as this examination can see; `resolution` says how far that is
  fails,           ///< false beyond the noise
  not_resolved,    ///< the data say neither
  reported,        ///< a number that is neither right nor wrong
  not_applicable,  ///< the question has no meaning for this method; the sentence says why
};

/// "holds", "fails", "not resolved", "reported", "not applicable".
std::string to_string(Verdict verdict);

/// One answer with its number. The interval is one of 95 %; numbers that are not finite are left
/// out of the report.
struct Finding {
  std::string subject;  ///< of what: "variance of u, noise closure, phi/k = 20"
  Verdict verdict = Verdict::reported;
  std::string sentence;              ///< for people, with numbers and units
  std::optional<bool> claimed = {};  ///< whether the method claims it, where there is such a claim
  std::optional<double> value = {};
  std::optional<double> lower = {}, upper = {};
  std::optional<double> resolution = {};  ///< smallest violation that could have been seen
  std::string unit = "1";

  /// A fault that the method does not own up to.
  bool contradicts_claim() const { return verdict == Verdict::fails && claimed.value_or(false); }
};

/// A point of a chart with its 95 % interval, where there is one.
struct Point {
  double x = 0, y = 0;
  std::optional<double> lower = {}, upper = {};
};

enum class Marks { points, line };

struct Series {
  std::string name;
  std::vector<Point> points;
  Marks marks = Marks::points;
};

struct Axis {
  std::string title;  ///< with the unit
  bool logarithmic = false;
};

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
};

/// Cells are texts or numbers.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::variant<std::string, double>>> rows;
};

struct Conclusion {
  std::vector<Finding> findings;
  std::vector<Chart> charts = {};
  std::vector<Table> tables = {};
};

/// The worst of a conclusion's verdicts: fails, not resolved, holds, reported, not applicable.
Verdict overall(const Conclusion& conclusion);

/// As in a judgement ("driftless-judgement/1"). Never holds NaN or infinity.
nlohmann::json to_json(const Conclusion& conclusion);
nlohmann::json to_json(const Axis& axis);
/// Without the points that are not finite.
nlohmann::json to_json(const Chart& chart);

/// How many standard errors make a violation certain. A normal variate is beyond them in 6 of 10^7
/// cases, so a judgement of a thousand findings raises a false alarm in less than one of a
/// thousand.
inline constexpr double certain = 5;

/// A quantity that should be zero: fails if it is away from it by more than `certain` errors, holds
/// if it is not and its resolution - `certain` errors - is within `tolerance`, else not resolved.
/// `error` is a standard error (infinite: not resolved) with so many degrees of freedom: with few
/// of them a violation is certain, and an interval one of 95 %, only at more errors, by Student's
/// law. `sentence` is left to the caller.
Finding zero_finding(std::string subject, double value, double error, double tolerance,
                     double degrees_of_freedom = std::numeric_limits<double>::infinity());

}  // namespace driftless::judge
