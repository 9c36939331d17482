#include "experiments/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "integrators/integrator.hpp"

namespace driftless {
namespace {

using nlohmann::json;

json to_list(const Vector& v) { return {v[0], v[1], v[2]}; }

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

json species_of(const Scene& scene) {
  json list = json::array();
  for (std::size_t n = 0; n < scene.further_shares.size(); ++n) {
    const auto& species = scene.fluid.further_species[n];
    list.push_back({{"share", scene.further_shares[n]},
                    {"mass", species.mass},
                    {"heat_capacity", species.heat_capacity / scene.fluid.heat_capacity}});
  }
  return list;
}

SpeciesParameters first_species(const FluidParameters& fluid) {
  return {fluid.mass, fluid.heat_capacity, fluid.heat_capacity_slope, fluid.equation_of_state};
}

/// At every temperature.
void multiply_heat_capacity(double factor, SpeciesParameters& species) {
  species.heat_capacity *= factor;
  species.heat_capacity_slope *= factor;
  for (auto& point : species.equation_of_state) point.internal_energy *= factor;
}

json points_of(const Scene& scene) {
  json list = json::array();
  for (const auto& point : scene.fluid.equation_of_state) {
    list.push_back({point.temperature, point.internal_energy});
  }
  return list;
}

void set_points(Scene& scene, const json& list) {
  scene.fluid.equation_of_state.clear();
  for (const auto& point : list) {
    scene.fluid.equation_of_state.push_back({point[0].get<double>(), point[1].get<double>()});
  }
}

void set_species(Scene& scene, const json& list) {
  scene.further_shares.clear();
  scene.fluid.further_species.clear();
  for (const auto& object : list) {
    scene.further_shares.push_back(object["share"].get<double>());
    auto species = first_species(scene.fluid);
    if (object.contains("mass")) species.mass = object["mass"].get<double>();
    if (object.contains("heat_capacity")) {
      multiply_heat_capacity(object["heat_capacity"].get<double>(), species);
    }
    scene.fluid.further_species.push_back(species);
  }
}

const std::vector<std::pair<const char*, std::optional<double> PairParameters::*>>&
pair_coefficients() {
  static const std::vector<std::pair<const char*, std::optional<double> PairParameters::*>> all = {
      {"repulsion", &PairParameters::repulsion},
      {"friction", &PairParameters::friction},
      {"conduction", &PairParameters::conduction}};
  return all;
}

json species_pairs_of(const Scene& scene) {
  json list = json::array();
  for (const auto& pair : scene.fluid.pairs) {
    json object = {{"first", pair.a}, {"second", pair.b}};
    for (const auto& [name, member] : pair_coefficients()) {
      if (pair.*member) object[name] = *(pair.*member);
    }
    list.push_back(object);
  }
  return list;
}

void set_species_pairs(Scene& scene, const json& list) {
  scene.fluid.pairs.clear();
  for (const auto& object : list) {
    PairParameters pair{static_cast<unsigned>(to_integer(object["first"])),
                        static_cast<unsigned>(to_integer(object["second"]))};
    for (const auto& [name, member] : pair_coefficients()) {
      if (object.contains(name)) pair.*member = object[name].get<double>();
    }
    scene.fluid.pairs.push_back(pair);
  }
}

Vector to_vector(const json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

double heat_capacity_unit(const Scene& scene) {
  return scene.fluid.boltzmann > 0 ? scene.fluid.boltzmann : 1;
}

/// phi in units of k, as a person would write it: 100, where the quotient of two doubles may be
/// 99.99999999999999. Its product with the unit is the scene's phi to the last bit either way.
double heat_capacity_in_units(const Scene& scene) {
  const double unit = heat_capacity_unit(scene), phi = scene.fluid.heat_capacity;
  const double ratio = phi / unit;
  const double rounded = std::stod(fmt::format("{:.15g}", ratio));
  return rounded * unit == phi ? rounded : ratio;
}

void set_boltzmann(Scene& scene, const json& value) {
  const double ratio = heat_capacity_in_units(scene);
  const bool had_unit = scene.fluid.boltzmann > 0;
  scene.fluid.boltzmann = value.get<double>();
  // phi/k is what a fluid is known by; without k only phi itself is left to keep.
  if (had_unit && scene.fluid.boltzmann > 0) {
    scene.fluid.heat_capacity = ratio * scene.fluid.boltzmann;
  }
}

HeatForm heat_form_of(std::string_view word) {
  for (const auto form : {HeatForm::none, HeatForm::inverse_temperature}) {
    if (to_string(form) == word) return form;
  }
  return HeatForm::temperature;
}

/// Conducts alike near the reference temperature: lambda = L/T^2.
void set_heat_form(Scene& scene, const json& value) {
  auto& fluid = scene.fluid;
  const HeatForm before = fluid.heat_form;
  fluid.heat_form = heat_form_of(value.get<std::string>());
  const double square = fluid.temperature * fluid.temperature;
  if (before == HeatForm::inverse_temperature && fluid.heat_form == HeatForm::temperature) {
    fluid.conduction /= square;
  }
  if (before == HeatForm::temperature && fluid.heat_form == HeatForm::inverse_temperature) {
    fluid.conduction *= square;
  }
}

/// What the preset has of internal energies, or of a bath, goes with it.
void set_isothermal(Scene& scene, const json& value) {
  auto& fluid = scene.fluid;
  fluid.isothermal = value.get<bool>();
  if (fluid.isothermal) {
    fluid.heat_form = HeatForm::none;
    fluid.conduction = 0;
  }
  if (starts_in_law(scene)) {
    scene.initial_state = fluid.isothermal ? InitialState::canonical : InitialState::microcanonical;
  }
}

void set_initial_state(Scene& scene, const json& value) {
  for (const auto state : {InitialState::microcanonical, InitialState::canonical,
                           InitialState::rest, InitialState::given}) {
    if (value == to_string(state)) scene.initial_state = state;
  }
}

void set_velocities(Scene& scene, const json& list) {
  scene.initial_velocities.clear();
  for (const auto& velocity : list) scene.initial_velocities.push_back(to_vector(velocity));
  if (!list.empty()) scene.initial_state = InitialState::given;
}

std::string_view of_fluids(const Scene& scene) {
  return scene.layout == Layout::fluid ? "" : "isolated pairs stand on a lattice of their own";
}
std::string_view of_placed_fluids(const Scene& scene) {
  const bool equilibrium =
      scene.fluid.has_repulsion() && scene.fluid.boltzmann > 0 && starts_in_law(scene);
  return equilibrium ? "a fluid with repulsion starts from its equilibrium" : of_fluids(scene);
}
std::string_view of_slabs(const Scene& scene) {
  return scene.heat_slabs ? of_fluids(scene) : "there are no heat slabs";
}
std::string_view of_species(const Scene& scene) {
  return scene.fluid.further_species.empty() ? "there is one species alone" : "";
}
std::string_view of_pairs(const Scene& scene) {
  return scene.layout == Layout::pairs ? "" : "only isolated pairs have a distance";
}
std::string_view of_given(const Scene& scene) {
  return scene.initial_state == InitialState::given ? "" : "initial_state is not \"given\"";
}
std::string_view of_internal_energies(const Scene& scene) {
  return scene.fluid.isothermal ? "isothermal is true and particles have no internal energy" : "";
}
std::string_view of_heat_capacities(const Scene& scene) {
  return scene.fluid.equation_of_state.empty()
             ? of_internal_energies(scene)
             : "the points of equation_of_state give the heat capacity";
}
std::string_view of_conducting(const Scene& scene) {
  return scene.fluid.isothermal
             ? "isothermal is true and particles have no heat that they could exchange"
             : "";
}
std::string_view of_heat_forms(const Scene& scene) {
  if (scene.fluid.isothermal) return of_conducting(scene);
  return scene.fluid.heat_form == HeatForm::none ? "heat_form is \"none\" and nothing conducts"
                                                 : "";
}
std::string_view of_closures(const Scene& scene) {
  return scene.fluid.isothermal
             ? "isothermal is true and neither coefficient depends on anything but the distance"
             : "";
}
std::string_view of_initial_energies(const Scene& scene) {
  if (scene.fluid.isothermal) return of_internal_energies(scene);
  return scene.initial_state != InitialState::microcanonical
             ? ""
             : "initial_state is \"microcanonical\", which starts at temperature";
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const auto& preset : presets()) names.emplace_back(preset.name);
  return names;
}

/// A member of the scene or of its fluid.
template <auto member, class AnyScene>
auto& value_of(AnyScene& scene) {
  if constexpr (std::is_member_object_pointer_v<decltype(member)> &&
                std::is_invocable_v<decltype(member), AnyScene&>) {
    return scene.*member;
  } else {
    return scene.fluid.*member;
  }
}

/// A key that is a plain value of the scene or of its fluid.
template <auto member>
SceneKey plain(std::string_view name, ValueRule rule, std::string_view meaning,
               std::string_view (*without_effect)(const Scene&) = nullptr) {
  return {name,
          std::move(rule),
          meaning,
          [](const Scene& scene) -> json { return value_of<member>(scene); },
          [](Scene& scene, const json& value) {
            auto& target = value_of<member>(scene);
            value.get_to(target);
          },
          without_effect};
}

std::vector<SceneKey> keys_of_the_system() {
  return {
      plain<&Scene::preset>("preset", ValueRule::word(preset_names()),
                            "the scene that the other keys override"),
      plain<&Scene::name>("name", ValueRule::name(),
                          "unique in a study; made from preset and overrides if not given"),
      {"particles", ValueRule::integer(2, 10'000'000), "number of particles",
       [](const Scene& scene) -> json { return scene.particles; },
       [](Scene& scene, const json& value) { scene.particles = to_integer(value); }},
      plain<&Scene::density>("density", ValueRule::positive(), "particles per volume", of_fluids),
      {"temperature", ValueRule::positive(),
       "temperature T of the start, and at which friction is quoted; of the bath if isothermal",
       [](const Scene& scene) -> json { return scene.fluid.temperature; },
       [](Scene& scene, const json& value) {
         scene.fluid.temperature = scene.initial_temperature = value.get<double>();
       }},
      {"boltzmann", ValueRule::not_negative(),
       "Boltzmann's constant k; 0 switches every fluctuation off and needs an initial_state",
       [](const Scene& scene) -> json { return scene.fluid.boltzmann; }, set_boltzmann},
      plain<&FluidParameters::mass>("mass", ValueRule::positive(), "mass m of a particle"),
      {"isothermal", ValueRule::boolean(),
       "particles have no internal energy; friction and noise are the contact with a bath",
       [](const Scene& scene) -> json { return scene.fluid.isothermal; }, set_isothermal},
      {"heat_capacity", ValueRule::positive(),
       "heat capacity phi of a particle in units of k; in program units where k is 0",
       [](const Scene& scene) -> json { return heat_capacity_in_units(scene); },
       [](Scene& scene, const json& value) {
         scene.fluid.heat_capacity = value.get<double>() * heat_capacity_unit(scene);
       },
       of_heat_capacities},
      {"heat_capacity_slope", ValueRule::not_negative(),
       "what the heat capacity, quoted at temperature, rises by per unit of temperature, in the "
       "same unit",
       [](const Scene& scene) -> json {
         return scene.fluid.heat_capacity_slope / heat_capacity_unit(scene);
       },
       [](Scene& scene, const json& value) {
         scene.fluid.heat_capacity_slope = value.get<double>() * heat_capacity_unit(scene);
       },
       of_heat_capacities},
      {"equation_of_state", ValueRule::points("[temperature, energy]"),
       "two points or more through which a particle's internal energy follows its temperature, "
       "instead of a heat capacity; both rising, in program units",
       points_of, set_points, of_internal_energies},
  };
}

/// What most scenes do not have.
const std::vector<std::string_view>& rare_keys() {
  static const std::vector<std::string_view> rare = {"sides",
                                                     "walls",
                                                     "gravity",
                                                     "heat_slabs",
                                                     "species",
                                                     "species_pairs",
                                                     "thermal_repulsion",
                                                     "heat_capacity_slope",
                                                     "equation_of_state",
                                                     "friction_temperature_exponent",
                                                     "conduction_temperature_exponent"};
  return rare;
}

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

std::vector<SceneKey> keys_of_the_species() {
  return {
      {"species",
       ValueRule::objects("a species",
                          {{"share", ValueRule::positive(), true, "of all particles, below 1"},
                           {"mass", ValueRule::positive(), false, "mass m of a particle"},
                           {"heat_capacity", ValueRule::positive(), false,
                            "heat capacity in units of the first species', at all temperatures"}}),
       "species beside the first, 0, numbered from 1", species_of, set_species, of_fluids},
      {"species_pairs",
       ValueRule::objects("a pair of species",
                          {{"first", ValueRule::integer(0, 255), true, "number of a species"},
                           {"second", ValueRule::integer(0, 255), true, "number of a species"},
                           {"repulsion", ValueRule::not_negative(), false, "of such pairs"},
                           {"friction", ValueRule::not_negative(), false, "of such pairs"},
                           {"conduction", ValueRule::not_negative(), false, "of such pairs"}}),
       "coefficients of pairs of species where they are not the fluid's", species_pairs_of,
       set_species_pairs, of_species},
  };
}

std::vector<SceneKey> keys_of_the_laws() {
  return {
      plain<&FluidParameters::repulsion>("repulsion", ValueRule::not_negative(),
                                         "largest repulsive force a between two particles"),
      plain<&FluidParameters::thermal_repulsion>(
          "thermal_repulsion", ValueRule::not_negative(),
          "a_1 of what a repulsion that follows the temperatures has more: a_1 times the mean "
          "temperature of the pair over temperature",
          of_internal_energies),
      plain<&FluidParameters::repulsion_range>("repulsion_range", ValueRule::positive(),
                                               "distance at which the repulsion ends"),
      plain<&FluidParameters::friction>("friction", ValueRule::not_negative(),
                                        "friction coefficient zeta_0 at temperature T"),
      {"friction_closure", ValueRule::word({"noise", "friction"}),
       "which coefficient depends on the distance alone: that of the noise or that of the friction",
       [](const Scene& scene) -> json { return to_string(scene.fluid.friction_closure); },
       [](Scene& scene, const json& value) {
         scene.fluid.friction_closure =
             value == "noise" ? FrictionClosure::noise : FrictionClosure::friction;
       },
       of_closures},
      plain<&FluidParameters::friction_range>("friction_range", ValueRule::positive(),
                                              "distance at which the friction ends"),
      {"heat_form", ValueRule::word({"none", "inverse-temperature", "temperature"}),
       "what drives the heat between two particles: the difference of the inverse temperatures, "
       "that of the temperatures, or nothing",
       [](const Scene& scene) -> json { return to_string(scene.fluid.heat_form); }, set_heat_form,
       of_conducting},
      plain<&FluidParameters::conduction>(
          "conduction", ValueRule::not_negative(),
          "L_0 of the form inverse-temperature, lambda_0 = L_0/T^2 of the form temperature",
          of_conducting),
      plain<&FluidParameters::heat_range>("heat_range", ValueRule::positive(),
                                          "distance at which the conduction ends", of_conducting),
      plain<&FluidParameters::weight_exponent>(
          "weight_exponent", ValueRule::positive(),
          "s of the weight (1 - r/range)^s of friction and conduction"),
      plain<&FluidParameters::friction_temperature_exponent>(
          "friction_temperature_exponent", ValueRule::number(),
          "p of the factor (mean temperature of the pair/temperature)^p of the noise's strength "
          "Gamma^2 or of the friction, whichever friction_closure gives; geometric mean",
          of_closures),
      plain<&FluidParameters::conduction_temperature_exponent>(
          "conduction_temperature_exponent", ValueRule::number(),
          "the same of the coefficient that heat_form gives", of_heat_forms),
  };
}

std::vector<SceneKey> keys_of_the_start() {
  return {
      {"frame_velocity", ValueRule::vector(), "velocity [x, y, z] of the whole system",
       [](const Scene& scene) { return to_list(scene.frame_velocity); },
       [](Scene& scene, const json& value) { scene.frame_velocity = to_vector(value); }},
      plain<&Scene::frozen>("frozen", ValueRule::boolean(), "particles keep their positions"),
      plain<&Scene::pair_distance>("pair_distance", ValueRule::positive(),
                                   "distance between the two particles of a pair", of_pairs),
      {"initial_positions", ValueRule::word({"random", "lattice"}), "how particles are placed",
       [](const Scene& scene) -> json { return to_string(scene.initial_positions); },
       [](Scene& scene, const json& value) {
         scene.initial_positions = value == "random" ? Placement::random : Placement::lattice;
       },
       of_placed_fluids},
      {"initial_velocity_spread", ValueRule::not_negative(),
       "standard deviation of a velocity component; makes initial_state \"given\"",
       [](const Scene& scene) -> json { return scene.initial_velocity_spread; },
       [](Scene& scene, const json& value) {
         scene.initial_velocity_spread = value.get<double>();
         scene.initial_state = InitialState::given;
       },
       of_given},
      {"initial_velocities", ValueRule::vectors(),
       "one [x, y, z] per particle instead of the spread; makes initial_state \"given\"",
       [](const Scene& scene) {
         json list = json::array();
         for (const auto& velocity : scene.initial_velocities) list.push_back(to_list(velocity));
         return list;
       },
       set_velocities, of_given},
      {"initial_state", ValueRule::word({"microcanonical", "canonical", "rest", "given"}),
       "velocities and internal energies at the start: drawn from the exact law, which is "
       "microcanonical (all particles at temperature where heat capacities vary), or canonical if "
       "isothermal; at rest; or given",
       [](const Scene& scene) -> json { return to_string(scene.initial_state); },
       set_initial_state},
      {"initial_temperature", ValueRule::positive(),
       "temperature of every particle at the start if not microcanonical; temperature if not given",
       [](const Scene& scene) -> json { return scene.initial_temperature; },
       [](Scene& scene, const json& value) { scene.initial_temperature = value.get<double>(); },
       of_initial_energies},
  };
}

}  // namespace

// Boltzmann's constant comes before the heat capacity in its units, the temperature and the heat
// form before the conduction that they convert, the bath before the laws and the start that go with
// it, what gives velocities before the state it implies.
const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all = keys_of_the_system();
    for (auto group : {keys_of_the_surroundings(), keys_of_the_species(), keys_of_the_laws(),
                       keys_of_the_start()}) {
      all.insert(all.end(), group.begin(), group.end());
    }
    for (auto& key : all) {
      const auto& rare = rare_keys();
      key.told_if_unusual = std::find(rare.begin(), rare.end(), key.name) != rare.end();
    }
    return all;
  }();
  return keys;
}

std::vector<std::string> scene_key_names() {
  std::vector<std::string> names;
  for (const auto& key : scene_keys()) names.emplace_back(key.name);
  return names;
}

std::string_view to_string(InitialState state) {
  switch (state) {
    case InitialState::microcanonical:
      return "microcanonical";
    case InitialState::canonical:
      return "canonical";
    case InitialState::rest:
      return "rest";
    case InitialState::given:
      return "given";
  }
  throw std::logic_error("unknown initial state");
}

std::string_view to_string(Placement placement) {
  return placement == Placement::random ? "random" : "lattice";
}

}  // namespace driftless
