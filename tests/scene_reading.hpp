#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/scene_keys.hpp"
#include "experiments/study.hpp"

namespace driftless::testing {

/// The scene of these overrides, as in a file "scene.json".
inline Scene read(const nlohmann::json& overrides) {
  return read_scene(overrides, Location("scene.json", "scene"));
}

/// Why they are refused; empty if they are not.
inline std::string refusal_of(const nlohmann::json& overrides) {
  try {
    read(overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace driftless::testing
