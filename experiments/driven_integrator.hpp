#pragma once

#include <memory>

#include "experiments/scene.hpp"
#include "integrators/integrator.hpp"

namespace driftless {

/// A method's integrator as a scene needs it: where heat slabs drive the fluid they act after each
/// of its steps, and are saved with it. `noise` is that of the slabs' draws. Throws
/// std::invalid_argument if the slabs make no sense in the scene.
std::unique_ptr<Integrator> driven(std::unique_ptr<Integrator> integrator, const Scene& scene,
                                   const Noise& noise);

}  // namespace driftless
