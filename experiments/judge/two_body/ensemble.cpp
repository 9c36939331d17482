#include "experiments/judge/two_body/ensemble.hpp"

#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <set>

namespace driftless::two_body {
namespace {

void start_far(const Bench& bench, State& state) {
  const double kinetic = 0.01 * bench.law().kinetic_energy(bench.energy);
  const double speed = std::sqrt(kinetic / bench.fluid.mass());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const bool first = i % 2 == 0;
    state.velocity[i] = Vector(first ? speed : -speed, 0, 0);
    state.internal_energy[i] = (first ? 0.85 : 0.15) * (bench.energy - kinetic);
  }
}

/// A normal variate of the given mean and spread, drawn again until it is between the bounds.
double draw_between(double lower, double upper, double mean, double spread, NoiseStream& stream) {
  boost::random::normal_distribution<double> normal(mean, spread);
  for (;;) {
    const double value = normal(stream);
    if (lower < value && value < upper) return value;
  }
}

void start_isothermal_cloud(const Bench& bench, const Noise& noise, State& state) {
  const double mass = bench.reduced_mass(), speed = std::sqrt(2 * bench.energy / mass);
  boost::random::normal_distribution<double> normal(3 * speed, 0.5 * speed);
  for (std::size_t i = 0; i < state.size(); i += 2) {
    auto velocities = noise.particle_stream(state.id[i], Purpose::initial_velocity);
    const Vector velocity(normal(velocities), 0, 0);
    state.velocity[i] = mass / bench.fluid.mass(state.species_of(i)) * velocity;
    state.velocity[i + 1] = -mass / bench.fluid.mass(state.species_of(i + 1)) * velocity;
  }
}

void start_in_cloud(const Bench& bench, const Noise& noise, State& state) {
  if (bench.fluid.isothermal()) return start_isothermal_cloud(bench, noise, state);
  const double shape = bench.law().shape, mass = bench.fluid.mass();
  const double width = std::sqrt(0.25 / (2 * shape + 1));  // of u_i/(u_i + u_j)
  const double speed = std::sqrt(bench.law().kinetic_energy(bench.energy) / mass);
  const double fastest = std::sqrt(0.9 * bench.energy / mass);
  for (std::size_t i = 0; i < state.size(); i += 2) {
    auto velocities = noise.particle_stream(state.id[i], Purpose::initial_velocity);
    auto energies = noise.particle_stream(state.id[i], Purpose::initial_energy);
    const double v = draw_between(-fastest, fastest, 3 * speed, 0.5 * speed, velocities);
    const double share = draw_between(0.02, 0.98, 0.5 + 2 * width, 0.5 * width, energies);
    state.velocity[i] = Vector(v, 0, 0);
    state.velocity[i + 1] = -state.velocity[i];
    const double internal = bench.energy - mass * v * v;
    state.internal_energy[i] = share * internal;
    state.internal_energy[i + 1] = (1 - share) * internal;
  }
}

System build(const Bench& bench, const Pairs& pairs) {
  const Noise noise(pairs.seed, pairs.replica);
  const std::size_t particles = 2 * pairs.count;
  const Box box = make_box(bench.fluid, Layout::pairs, particles, 1, bench.pair_distance);
  State state =
      place(box, Layout::pairs, Placement::lattice, particles, bench.pair_distance, noise);
  for (std::size_t i = 0; i < particles && bench.fluid.species() > 1; ++i) {
    state.species.push_back(static_cast<std::uint8_t>(i % 2));
  }
  if (bench.fluid.isothermal()) {
    draw_canonical(bench.fluid, Layout::pairs, bench.fluid.parameters().temperature, noise, state);
  } else {
    draw_microcanonical(bench.fluid, Layout::pairs, bench.energy, noise, state);
  }
  if (pairs.start == Start::far) start_far(bench, state);
  if (pairs.start == Start::cloud) start_in_cloud(bench, noise, state);
  boost_frame(Vector(pairs.frame_velocity, 0, 0), state);
  return {bench.fluid, box, std::move(state), noise, true};
}

std::vector<std::size_t> pairs_of(const StepFailure& failure) {
  std::set<std::size_t> pairs;
  for (const auto id : failure.ids()) pairs.insert(id / 2);
  return {pairs.begin(), pairs.end()};
}

}  // namespace

Ensemble::Ensemble(const Bench& bench, const Pairs& pairs)
    : bench_(bench),
      noise_(pairs.seed, pairs.replica),
      system_(build(bench, pairs)),
      alive_(pairs.count, true) {}

