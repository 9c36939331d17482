#pragma once

#include "experiments/location.hpp"
#include "experiments/scene.hpp"

/// What walls, field, slabs and species of a scene must be for each other. `location` is that of
/// the key; all throw InputError.
namespace driftless {

void check_walls(const Scene& scene, const Location& location);
void check_gravity(const Scene& scene, const Location& location);
void check_slabs(const HeatSlabs& slabs, const Location& location);
/// `location` is that of the scene.
void check_species(const Scene& scene, const Location& location);
void check_species_pairs(const Scene& scene, const Location& location);

}  // namespace driftless
