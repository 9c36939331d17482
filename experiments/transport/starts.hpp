#pragma once

#include "model/system.hpp"

namespace driftless::transport {

/// A rectangular box of about so many particles at a density, `length` along x and `width` along
/// the other axes, and how many particles that makes.
struct FluidBox {
  Box box;
  std::size_t particles;
};
FluidBox fluid_box(double length, double width, double density);

/// A fluid without repulsion at equilibrium: random places, velocities and internal energies drawn
/// from the exact law at the temperature at which the fluid is quoted.
System ideal_start(const FluidParameters& fluid, const FluidBox& box, const Noise& noise);

}  // namespace driftless::transport
