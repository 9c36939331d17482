#include <algorithm>
#include <set>

#include "experiments/scene_keys.hpp"
#include "experiments/study.hpp"

namespace driftless {
namespace {

using nlohmann::json;

const std::string example = "{\"preset\": \"mackie-1999\"}";

void set_given_keys(Scene& scene, const json& object, const Location& location) {
  for (const auto& key : scene_keys()) {
    const auto value = object.find(std::string(key.name));
    if (value == object.end()) continue;
    key.rule.check(*value, location.member(key.name));
    key.set(scene, *value);
  }
}

/// A key without effect is a misunderstanding that nobody would notice in the result.
void refuse_keys_without_effect(const Scene& scene, const json& object, const Location& location) {
  for (const auto& key : scene_keys()) {
    const auto value = object.find(std::string(key.name));
    if (value == object.end() || !key.without_effect) continue;
    const auto reason = key.without_effect(scene);
    if (reason.empty()) continue;
    location.member(key.name).refuse("is " + describe(*value) + " but has no effect here, for " +
                                     std::string(reason) + "; allowed is to leave it out");
  }
}

std::string word_for(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_array() && value.size() > 3 ? "given" : value.dump();
}

/// "mackie-1999, friction_closure noise": the preset and what was overridden.
std::string name_from_overrides(const json& object) {
  std::string name = object.at("preset").get<std::string>();
  for (const auto& key : scene_keys()) {
    const auto value = object.find(std::string(key.name));
    if (value == object.end() || key.name == "preset" || key.name == "name") continue;
    name += ", " + std::string(key.name) + " " + word_for(*value);
  }
  return name;
}

void name_scenes(std::vector<Scene>& scenes, const json& list, const Location& location) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    Scene& scene = scenes[i];
    if (scene.name.empty()) {
      const auto alike = [&](const Scene& other) { return other.preset == scene.preset; };
      const bool alone = std::count_if(scenes.begin(), scenes.end(), alike) == 1;
      scene.name = alone ? scene.preset : name_from_overrides(list[i]);
    }
    if (names.insert(scene.name).second) continue;
    location.element(i).member("name").refuse("is " + describe(json(scene.name)) +
                                              ", which another scene is called already; " +
                                              "allowed is a name that no other scene has");
  }
}

}  // namespace

Scene read_scene(const json& object, const Location& location) {
  require_object(object, location, example);
  require_known_keys(object, location, "a scene", scene_key_names());
  const SceneKey& first = scene_keys().front();
  const json& preset = require_key(object, location, "preset", first.rule.allowed());
  first.rule.check(preset, location.member("preset"));
  Scene scene = find_preset(preset.get<std::string>())->scene;
  scene.name.clear();
  set_given_keys(scene, object, location);
  refuse_keys_without_effect(scene, object, location);
  check_scene(scene, location);
  return scene;
}

std::vector<Scene> read_scenes(const json& list, const Location& location) {
  if (!list.is_array() || list.empty() || list.size() > 1000) {
    location.refuse("is " + describe(list) + "; allowed is a list of 1 to 1000 scenes such as [" +
                    example + "]");
  }
  std::vector<Scene> scenes;
  for (std::size_t i = 0; i < list.size(); ++i) {
    scenes.push_back(read_scene(list[i], location.element(i)));
  }
  name_scenes(scenes, list, location);
  return scenes;
}

json scene_parameters(const Scene& scene) {
  json parameters = json::object();
  for (const auto& key : scene_keys()) {
    const bool acts = !key.without_effect || key.without_effect(scene).empty();
    if (key.told_if_unusual && key.get(scene) == key.get(Scene())) continue;
    if (acts && key.name != "preset" && key.name != "name") {
      parameters[std::string(key.name)] = key.get(scene);
    }
  }
  return parameters;
}

json to_json(const Scene& scene) {
  json object = scene_parameters(scene);
  object["preset"] = scene.preset;
  if (!scene.name.empty()) object["name"] = scene.name;
  return object;
}

}  // namespace driftless
