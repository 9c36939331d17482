#include "experiments/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "experiments/scene_key_groups.hpp"
#include "integrators/integrator.hpp"

namespace driftless {

using nlohmann::json;

json to_list(const Vector& v) { return {v[0], v[1], v[2]}; }

Vector to_vector(const json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

std::string_view of_fluids(const Scene& scene) {
  return scene.layout == Layout::fluid ? "" : "isolated pairs stand on a lattice of their own";
}

namespace {

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

std::string_view of_placed_fluids(const Scene& scene) {
  const bool equilibrium =
      scene.fluid.has_repulsion() && scene.fluid.boltzmann > 0 && starts_in_law(scene);
  return equilibrium ? "a fluid with repulsion starts from its equilibrium" : of_fluids(scene);
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
