#include "experiments/transport/starts.hpp"

#include <cmath>

#include "model/initial.hpp"

namespace driftless::transport {

FluidBox fluid_box(double length, double width, double density) {
  const auto particles = static_cast<std::size_t>(std::lround(length * width * width * density));
  // The density is exact, the width gives way.
  const double across = std::sqrt(static_cast<double>(particles) / (density * length));
  return {Box{Vector(length, across, across)}, particles};
}

System ideal_start(const FluidParameters& parameters, const FluidBox& box, const Noise& noise) {
  const Fluid fluid(parameters);
  State state = place(box.box, Layout::fluid, Placement::random, box.particles, 0, noise);
  const auto law = microcanonical_law(fluid, Layout::fluid, box.particles);
  draw_microcanonical(fluid, Layout::fluid, law.energy_at(parameters.temperature), noise, state);
  return System(fluid, box.box, std::move(state), noise);
}

}  // namespace driftless::transport
