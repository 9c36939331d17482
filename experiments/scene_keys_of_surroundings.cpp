#include <optional>
#include <string>

#include "experiments/scene_key_groups.hpp"

namespace driftless {
namespace {

using nlohmann::json;

const std::vector<std::pair<const char*, double Wall::*>>& wall_numbers() {
  static const std::vector<std::pair<const char*, double Wall::*>> numbers = {
      {"repulsion", &Wall::repulsion},   {"repulsion_range", &Wall::repulsion_range},
      {"friction", &Wall::friction},     {"friction_range", &Wall::friction_range},
      {"conduction", &Wall::conduction}, {"heat_range", &Wall::heat_range}};
  return numbers;
}

json to_json(const std::optional<Wall>& wall) {
  if (!wall) return nullptr;
  json object = json::object();
  if (wall->temperature) object["temperature"] = *wall->temperature;
  for (const auto& [name, member] : wall_numbers()) object[name] = *wall.*member;
  return object;
}

Wall to_wall(const json& object) {
  Wall wall;
  if (object.contains("temperature")) wall.temperature = object["temperature"].get<double>();
  for (const auto& [name, member] : wall_numbers()) {
    if (object.contains(name)) wall.*member = object[name].get<double>();
  }
  return wall;
}

ValueRule wall_rule() {
  const auto number = ValueRule::not_negative(), range = ValueRule::positive();
  return ValueRule::object(
      "a wall",
      {{"temperature", range, false, "of a reservoir; without it the wall is adiabatic"},
       {"repulsion", number, false, "largest repulsive force"},
       {"repulsion_range", range, false, "distance at which the repulsion ends"},
       {"friction", number, false, "normal friction coefficient zeta_0 of a reservoir"},
       {"friction_range", range, false, "distance at which the friction ends"},
       {"conduction", number, false, "L_0 or lambda_0 of a reservoir, as the fluid's heat_form"},
       {"heat_range", range, false, "distance at which the conduction ends"}});
}

ValueRule walls_rule() {
  std::vector<Field> faces;
  for (const char* name : wall_names) {
    faces.push_back({name, wall_rule(), false, "wall at this side of the box, in pairs"});
  }
  return ValueRule::object("walls", faces);
}

json walls_of(const Scene& scene) {
  json object = json::object();
  for (std::size_t n = 0; n < wall_names.size(); ++n) {
    if (scene.walls[n]) object[wall_names[n]] = to_json(scene.walls[n]);
  }
  return object;
}

void set_walls(Scene& scene, const json& object) {
  for (std::size_t n = 0; n < wall_names.size(); ++n) {
    scene.walls[n].reset();
    if (object.contains(wall_names[n])) scene.walls[n] = to_wall(object[wall_names[n]]);
  }
}

const std::vector<std::pair<const char*, SlabDrive>>& slab_drives() {
  static const std::vector<std::pair<const char*, SlabDrive>> drives = {
      {"heat-rate", SlabDrive::heat_rate},
      {"velocity-exchange", SlabDrive::velocity_exchange},
      {"energy-exchange", SlabDrive::energy_exchange},
      {"temperatures", SlabDrive::temperatures}};
  return drives;
}

const std::vector<std::pair<const char*, double HeatSlabs::*>>& slab_numbers() {
  static const std::vector<std::pair<const char*, double HeatSlabs::*>> numbers = {
      {"rate", &HeatSlabs::rate},
      {"hot_temperature", &HeatSlabs::hot_temperature},
      {"cold_temperature", &HeatSlabs::cold_temperature},
      {"period", &HeatSlabs::period}};
  return numbers;
}

ValueRule slabs_rule() {
  std::vector<std::string> drives;
  for (const auto& [name, drive] : slab_drives()) drives.emplace_back(name);
  const auto place = ValueRule::not_negative(), positive = ValueRule::positive();
  return ValueRule::object(
      "heat_slabs",
      {{"drive", ValueRule::word(drives), true, "what drives the heat"},
       {"axis", ValueRule::word({"x", "y", "z"}), true, "that the slabs are normal to"},
       {"hot",
        ValueRule::object("a slab", {{"from", place, true, "where it begins"},
                                     {"to", positive, true, "where it ends"}}),
        true, "the slab that receives"},
       {"cold",
        ValueRule::object("a slab", {{"from", place, true, "where it begins"},
                                     {"to", positive, true, "where it ends"}}),
        true, "the slab that gives"},
       {"rate", positive, false, "of heat-rate: energy per unit time"},
       {"hot_temperature", positive, false, "of temperatures"},
       {"cold_temperature", positive, false, "of temperatures"},
       {"period", place, false, "time from one exchange to the next; 0: every step"}});
}

json heat_slabs_of(const Scene& scene) {
  if (!scene.heat_slabs) return nullptr;
  const HeatSlabs& slabs = *scene.heat_slabs;
  json object = {{"axis", std::string(1, static_cast<char>('x' + slabs.axis))},
                 {"hot", {{"from", slabs.hot.from}, {"to", slabs.hot.to}}},
                 {"cold", {{"from", slabs.cold.from}, {"to", slabs.cold.to}}}};
  for (const auto& [name, drive] : slab_drives()) {
    if (drive == slabs.drive) object["drive"] = name;
  }
  for (const auto& [name, member] : slab_numbers()) {
    if (slabs.*member != 0) object[name] = slabs.*member;
  }
  return object;
}

void set_heat_slabs(Scene& scene, const json& object) {
  HeatSlabs slabs;
  for (const auto& [name, drive] : slab_drives()) {
    if (object["drive"] == name) slabs.drive = drive;
  }
  slabs.axis = object["axis"].get<std::string>()[0] - 'x';
  const auto slab = [](const json& range) {
    return Slab{range["from"].get<double>(), range["to"].get<double>()};
  };
  slabs.hot = slab(object["hot"]);
  slabs.cold = slab(object["cold"]);
  for (const auto& [name, member] : slab_numbers()) {
    if (object.contains(name)) slabs.*member = object[name].get<double>();
  }
  scene.heat_slabs = slabs;
}

std::string_view of_slabs(const Scene& scene) {
  return scene.heat_slabs ? of_fluids(scene) : "there are no heat slabs";
}

}  // namespace

std::vector<SceneKey> keys_of_the_surroundings() {
  return {
      {"sides", ValueRule::vector(), "sides [x, y, z] of the box, relative to each other",
       [](const Scene& scene) { return to_list(scene.sides); },
       [](Scene& scene, const json& value) { scene.sides = to_vector(value); }, of_fluids},
      {"walls", walls_rule(), "walls of the box; periodic where there are none", walls_of,
       set_walls, of_fluids},
      {"gravity", ValueRule::vector(), "acceleration [x, y, z], along one axis that has walls",
       [](const Scene& scene) { return to_list(scene.gravity); },
       [](Scene& scene, const json& value) { scene.gravity = to_vector(value); }, of_fluids},
      {"heat_slabs", slabs_rule(), "two slabs that drive heat from one to the other", heat_slabs_of,
       set_heat_slabs, of_slabs},
  };
}

}  // namespace driftless
