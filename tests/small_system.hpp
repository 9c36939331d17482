#pragma once

#include <ostream>

#include "experiments/judge/small_system.hpp"

namespace driftless {

/// Makes a method's name the name of its tests.
inline void PrintTo(const Method* method, std::ostream* stream) { *stream << method->name; }

}  // namespace driftless

namespace driftless::judge {

inline void PrintTo(const Terms& terms, std::ostream* stream) { *stream << terms.name(); }

}  // namespace driftless::judge

/// The bench's small systems, and what tests alone do with them.
namespace driftless::testing {

using judge::all_heat_forms;
using judge::distance;
using judge::Distance;
using judge::run;
using judge::same_bits;
using judge::small_box;
using judge::small_fluid;
using judge::small_state;
using judge::Terms;
using judge::Uniform;

}  // namespace driftless::testing
