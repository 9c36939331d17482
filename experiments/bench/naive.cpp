#include "experiments/bench/naive.hpp"

#include <cmath>
#include <stdexcept>

namespace driftless {

class NaiveFluid::PairInteraction {
 public:
  explicit PairInteraction(const FluidParameters& fluid) : fluid_(fluid) {}
  virtual ~PairInteraction() = default;
  virtual void compute(NaiveParticle& i, NaiveParticle& j, const Vector& e, double r) = 0;

 protected:
  double weight(double r) const {
    return std::pow(1 - r / fluid_.friction_range, fluid_.weight_exponent);
  }
  double temperature(const NaiveParticle& particle) const {
    return particle.internal_energy / fluid_.heat_capacity;
  }
  double repulsive_force(double r) const {
    return fluid_.repulsion * (1 - r / fluid_.repulsion_range);
  }
  /// zeta = zeta_0 w T/Theta, where 1/Theta is the mean of 1/theta_i and 1/theta_j.
  double friction(const NaiveParticle& i, const NaiveParticle& j, double r) const {
    const double inverse_mean = 0.5 * (1 / temperature(i) + 1 / temperature(j));
    return fluid_.friction * weight(r) * fluid_.temperature * inverse_mean;
  }
  /// Gamma = (2 k zeta_0 w T)^{1/2}.
  double friction_noise(double r) const {
    return std::sqrt(2 * fluid_.boltzmann * fluid_.friction * weight(r) * fluid_.temperature);
  }
  /// What i receives from j: L_0 w (1/theta_i - 1/theta_j) dt + (2 k L_0 w dt)^{1/2} W.
  double heat(const NaiveParticle& i, const NaiveParticle& j, double r, double dt, double w) const {
    const double coefficient = fluid_.conduction * weight(r);
    return coefficient * (1 / temperature(i) - 1 / temperature(j)) * dt +
           std::sqrt(2 * fluid_.boltzmann * coefficient * dt) * w;
  }

  const FluidParameters& fluid_;
};

namespace {

using PairInteraction = NaiveFluid::PairInteraction;

/// Adds the conservative force.
class Repulsion : public PairInteraction {
 public:
  using PairInteraction::PairInteraction;
  void compute(NaiveParticle& i, NaiveParticle& j, const Vector& e, double r) override {
    const double force = repulsive_force(r);
    i.force += force * e;
    j.force -= force * e;
  }
};

/// Sums up the potential energy.
class Potential : public PairInteraction {
 public:
  using PairInteraction::PairInteraction;
  void compute(NaiveParticle&, NaiveParticle&, const Vector&, double r) override {
    energy += 0.5 * fluid_.repulsion * fluid_.repulsion_range *
              std::pow(1 - r / fluid_.repulsion_range, 2);
  }
  double energy = 0;
};

/// Adds impulses and heats over dt, from the state as it stands.
class Exchanges : public PairInteraction {
 public:
  Exchanges(const FluidParameters& fluid, double dt, NaiveFluid::Normals& normals)
      : PairInteraction(fluid), dt_(dt), normals_(normals) {}

  void compute(NaiveParticle& i, NaiveParticle& j, const Vector& e, double r) override {
    const double v = (i.velocity - j.velocity).dot(e);
    const double zeta = friction(i, j, r);
    const double gamma = friction_noise(r);
    const double noise = gamma * std::sqrt(dt_) * normals_();
    const double impulse = repulsive_force(r) * dt_ - zeta * v * dt_ + noise;
    // Half of the work of friction and noise each; its mean is known, <noise^2> = gamma^2 dt.
    const double work = (zeta * v * v - gamma * gamma / fluid_.mass) * dt_ - v * noise;
    const double q = heat(i, j, r, dt_, normals_());
    i.impulse += impulse * e;
    j.impulse -= impulse * e;
    i.heat += 0.5 * work + q;
    j.heat += 0.5 * work - q;
  }

 private:
  double dt_;
  NaiveFluid::Normals& normals_;
};

/// Friction of one pair over dt, its loss of kinetic energy shared as heat, then its conduction:
/// half a step explicit, half a step implicit [Lisal, Brennan, Avalos 2011].
class PairUpdate : public PairInteraction {
 public:
  PairUpdate(const FluidParameters& fluid, double dt, NaiveFluid::Normals& normals)
      : PairInteraction(fluid), dt_(dt), normals_(normals) {}

  void compute(NaiveParticle& i, NaiveParticle& j, const Vector& e, double r) override {
    const double m = fluid_.mass;
    const double zeta = friction(i, j, r);
    const double noise = friction_noise(r) * std::sqrt(dt_) * normals_();
    const double before = 0.5 * m * (i.velocity.squaredNorm() + j.velocity.squaredNorm());
    double v = (i.velocity - j.velocity).dot(e);
    exchange(i, j, e, 0.5 * (-zeta * v * dt_ + noise));
    v = (i.velocity - j.velocity).dot(e);
    const double damping = zeta * dt_ / (1 + zeta * dt_ / m);
    exchange(i, j, e, 0.5 * (-damping * (v + noise / m) + noise));
    const double after = 0.5 * m * (i.velocity.squaredNorm() + j.velocity.squaredNorm());
    i.internal_energy -= 0.5 * (after - before);
    j.internal_energy -= 0.5 * (after - before);
    const double q = heat(i, j, r, dt_, normals_());
    i.internal_energy += q;
    j.internal_energy -= q;
  }

