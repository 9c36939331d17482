#pragma once

#include <string>
#include <vector>

#include "experiments/study.hpp"

namespace driftless {

/// What will come of a study that is valid but not what its author may think, known before anything
/// is run, a sentence each: durations too short for observables to be resolved, and methods that do
/// not apply. Throws InputError, beginning with `source`, if no method applies to any scene.
std::vector<std::string> study_warnings(const Study& study, const std::string& source);

}  // namespace driftless
