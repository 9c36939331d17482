#include "experiments/transport/network.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cmath>
#include <numbers>

#include "model/initial.hpp"
#include "model/system.hpp"

namespace driftless::transport {
namespace {

struct Link {
  int i, j;
  double weight, distance;
  Vector e;
};

std::vector<Link> links_of(const std::vector<Vector>& positions, const Box& box, double range,
                           double exponent) {
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
  std::vector<Link> all;
  system.for_each_pair([&](const System::Geometry& pair) {
    all.push_back(
        {static_cast<int>(pair.i), static_cast<int>(pair.j), pair.w_heat, pair.r, pair.e});
  });
  return all;
}

/// One equation of a network for each unknown x: a link exchanges w (sum_n c_n x_n + imposed).
struct Term {
  int unknown;
  double coefficient;
};
struct Coupling {
  double weight, imposed;
  std::vector<Term> terms;

  double driving(const Eigen::VectorXd& x) const {
    double sum = imposed;
    for (const auto& term : terms) sum += term.coefficient * x[term.unknown];
    return sum;
  }
};

/// The least of sum w (driving)^2.
double least_power(const std::vector<Coupling>& network, int unknowns) {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd source = Eigen::VectorXd::Zero(unknowns);
  for (const auto& link : network) {
    for (const auto& one : link.terms) {
      source[one.unknown] -= link.weight * one.coefficient * link.imposed;
      for (const auto& other : link.terms) {
        entries.emplace_back(one.unknown, other.unknown,
                             link.weight * one.coefficient * other.coefficient);
      }
    }
  }
  // A particle without neighbours has no equation, and all of them may move together.
  for (int n = 0; n < unknowns; ++n) entries.emplace_back(n, n, 1e-9);
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-8);
  const Eigen::VectorXd x = solver.compute(matrix).solve(source);
  double power = 0;
  for (const auto& link : network) power += link.weight * std::pow(link.driving(x), 2);
  return power;
}

/// (N rho/2) int w r^2 d^3r, 4!/((s+1)...(s+5)) being the integral of x^4 (1 - x)^s.
double uniform_power(std::size_t size, const Box& box, double range, double s) {
  const auto particles = static_cast<double>(size);
  return 0.5 * particles * (particles / box.volume()) * 4 * std::numbers::pi * std::pow(range, 5) *
         24 / ((s + 1) * (s + 2) * (s + 3) * (s + 4) * (s + 5));
}

}  // namespace

double network_conductivity(const std::vector<Vector>& positions, const Box& box, double range,
                            double exponent, int axis) {
  std::vector<Coupling> network;
  for (const auto& link : links_of(positions, box, range, exponent)) {
    network.push_back({link.weight, link.distance * link.e[axis], {{link.i, 1}, {link.j, -1}}});
  }
  return least_power(network, static_cast<int>(positions.size())) /
         (uniform_power(positions.size(), box, range, exponent) / 3);
}

double network_viscosity(const std::vector<Vector>& positions, const Box& box, double range,
                         double exponent, int axis) {
  std::vector<Coupling> network;
  for (const auto& link : links_of(positions, box, range, exponent)) {
    Coupling one{link.weight, link.distance * link.e[axis] * link.e[(axis + 1) % 3], {}};
    for (int n = 0; n < 3; ++n) {
      one.terms.push_back({3 * link.i + n, link.e[n]});
      one.terms.push_back({3 * link.j + n, -link.e[n]});
    }
    network.push_back(std::move(one));
  }
  return least_power(network, 3 * static_cast<int>(positions.size())) /
         (uniform_power(positions.size(), box, range, exponent) / 15);
}

NetworkTransport random_network(std::size_t particles, double neighbours, double exponent,
                                std::uint64_t seed) {
  const Box box{Vector::Constant(1)};
  const double range =
      std::cbrt(neighbours / (4 * std::numbers::pi / 3 * static_cast<double>(particles)));
  const State state = place(box, Layout::fluid, Placement::random, particles, 0, Noise(seed, 0));
  NetworkTransport mean;
  for (int axis = 0; axis < 3; ++axis) {
    mean.conductivity += network_conductivity(state.position, box, range, exponent, axis) / 3;
    mean.viscosity += network_viscosity(state.position, box, range, exponent, axis) / 3;
  }
  return mean;
}

}  // namespace driftless::transport
