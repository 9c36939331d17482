#pragma once

#include <string>
#include <vector>

#include "experiments/judge/drift_runs.hpp"

/// What measured drifts say of the law of the energy drift (see drift_prediction.hpp). A method is
/// held to it where `theory_applies`; of the others the same numbers are reported.
namespace driftless::judge {

/// The power with which the drift goes, beside the one that theory says.
Finding power_finding(const std::string& subject, const std::string& of,
                      const std::vector<MeasuredDrift>& all,
                      double (*variable)(const DriftSetting&), double expected,
                      bool theory_applies);

Finding sign_finding(const std::vector<MeasuredDrift>& all, bool theory_applies);

/// What the Verlet step does on its own: theory has no drift there, as it keeps h^2 H_2 + E.
Finding frictionless_finding(const std::vector<MeasuredDrift>& along_frictions);

/// Var(E - E_0) over 2 kT times the mean drift: 1 by the fluctuation theorem.
Finding fluctuation_finding(const std::vector<MeasuredDrift>& all, bool theory_applies);

/// The drift of the smallest step that shows one, over theory's.
Finding prefactor_finding(const std::vector<MeasuredDrift>& along_steps);

/// B of a drift A h^4 + B h^3 k/phi, both heat capacities and all steps at once. A kernel that
/// conserves energy but has a law of its own can add such a term.
Finding bias_finding(const std::vector<MeasuredDrift>& large,
                     const std::vector<MeasuredDrift>& small, bool law_exact);

/// What brief runs of small steps say, where a drift stands out of their noise.
Finding brief_finding(const std::vector<MeasuredDrift>& brief);

}  // namespace driftless::judge
