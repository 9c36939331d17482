#pragma once

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "experiments/scene_keys.hpp"

// What the table of a scene's keys is put together from.
namespace driftless {

/// Sides, walls, gravity and heat slabs.
std::vector<SceneKey> keys_of_the_surroundings();
/// Species beside the first and their pairs.
std::vector<SceneKey> keys_of_the_species();

/// [x, y, z].
nlohmann::json to_list(const Vector& v);
Vector to_vector(const nlohmann::json& list);

/// Why a key of fluids means nothing to a scene; empty where it means something.
std::string_view of_fluids(const Scene& scene);

}  // namespace driftless