void Ensemble::step(Integrator& integrator, double dt) {
  ++step_;
  noise_.set_step(step_);
  system_.set_step(step_);
  before_ = system_.motion();
  kept_ = integrator.save();
  for (;;) {
    try {
      integrator.step(system_, dt);
      break;
    } catch (const StepFailure& failure) {
      const auto failed =
          failure.ids().empty() ? culprits(integrator, dt, 0, size()) : pairs_of(failure);
      if (failed.empty()) throw;
      give_up(failed, failure.cause());
      roll_back(integrator, 0, size());
    }
  }
  give_up_runaways(integrator);
}

PairView Ensemble::view(std::size_t pair) const {
  const auto& motion = system_.motion();
  // e points from the second particle, at the smaller x, to the first.
  const double v = motion.velocity[2 * pair].x() - motion.velocity[2 * pair + 1].x();
  return {v, 0.5 * bench_.reduced_mass() * v * v, motion.internal_energy[2 * pair],
          motion.internal_energy[2 * pair + 1]};
}

double Ensemble::whole_energy(std::size_t pair) const {
  const auto& motion = system_.motion();
  double sum = 0;
  for (const std::size_t i : {2 * pair, 2 * pair + 1}) {
    sum += 0.5 * system_.mass(i) * motion.velocity[i].squaredNorm() + motion.internal_energy[i];
  }
  return sum;
}

Vector Ensemble::momentum(std::size_t pair) const {
  const auto& velocity = system_.motion().velocity;
  const std::size_t i = 2 * pair, j = i + 1;
  return system_.mass(i) * velocity[i] + system_.mass(j) * velocity[j];
}

Noise::PairNormals Ensemble::normals(std::size_t pair, unsigned stage) const {
  const auto id = static_cast<std::uint32_t>(2 * pair);
  return noise_.pair_normals(id, id + 1, stage, true, true);
}

void Ensemble::give_up(const std::vector<std::size_t>& pairs, FailureCause cause) {
  if (!first_failure_) first_failure_ = {cause, step_};
  for (const std::size_t pair : pairs) alive_[pair] = false;
  failed_ += pairs.size();
}

/// Explicit methods can throw a copy to an energy from where it hardly comes back, without any
/// number being illegal: four times the energy, or a quarter, is a failure too.
void Ensemble::give_up_runaways(Integrator& integrator) {
  if (bench_.fluid.isothermal()) return;  // the energy fluctuates by as much as it is
  std::vector<std::size_t> runaways;
  for (std::size_t pair = 0; pair < size(); ++pair) {
    if (!alive_[pair]) continue;
    const double e = view(pair).energy() / bench_.energy;
    if (!(e < 4 && e > 0.25)) runaways.push_back(pair);
  }
  if (runaways.empty()) return;
  give_up(runaways, FailureCause::energy_runaway);
  before_ = system_.motion();
  kept_ = integrator.save();
  roll_back(integrator, 0, size());
}

/// The pairs of a range that fail, where a failure names no particle: found by halving.
std::vector<std::size_t> Ensemble::culprits(Integrator& integrator, double dt, std::size_t first,
                                            std::size_t last) {
  roll_back(integrator, first, last);
  try {
    integrator.step(system_, dt);
    return {};
  } catch (const StepFailure& failure) {
    if (!failure.ids().empty()) return pairs_of(failure);
    if (last - first == 1) return {first};
    const std::size_t middle = (first + last) / 2;
    auto found = culprits(integrator, dt, first, middle);
    const auto others = culprits(integrator, dt, middle, last);
    found.insert(found.end(), others.begin(), others.end());
    return found;
  }
}

/// Back to before the step, without the pairs that failed or lie outside of a range: the two
/// particles of such a pair are put on one spot, where a pair has no direction and exchanges
/// nothing. They keep their places in storage, so that what an integrator keeps from step to step
/// stays in order.
void Ensemble::roll_back(Integrator& integrator, std::size_t first, std::size_t last) {
  State state = system_.state();
  state.velocity = before_.velocity;
  state.internal_energy = before_.internal_energy;
  for (std::size_t pair = 0; pair < size(); ++pair) {
    const bool present = alive_[pair] && first <= pair && pair < last;
    const auto i = 2 * pair, j = i + 1;
    state.position[j] = state.position[i];
    if (present) state.position[j].x() -= bench_.pair_distance;
    if (alive_[pair]) continue;
    state.velocity[i] = state.velocity[j] = Vector::Zero();
    // whatever an impulse kept from the step before may still do to it
    state.internal_energy[i] = state.internal_energy[j] = 100 * bench_.energy;
  }
  system_.set_state(std::move(state));
  if (!kept_.empty()) integrator.load(kept_);
}

}  // namespace driftless::two_body
