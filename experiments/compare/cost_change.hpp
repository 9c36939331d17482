#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/compare/common_cells.hpp"

namespace driftless {

/// How the cost of methods changed: {"compared": false, "reason"} between processors or
/// instruction sets, else {"compared": true, "methods": [{"method", "cells", "ratio", "spread",
/// "verdict"}]}. `ratio` is the geometric mean over the method's cells of NEW's processor time
/// over BASE's, `spread` the relative spread of a cell's repeated timings in both, the median of
/// the cells; "slower" or "faster" where the ratio is further from 1 than 10 % and three times the
/// spread, else "same". A hint, not a test: a busy machine slows everything down, and no
/// statistics of one run knows it.
nlohmann::json cost_changes(const nlohmann::json& base, const nlohmann::json& changed,
                            const std::vector<CommonCell>& cells);

}  // namespace driftless
