#include "experiments/transport/network.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "model/initial.hpp"
#include "model/system.hpp"

namespace driftless::transport {
namespace {

struct Conductance {
  int i, j;
  double weight, distance;  ///< along the gradient
};

std::vector<Conductance> conductances(const std::vector<Vector>& positions, const Box& box,
                                      double range, double exponent, int axis) {
  FluidParameters parameters;
  parameters.heat_form = HeatForm::temperature;
  parameters.conduction = 1;
  parameters.heat_range = range;
  parameters.weight_exponent = exponent;
  State state;
  for (const auto& position : positions) {
    state.id.push_back(static_cast<std::uint32_t>(state.id.size()));
    state.position.push_back(position);
  }
  state.velocity.assign(positions.size(), Vector::Zero());
  state.internal_energy.assign(positions.size(), 1.0);
  System system(Fluid(parameters), box, std::move(state), Noise(0, 0), true);
  std::vector<Conductance> all;
  system.for_each_pair([&](const System::Geometry& pair) {
    all.push_back(
        {static_cast<int>(pair.i), static_cast<int>(pair.j), pair.w_heat, pair.r * pair.e[axis]});
  });
  return all;
}

}  // namespace

double network_conductivity(const std::vector<Vector>& positions, const Box& box, double range,
                            double exponent, int axis) {
  const auto pairs = conductances(positions, box, range, exponent, axis);
  const auto size = static_cast<int>(positions.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd source = Eigen::VectorXd::Zero(size);
  // Temperatures x + t: what flows into a particle is sum_j w (t_j - t_i + x_j - x_i) = 0.
  for (const auto& [i, j, w, distance] : pairs) {
    entries.insert(entries.end(), {{i, i, w}, {j, j, w}, {i, j, -w}, {j, i, -w}});
    source[i] -= w * distance;
    source[j] += w * distance;
  }
  // A particle without neighbours has no equation; the constant temperature solves it.
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1e-12);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-8);
  const Eigen::VectorXd t = solver.compute(matrix).solve(source);
  double power = 0;
  for (const auto& pair : pairs) {
    const double difference = t[pair.i] - t[pair.j] + pair.distance;
    power += pair.weight * difference * difference;
  }
  const double s = exponent;
  // int w x^2 d^3r = (4 pi/3) range^5 4!/((s+1)...(s+5)), half of it for each particle.
  const double expected = 0.5 * size * (size / box.volume()) * (4 * std::numbers::pi / 3) *
                          std::pow(range, 5) * 24 /
                          ((s + 1) * (s + 2) * (s + 3) * (s + 4) * (s + 5));
  return power / expected;
}

double random_network_conductivity(std::size_t particles, double neighbours, double exponent,
                                   std::uint64_t seed) {
  const Box box{Vector::Constant(1)};
  const double range =
      std::cbrt(neighbours / (4 * std::numbers::pi / 3 * static_cast<double>(particles)));
  const State state = place(box, Layout::fluid, Placement::random, particles, 0, Noise(seed, 0));
  double mean = 0;
  for (int axis = 0; axis < 3; ++axis) {
    mean += network_conductivity(state.position, box, range, exponent, axis) / 3;
  }
  return mean;
}

}  // namespace driftless::transport
