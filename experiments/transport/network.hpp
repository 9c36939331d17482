#pragma once

#include <cstdint>
#include <vector>

#include "model/state.hpp"

namespace driftless::transport {

/// How well particles that lie still conduct, in units of what theory says of them for a uniform
/// gradient, (rho^2/6) int w r^2 d^3r: the network of conductances w(r) = (1 - r/range)^exponent
/// between all pairs is solved (conjugate gradients) for the temperatures that a mean gradient
/// along an axis makes stationary. At most 1 but for the noise of the positions, as the uniform
/// gradient makes more entropy than the stationary one (variational principle); far below 1 where
/// few particles interact. Throws std::invalid_argument if the box is shorter than twice the range.
double network_conductivity(const std::vector<Vector>& positions, const Box& box, double range,
                            double exponent, int axis);

/// The same for particles put at random into a cubic box, so many in a sphere of the range.
double random_network_conductivity(std::size_t particles, double neighbours, double exponent,
                                   std::uint64_t seed);

}  // namespace driftless::transport
