#include "experiments/scene_part_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/scene_keys.hpp"

namespace driftless {
namespace {

/// A wall's reservoir is one thing: what would have no effect is a misunderstanding.
void check_reservoir(const Scene& scene, const Wall& wall, const Location& location) {
  if (!wall.temperature) {
    for (const auto& [name, value] :
         {std::pair("friction", wall.friction), std::pair("conduction", wall.conduction)}) {
      if (value == 0) continue;
      location.member(name).refuse(
          fmt::format("is {}, but a wall without temperature is adiabatic; allowed is 0, or a "
                      "temperature beside it",
                      describe(value)));
    }
    return;
  }
  if (wall.friction == 0 && wall.conduction == 0) {
    location.member("temperature")
        .refuse(fmt::format("is {}, but neither friction nor conduction is given, without which "
                            "nothing is exchanged; allowed is to leave it out, or one of them > 0",
                            describe(*wall.temperature)));
  }
  const double bath = scene.fluid.temperature;
  if (!scene.fluid.isothermal || *wall.temperature == bath) return;
  location.member("temperature")
      .refuse(fmt::format("is {}, but isothermal is true and all is in contact with one bath; "
                          "allowed is the scene's temperature {}",
                          describe(*wall.temperature), describe(bath)));
}

}  // namespace

void check_walls(const Scene& scene, const Location& location) {
  for (std::size_t face = 0; face < scene.walls.size(); ++face) {
    if (scene.walls[face].has_value() != scene.walls[face ^ 1].has_value()) {
      const auto there = scene.walls[face] ? face : face ^ 1;
      location.refuse(fmt::format(
          "has {}, a wall at one side of the box alone; allowed is to have {} too, or neither",
          wall_names[there], wall_names[there ^ 1]));
    }
    if (!scene.walls[face]) continue;
    check_reservoir(scene, *scene.walls[face], location.member(wall_names[face]));
  }
}

void check_gravity(const Scene& scene, const Location& location) {
  const Box box = scene_box(scene);
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (scene.gravity[axis] == 0) continue;
    ++axes;
    if (axes < 2 && box.is_walled(axis)) continue;
    location.refuse(fmt::format(
        "is [{}, {}, {}]; allowed is a vector along one axis, which has "
        "walls",
        describe(scene.gravity[0]), describe(scene.gravity[1]), describe(scene.gravity[2])));
  }
}

/// Every drive has numbers of its own, which the others have not.
void check_slabs(const HeatSlabs& slabs, const Location& location) {
  const bool by_rate = slabs.drive == SlabDrive::heat_rate;
  const bool by_temperatures = slabs.drive == SlabDrive::temperatures;
  const auto check = [&](const char* key, double value, bool needed, const char* drive) {
    if (needed && value == 0) {
      location.member(key).refuse(
          fmt::format("is missing; allowed is a number > 0 with the drive \"{}\"", drive));
    }
    if (needed || value == 0) return;
    location.member(key).refuse(
        fmt::format("is {}, but it is of the drive \"{}\" alone; allowed is to leave it out",
                    describe(value), drive));
  };
  check("rate", slabs.rate, by_rate, "heat-rate");
  check("hot_temperature", slabs.hot_temperature, by_temperatures, "temperatures");
  check("cold_temperature", slabs.cold_temperature, by_temperatures, "temperatures");
  if (!by_temperatures || slabs.hot_temperature > slabs.cold_temperature) return;
  location.member("hot_temperature")
      .refuse(fmt::format("is {}, not above cold_temperature; allowed is a number > {}",
                          describe(slabs.hot_temperature), describe(slabs.cold_temperature)));
}

void check_species(const Scene& scene, const Location& location) {
  double shares = 0;
  for (const double share : scene.further_shares) shares += share;
  if (!(shares < 1)) {
    location.member("species").refuse(
        fmt::format("has shares that add up to {}; allowed is below 1, the rest is the first "
                    "species",
                    describe(shares)));
  }
  const auto species = scene_species(scene);
  for (std::size_t n = 0; n < scene.further_shares.size(); ++n) {
    if (std::find(species.begin(), species.end(), n + 1) != species.end()) continue;
    location.member("species").element(n).member("share").refuse(
        fmt::format("is {}, of which {} particles make none; allowed is about {} or more",
                    describe(scene.further_shares[n]), scene.particles,
                    describe(1 / static_cast<double>(scene.particles))));
  }
}

void check_species_pairs(const Scene& scene, const Location& location) {
  const auto& pairs = scene.fluid.pairs;
  const auto last = scene.further_shares.size();
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const Location place = location.element(n);
    for (const auto& [key, number] :
         {std::pair("first", pairs[n].a), std::pair("second", pairs[n].b)}) {
      if (number <= last) continue;
      place.member(key).refuse(
          fmt::format("is {}; allowed is an integer from 0 to {}", number, last));
    }
    if (!pairs[n].repulsion && !pairs[n].friction && !pairs[n].conduction) {
      place.refuse("gives no coefficient; allowed is repulsion, friction, conduction or several");
    }
    const auto same = [&](const PairParameters& other) {
      return std::minmax(other.a, other.b) == std::minmax(pairs[n].a, pairs[n].b);
    };
    if (std::find_if(pairs.begin(), pairs.end(), same) == pairs.begin() + static_cast<long>(n)) {
      continue;
    }
    place.refuse(fmt::format("is the pair of species {} and {} again; allowed is every pair once",
                             pairs[n].a, pairs[n].b));
  }
}

}  // namespace driftless