 private:
  void exchange(NaiveParticle& i, NaiveParticle& j, const Vector& e, double impulse) const {
    i.velocity += impulse / fluid_.mass * e;
    j.velocity -= impulse / fluid_.mass * e;
  }

  double dt_;
  NaiveFluid::Normals& normals_;
};

}  // namespace

NaiveFluid::NaiveFluid(const FluidParameters& fluid, const Box& box, const State& start,
                       std::uint64_t seed)
    : fluid_(fluid), box_(box), normals_{std::mt19937_64(seed), {}}, particles_(start.size()) {
  const double range = fluid.friction_range;
  if (fluid.friction_closure != FrictionClosure::noise ||
      fluid.heat_form != HeatForm::inverse_temperature || fluid.repulsion_range != range ||
      fluid.heat_range != range || !Fluid(fluid).has_constant_heat_capacities() ||
      Fluid(fluid).noise_follows_energies() || fluid.thermal_repulsion != 0 ||
      box.lengths.minCoeff() < 3 * range) {
    throw std::invalid_argument("the naive reference knows the soft fluid alone");
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_[i].position = start.position[i];
    particles_[i].velocity = start.velocity[i];
    particles_[i].internal_energy = start.internal_energy[i];
  }
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = static_cast<int>(box.lengths[axis] / range);
}

Vector NaiveFluid::shortest(Vector difference) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box_.lengths[axis];
    difference[axis] -= length * std::round(difference[axis] / length);
  }
  return difference;
}

Vector NaiveFluid::inside(Vector position) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box_.lengths[axis];
    position[axis] -= length * std::floor(position[axis] / length);
    if (position[axis] >= length) position[axis] = 0;  // a tiny negative number, rounded
  }
  return position;
}

std::array<int, 3> NaiveFluid::cell_of(const NaiveParticle& particle) const {
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = static_cast<int>(particle.position[axis] / box_.lengths[axis] * cells_[axis]);
  }
  return cell;
}

int& NaiveFluid::first_in(int x, int y, int z) {
  x = (x + cells_[0]) % cells_[0];
  y = (y + cells_[1]) % cells_[1];
  z = (z + cells_[2]) % cells_[2];
  return first_in_cell_[(z * cells_[1] + y) * cells_[0] + x];
}

void NaiveFluid::sort_into_cells() {
  first_in_cell_.assign(cells_[0] * cells_[1] * cells_[2], -1);
  next_in_cell_.resize(particles_.size());
  for (int i = 0; i < static_cast<int>(particles_.size()); ++i) {
    const auto [x, y, z] = cell_of(particles_[i]);
    int& first = first_in(x, y, z);
    next_in_cell_[i] = first;
    first = i;
  }
}

void NaiveFluid::add_pairs_of(int i) {
  const double range = fluid_.friction_range;
  const auto [x, y, z] = cell_of(particles_[i]);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        for (int j = first_in(x + dx, y + dy, z + dz); j >= 0; j = next_in_cell_[j]) {
          if (j <= i) continue;
          const Vector difference = shortest(particles_[i].position - particles_[j].position);
          if (difference.squaredNorm() < range * range) pairs_.push_back({i, j});
        }
      }
    }
  }
}

void NaiveFluid::renew_pairs() {
  if (pairs_are_current_) return;
  pairs_are_current_ = true;
  pairs_.clear();
  sort_into_cells();
  for (int i = 0; i < static_cast<int>(particles_.size()); ++i) add_pairs_of(i);
}

void NaiveFluid::visit(PairInteraction& interaction) {
  renew_pairs();
  for (const auto& [i, j] : pairs_) {
    const Vector difference = shortest(particles_[i].position - particles_[j].position);
    const double r = difference.norm();
    interaction.compute(particles_[i], particles_[j], difference / r, r);
  }
}

void NaiveFluid::renew_forces() {
  if (forces_are_current_) return;
  forces_are_current_ = true;
  for (auto& particle : particles_) particle.force.setZero();
  Repulsion repulsion(fluid_);
  visit(repulsion);
}

void NaiveFluid::force_parallel_step(double dt) {
  for (auto& particle : particles_) {
    particle.impulse.setZero();
    particle.heat = 0;
  }
  Exchanges exchanges(fluid_, dt, normals_);
  visit(exchanges);
  for (auto& particle : particles_) {
    particle.position = inside(particle.position + particle.velocity * dt);
    particle.velocity += particle.impulse / fluid_.mass;
    particle.internal_energy += particle.heat;
  }
  pairs_are_current_ = forces_are_current_ = false;
}

void NaiveFluid::sequential_step(double dt) {
  PairUpdate update(fluid_, dt, normals_);
  visit(update);
  renew_forces();
  for (auto& particle : particles_) {
    particle.velocity += particle.force * dt / (2 * fluid_.mass);
    particle.position = inside(particle.position + particle.velocity * dt);
  }
  pairs_are_current_ = forces_are_current_ = false;
  renew_forces();
  for (auto& particle : particles_) {
    particle.velocity += particle.force * dt / (2 * fluid_.mass);
  }
}

std::size_t NaiveFluid::pairs() {
  renew_pairs();
  return pairs_.size();
}

double NaiveFluid::potential_energy() {
  Potential potential(fluid_);
  visit(potential);
  return potential.energy;
}

}  // namespace driftless
