#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "experiments/location.hpp"
#include "experiments/scene.hpp"
#include "experiments/value_rule.hpp"

namespace driftless {

/// One key of a scene. Reading, the nearest name to a mistyped one, writing, the study's schema and
/// the program's listing are all made from the table of these.
struct SceneKey {
  std::string_view name;
  ValueRule rule;
  std::string_view meaning;  ///< what it is, and its unit where it has one
  nlohmann::json (*get)(const Scene&);
  void (*set)(Scene&, const nlohmann::json&);
  /// Why the key means nothing to a scene; empty where it means something.
  std::string_view (*without_effect)(const Scene&) = nullptr;
  bool told_if_unusual = false;  ///< left out of what is written where it is as in most scenes
};

/// As in the key "walls", in the order of Box::walls.
inline constexpr std::array<const char*, 6> wall_names = {"x_lower", "x_upper", "y_lower",
                                                          "y_upper", "z_lower", "z_upper"};

/// In the order in which they take effect.
const std::vector<SceneKey>& scene_keys();
std::vector<std::string> scene_key_names();

/// The preset of a name, or nullptr.
const Preset* find_preset(std::string_view name);

/// The scenes of a study: each read from its preset and overrides, named and checked. `location` is
/// that of the value, a list of objects. Throws InputError.
std::vector<Scene> read_scenes(const nlohmann::json& list, const Location& location);
/// One scene; its name is empty unless given. Throws InputError.
Scene read_scene(const nlohmann::json& object, const Location& location);

/// Throws InputError if the scene as a whole makes no sense, whatever each key says alone.
void check_scene(const Scene& scene, const Location& location);

/// The scene's keys without name and preset.
nlohmann::json scene_parameters(const Scene& scene);

/// "microcanonical", "canonical", "rest" or "given"; "random" or "lattice".
std::string_view to_string(InitialState state);
std::string_view to_string(Placement placement);

}  // namespace driftless
