#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/study.hpp"

/// The bench that judges any registered method by the same examinations, with no line of code per
/// method.
namespace driftless::judge {

/// quick: minutes for a few methods on four cores; full: hours for all.
enum class Depth { quick, full };

/// "quick", "full".
std::string to_string(Depth depth);

/// A method with the options under which it is judged.
struct Candidate {
  MethodChoice choice;

  const Method& method() const { return *find_method(choice.name); }
  std::unique_ptr<Integrator> make() const { return method().make(choice.options); }
  /// "groot-warren", or with options "groot-warren:lambda=0.5".
  std::string name() const;
};

struct Conditions {
  Depth depth = Depth::quick;
  std::uint64_t seed = 1;
};

/// A share of an examination that is computed alone, on one thread: `run` is a pure function of
/// candidate and conditions, so that a part that was finished need not be run again. It takes
/// seconds at depth quick and some minutes at most at depth full.
struct Part {
  std::string name;  ///< unique within the examination of a candidate
  double cost;       ///< predicted, in any unit that all examinations share: seconds
  std::function<nlohmann::json()> run;
};

/// The records of an examination's parts by their names.
using Records = std::map<std::string, nlohmann::json>;

/// One question of the bench, asked of every method alike. A method to which it does not apply has
/// no parts, and a conclusion that says why.
struct Examination {
  std::string_view name;      ///< as in reports and on the command line: "galilean"
  std::string_view title;     ///< for people
  std::string_view question;  ///< what is asked, how it is measured and what decides; a paragraph
  std::vector<Part> (*parts)(const Candidate&, const Conditions&);
  Conclusion (*conclude)(const Candidate&, const Conditions&, const Records&);
};

/// Every examination, in the order of reports.
const std::vector<const Examination*>& examinations();

}  // namespace driftless::judge
