#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/replica.hpp"

namespace driftless {

/// The status of a cell: "ok", or that of its first failed replica.
std::string cell_status(const std::vector<ReplicaResult>& replicas);

/// The record of a cell in a result, without its cost: what was measured, with errors, beside what
/// is exact (deviations take the other cells: `add_deviations`); how replicas failed; curves and
/// energy trace. Never holds NaN or infinity.
nlohmann::json cell_record(const PreparedScene& prepared, const Study& study,
                           const MethodChoice& choice, double time_step,
                           const std::vector<ReplicaResult>& replicas);

/// The record of a cell whose method refuses the scene.
nlohmann::json refused_cell(const PreparedScene& prepared, const MethodChoice& choice,
                            double time_step, const std::string& reason);

/// Whether a study is long enough for observables that relax in a predicted time: equilibration of
/// 5 such times and measurement of 20.
bool resolves(const Study& study, double relaxation_time);

}  // namespace driftless
