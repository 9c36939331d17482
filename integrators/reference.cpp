#include "integrators/reference.hpp"

#include <cmath>
#include <stdexcept>

#include "integrators/ode_solvers.hpp"

namespace driftless {
namespace {

using Unknowns = Eigen::Map<const Eigen::VectorXd>;
using UnknownRates = Eigen::Map<Eigen::VectorXd>;

/// The right-hand side over the unknowns (r, v, u): 3N positions, 3N velocities, N energies.
struct Equations {
  const Fluid& fluid;
  const Box& box;
  bool frozen;
  Eigen::Index particles;
  const std::vector<std::uint8_t>& species;
  mutable std::vector<double> factors = {};

  std::size_t species_of(Eigen::Index i) const {
    return species.empty() ? 0 : species[static_cast<std::size_t>(i)];
  }

  void rates(const Unknowns& y, UnknownRates& dy) const {
    const Eigen::Index n = particles;
    dy.setZero();
    if (fluid.repulsion_follows_temperatures()) find_factors(y);
    if (!frozen) dy.head(3 * n) = y.segment(3 * n, 3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = i + 1; j < n; ++j) add_pair(y, i, j, dy);
    }
  }

  /// chi of every particle.
  void find_factors(const Unknowns& y) const {
    factors.assign(static_cast<std::size_t>(particles), 1.0);
    for (Eigen::Index i = 0; i < particles; ++i) {
      for (Eigen::Index j = i + 1; j < particles; ++j) {
        const double r = box.minimum_image(y.segment<3>(3 * i) - y.segment<3>(3 * j)).norm();
        if (r >= fluid.range()) continue;
        const double half = 0.5 * fluid.law(species_of(i), species_of(j)).thermal_shape(r);
        factors[static_cast<std::size_t>(i)] += half * slope(i);
        factors[static_cast<std::size_t>(j)] += half * slope(j);
      }
    }
  }
  /// dchi/dW = a_1/(phi T).
  double slope(Eigen::Index i) const {
    const auto& f = fluid.parameters();
    const auto& state = fluid.equation_of_state(species_of(i));
    return f.thermal_repulsion * state.inverse_heat_capacity(1.0) / f.temperature;
  }
  /// The force of a pair that follows the temperatures, and the energies that pay for it: u beta_i
  /// dW/dt of each, where u beta = a_1 theta/T and u = eps/chi.
  double add_thermal(const Pair<double>& pair, Eigen::Index i, Eigen::Index j,
                     UnknownRates& dy) const {
    const double shape = pair.law->thermal_shape_force(pair.r);
    auto u_dot = dy.tail(particles);
    const double of_i = 0.5 * shape * slope(i) * pair.u_i / factors[static_cast<std::size_t>(i)];
    const double of_j = 0.5 * shape * slope(j) * pair.u_j / factors[static_cast<std::size_t>(j)];
    u_dot[i] -= of_i * pair.v;
    u_dot[j] -= of_j * pair.v;
    return of_i + of_j;
  }

  void add_pair(const Unknowns& y, Eigen::Index i, Eigen::Index j, UnknownRates& dy) const {
    const Vector r_i = y.segment<3>(3 * i), r_j = y.segment<3>(3 * j);
    const Vector difference = box.minimum_image(r_i - r_j);
    const double r = difference.norm();
    if (r >= fluid.range() || r == 0) return;
    const Vector e = difference / r;
    auto v_dot = dy.segment(3 * particles, 3 * particles);
    auto u_dot = dy.tail(particles);
    const auto velocity = y.segment(3 * particles, 3 * particles);
    const double v = (velocity.segment<3>(3 * i) - velocity.segment<3>(3 * j)).dot(e);
    const double u_i = y[6 * particles + i], u_j = y[6 * particles + j];
    const PairLaw& law = fluid.law(species_of(i), species_of(j));
    const Pair<double> pair{
        r, law.friction_weight(r), law.heat_weight(r), v, u_i, u_j, 0, 0, 1, 1, &law};
    double force = law.repulsive_force(r);
    if (fluid.repulsion_follows_temperatures() && !frozen) force += add_thermal(pair, i, j, dy);
    if (fluid.has_friction()) {
      const double drag = fluid.friction(pair).friction * v;
      force -= drag;
      u_dot[i] += 0.5 * drag * v;
      u_dot[j] += 0.5 * drag * v;
    }
    if (fluid.has_conduction()) {
      const double rate = fluid.conduction(pair).rate;
      u_dot[i] += rate;
      u_dot[j] -= rate;
    }
    v_dot.segment<3>(3 * i) += force / fluid.mass(species_of(i)) * e;
    v_dot.segment<3>(3 * j) -= force / fluid.mass(species_of(j)) * e;
  }
};

void require_solvable(const Fluid& fluid, const Box& box, double duration) {
  if (fluid.fluctuates()) {
    throw std::invalid_argument("the reference solution is of a fluid with boltzmann = 0");
  }
  if (!(duration >= 0) || !std::isfinite(duration)) {
    throw std::invalid_argument("the duration of a reference solution is at least 0");
  }
  if (box.is_bounded()) {
    throw std::invalid_argument("the reference solution is of a periodic box");
  }
  if (box.lengths.minCoeff() < 2 * fluid.range()) {
    throw std::invalid_argument("the box is shorter than twice the range of the interaction");
  }
}

}  // namespace

State reference_solution(const Fluid& fluid, const Box& box, const State& start, bool frozen,
                         double duration, const ReferenceTolerance& tolerance,
                         ReferenceSolver solver) {
  require_solvable(fluid, box, duration);
  if (duration == 0 || start.size() == 0) return start;
  const auto n = static_cast<Eigen::Index>(start.size());
  Eigen::VectorXd y(7 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto place = static_cast<std::size_t>(i);
    y.segment<3>(3 * i) = start.position[place];
    y.segment<3>(3 * (n + i)) = start.velocity[place];
    y[6 * n + i] = start.internal_energy[place];
  }
  const Equations equations{fluid, box, frozen, n, start.species};
  const auto rates = [&](const Unknowns& at, UnknownRates& dy) { equations.rates(at, dy); };
  y = solve_ode(rates, y, duration, solver, tolerance);
  State end = start;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto place = static_cast<std::size_t>(i);
    end.position[place] = box.wrap(y.segment<3>(3 * i));
    end.velocity[place] = y.segment<3>(3 * (n + i));
    end.internal_energy[place] = y[6 * n + i];
  }
  return end;
}

}  // namespace driftless
