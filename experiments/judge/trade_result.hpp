#pragma once

#include <nlohmann/json.hpp>

namespace driftless::judge {

/// The trade of a judgement ("driftless-judgement/1") as far as answers need it, in the form of a
/// result: its scenes, and of every point a cell with cost, deviations, and bounds that hold for
/// all cells of a scene and observable at once (see `add_deviations`; by the normal law).
///
/// A cell is consistent if the method claims to have the scene's model for a limit and nothing that
/// was extrapolated there fails.
nlohmann::json trade_as_result(const nlohmann::json& judgement);

}  // namespace driftless::judge
