#pragma once

#include <cstdint>
#include <vector>

#include "model/state.hpp"

/// Transport through particles that lie still: what conduction and friction over their range
/// transport where neighbours are few.
namespace driftless::transport {

/// Conductivity in units of what theory says of a uniform gradient, (rho^2/6) int w r^2 d^3r: the
/// network of conductances w(r) = (1 - r/range)^exponent between all pairs is solved (conjugate
/// gradients) for the temperatures that a mean gradient along an axis makes stationary. At most 1
/// but for the noise of the positions, as the uniform gradient makes more entropy than the
/// stationary one (variational principle); far below 1 where few particles interact. Throws
/// std::invalid_argument if the box is shorter than twice the range.
double network_conductivity(const std::vector<Vector>& positions, const Box& box, double range,
                            double exponent, int axis);

/// Viscosity of the same network of frictions, each along its pair, in units of (rho^2/30) int w
/// r^2 d^3r: velocities across `axis`, along the next one, on a mean shear.
double network_viscosity(const std::vector<Vector>& positions, const Box& box, double range,
                         double exponent, int axis);

/// Both, of particles put at random into a cubic box, so many in a sphere of the range; means over
/// the axes.
struct NetworkTransport {
  double conductivity = 0, viscosity = 0;
};
NetworkTransport random_network(std::size_t particles, double neighbours, double exponent,
                                std::uint64_t seed);

}  // namespace driftless::transport
