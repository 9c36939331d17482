#pragma once

#include "experiments/scene.hpp"

/// The presets with walls, a field or heat slabs.
namespace driftless {

Preset mackie_1999_box();
Preset mackie_1999_roll();
Preset soleymani_2020_slabs();

}  // namespace driftless
