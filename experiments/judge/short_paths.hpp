#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/judge/examination.hpp"
#include "experiments/judge/small_system.hpp"

/// What may not change a method's path, and what must: questions that a few steps answer to
/// rounding.
namespace driftless::judge {

/// Steps of `short_step` that most of the paths have.
inline constexpr std::uint64_t short_steps = 20;
inline constexpr double short_step = 0.01;

/// Differences of at most `rounding` are rounding after so many steps; what is broken is broken by
/// a thousand times more.
inline constexpr double rounding = 1e-11;
inline constexpr double visible = 1e-8;

/// A method with options, and the seed of its noise.
struct Trial {
  const Method& method;
  Options options = {};
  std::uint64_t seed = 7;
};

/// How alike two paths are to be.
enum class Alike {
  in_bits,      ///< a difference of 0
  to_rounding,  ///< one of at most `rounding`
  not_at_all,   ///< a visible one
};

/// One question. A difference is the largest one of positions, velocities and internal energies of
/// order 1, or a relative change of energy.
struct ShortCheck {
  std::string name;   ///< "order of storage"
  std::string sound;  ///< the answer in words if all is well ...
  std::string wrong;  ///< ... and if not
  Alike alike = Alike::to_rounding;
  /// Nothing where the question has no meaning. Throws StepFailure.
  std::function<std::optional<double>(const Trial&, const Terms&)> difference = {};
  /// Whether a method claims that all is well, and whether it is at fault if it does not.
  bool (*claimed)(const Method&) = [](const Method&) { return true; };
  bool demanded = true;
};

/// Momentum, energy, repetition, restart, threads, symmetries, steps of no length, few particles.
const std::vector<ShortCheck>& short_checks();
/// The check of that name; throws std::out_of_range.
const ShortCheck& short_check(std::string_view name);

/// The same system and noise seen from a frame that moves at so many thermal velocities sqrt(kT/m)
/// in a general direction.
ShortCheck boost_check(double thermal_velocities);

/// Every closure that the method claims, with every heat form, without and with a potential; and
/// without internal energies if it claims to do without.
std::vector<Terms> all_terms(const Method& method);

/// What a check finds over all terms: {"smallest", "largest": {"difference", "terms"}}, or
/// {"failure": sentence} of the first terms with which a step failed, or {} if it has no meaning.
nlohmann::json short_record(const ShortCheck& check, const Trial& trial);

/// The answer in words and numbers.
Finding short_finding(const ShortCheck& check, const Method& method, const nlohmann::json& record);

}  // namespace driftless::judge
