#include <optional>

#include "experiments/scene_key_groups.hpp"

namespace driftless {
namespace {

using nlohmann::json;

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

std::string_view of_species(const Scene& scene) {
  return scene.fluid.further_species.empty() ? "there is one species alone" : "";
}

}  // namespace

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

}  // namespace driftless
