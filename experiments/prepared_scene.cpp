#include "experiments/prepared_scene.hpp"

#include <cmath>

#include "model/configurations.hpp"

namespace driftless {
namespace {

// The Monte Carlo run of a fluid with repulsion, in paths: enough for the start to be forgotten (a
// path moves a particle by half a diameter), and for references better than most studies.
constexpr int relaxation_paths = 30, pilot_burn_in = 40, pilot_paths = 120;
constexpr int burn_in = 40, chain_paths = 400;
constexpr std::uint64_t pilot_seed = 0;  // the energy belongs to the scene, not to the study

/// Kinetic energy without that of the islands' centres of mass.
double relative_kinetic_energy(const System& system, std::size_t islands) {
  const std::size_t size = system.size() / islands;
  double energy = system.kinetic_energy();
  for (std::size_t first = 0; first + size <= system.size(); first += size) {
    // In units of the first species' mass.
    Vector sum = Vector::Zero();
    double masses = 0;
    for (std::size_t i = first; i < first + size; ++i) {
      const double mass = system.mass(i) / system.fluid().mass();
      sum += mass * system.state().velocity[i];
      masses += mass;
    }
    energy -= 0.5 * system.fluid().mass() * sum.squaredNorm() / masses;
  }
  return energy;
}

double centre_of_mass_energy(const Scene& scene) {
  double masses = static_cast<double>(scene.particles);  // in units of the first species'
  for (const auto species : scene_species(scene)) {
    if (species == 0) continue;
    masses += scene.fluid.further_species[species - 1u].mass / scene.fluid.mass - 1;
  }
  return 0.5 * scene.fluid.mass * masses * scene.frame_velocity.squaredNorm();
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene, std::uint64_t seed, unsigned replicas)
    : scene_(scene), fluid_(scene.fluid), box_(scene_box(scene)), seed_(seed), replicas_(replicas) {
  find_law();
  const bool drawn = starts_in_law(scene_);
  if (fluid_.isothermal()) {
    prepare_isothermal();
  } else if (fluid_.has_repulsion() && fluid_.fluctuates() && drawn) {
    prepare_with_repulsion();
  } else {
    prepare_ideal();
  }
}

double PreparedScene::energy_unit() const {
  const double thermal = fluid_.boltzmann() * scene_.fluid.temperature;
  return thermal > 0 ? thermal : 1;
}

double PreparedScene::thermal_kinetic_energy() const {
  const double islands = static_cast<double>(scene_.particles / island_size());
  return 0.5 * kinetic_degrees() * islands * fluid_.boltzmann() * scene_.fluid.temperature;
}

double PreparedScene::ideal_energy() const {
  const double temperature = scene_.fluid.temperature;
  if (fluid_.has_constant_heat_capacities()) {
    return full_law().energy_at(temperature);
  }
  const double first = fluid_.internal_energy(temperature);
  double further = 0;  // of the other species beyond the first one's
  for (const auto species : scene_species(scene_)) {
    further += fluid_.equation_of_state(species).internal_energy(temperature) - first;
  }
  return 0.5 * kinetic_degrees() * fluid_.boltzmann() * temperature +
         static_cast<double>(island_size()) * first + further;
}

void PreparedScene::find_law() {
  // Walls and slabs take momentum and heat, and other equations of state share energies in other
  // ways.
  if (!fluid_.fluctuates() || box_.is_bounded() || scene_.heat_slabs ||
      !fluid_.has_constant_heat_capacities()) {
    return;
  }
  auto law = full_law();
  // A pair at a fixed distance, or two particles, keep u_i - u_j without conduction; a solid's
  // friction, in few fixed directions, keeps combinations of momenta; without friction nothing ties
  // the kinetic energy to the internal energies.
  if (scene_.frozen && scene_.layout == Layout::fluid && fluid_.has_friction()) return;
  if (fluid_.isothermal()) {
    if (fluid_.has_friction()) distributions_ = {BinnedLaw::normal(), std::nullopt};
    return;
  }
  if (fluid_.has_friction() && (law.particles >= 3 || fluid_.has_conduction())) {
    law_ = law;
  } else if (!fluid_.has_friction() && fluid_.has_conduction()) {
    law.degrees = 0;
    law_ = law;
  }
  if (!law_) return;
  const double total = law_->total_shape();
  // Without kinetic degrees the momenta have no law; the binned one is then not used.
  distributions_ = ExactDistributions{BinnedLaw::signed_root(total - 0.5), std::nullopt};
  if (law_->alike) {
    distributions_->internal_energy = BinnedLaw::beta(law_->shape, total - law_->shape);
  }
}

void PreparedScene::prepare_ideal() {
  System system = start(0);
  total_energy_ = system.total_energy();
  const auto islands = full_law().islands;
  double energy = system.internal_energy();
  if (law_ && law_->degrees > 0) energy += relative_kinetic_energy(system, islands);
  island_energy_ = energy / static_cast<double>(islands);
  if (!law_) return;
  if (fluid_.has_repulsion()) {
    reference_of_shares();
  } else {
    reference_from_law();
  }
}

void PreparedScene::reference_from_law() {
  const double e = island_energy_;
  references_["internal_temperature"] = {law_->internal_temperature(e), 0};
  references_["internal_energy_mean"] = {law_->internal_energy_mean(e), 0};
  if (law_->alike) {
    references_["internal_energy_variance"] = {law_->internal_energy_variance(e), 0};
    references_["internal_energy_skewness"] = {law_->internal_energy_skewness(), 0};
    references_["internal_energy_distance"] = {0, 0};
  }
  if (law_->degrees == 0) return;
  references_["kinetic_temperature"] = {law_->kinetic_temperature(e), 0};
  references_["kinetic_share"] = {1, 0};
  references_["momentum_distance"] = {0, 0};
  if (scene_.layout == Layout::fluid && !scene_.frozen) {
    references_["pressure"] = {static_cast<double>(scene_.particles) / box_.volume() *
                                   fluid_.boltzmann() * law_->kinetic_temperature(e),
                               0};
  }
}

MicrocanonicalLaw PreparedScene::full_law() const {
  return microcanonical_law(fluid_, scene_.layout, scene_.particles, scene_species(scene_));
}

State PreparedScene::on_lattice(const Noise& numbers) const {
  State state = place(box_, scene_.layout, Placement::lattice, scene_.particles,
                      scene_.pair_distance, numbers);
  state.species = scene_species(scene_);
  return state;
}

void PreparedScene::prepare_with_repulsion() {
  const auto law = full_law();
  ConfigurationChain pilot(fluid_, box_, on_lattice({pilot_seed, 0}), {pilot_seed, 0});
  for (int path = 0; path < relaxation_paths; ++path) pilot.relax();
  double potential = 0;
  for (int path = 0; path < pilot_burn_in + pilot_paths; ++path) {
    pilot.advance_canonical();
    if (path >= pilot_burn_in) potential += pilot.system().potential_energy() / pilot_paths;
  }
  const double ideal = ideal_energy();
  const double energy = ideal + potential;
  island_energy_ = ideal;
  total_energy_ = energy + centre_of_mass_energy(scene_);

  // A number of replicas beyond any study's keys the chain apart from the runs.
  ConfigurationChain chain(fluid_, box_, pilot.system().state(), {seed_, ~std::uint64_t{0}});
  Eigen::MatrixXd samples(chain_paths, 6);
  const int apart = std::max(1, chain_paths / static_cast<int>(std::max(1U, replicas_)));
  for (int path = -burn_in; path < chain_paths; ++path) {
    chain.advance_microcanonical(energy, law.total_shape());
    if (path < 0) continue;
    if (fluid_.repulsion_follows_temperatures()) draw_energies(energy, path, chain.system());
    const auto sums = configuration_sums(chain.system());
    samples.row(path) << sums.potential, sums.virial, sums.squared_force, sums.laplacian,
        energy - sums.potential, chain.system().kinetic_energy();
    if (path % apart == 0) configurations_.push_back(chain.system().state());
  }
  while (configurations_.size() < replicas_) configurations_.push_back(chain.system().state());
  if (law_ && law_->degrees > 0) reference_from_chain(samples);
}

/// The forces of a repulsion that follows the temperatures need the energies at these positions.
void PreparedScene::draw_energies(double energy, int path, System& system) const {
  Noise numbers(seed_, ~std::uint64_t{1});  // a replica beyond any study's, and the chain's
  numbers.set_step(static_cast<std::uint64_t>(path));
  State state = system.state();
  draw_microcanonical(fluid_, scene_.layout, energy - system.potential_energy(), numbers, state);
  system.set_motion(state);
}

/// Whatever the start, the bath leads to its own temperature, exactly.
void PreparedScene::prepare_isothermal() {
  const double thermal = fluid_.boltzmann() * scene_.fluid.temperature;
  const double ideal_pressure = static_cast<double>(scene_.particles) / box_.volume() * thermal;
  if (distributions_) {
    references_["kinetic_temperature"] = {scene_.fluid.temperature, 0};
    references_["momentum_distance"] = {0, 0};
    if (fluid_.has_repulsion()) {
      references_["configurational_temperature"] = {scene_.fluid.temperature, 0};
    } else if (scene_.layout == Layout::fluid) {
      references_["pressure"] = {ideal_pressure, 0};
    }
  }
  if (!starts_in_law(scene_)) {
    total_energy_ = start(0).total_energy();
    return;
  }
  total_energy_ = thermal_kinetic_energy() + centre_of_mass_energy(scene_);
  if (fluid_.has_repulsion()) sample_canonical_configurations();
}

void PreparedScene::sample_canonical_configurations() {
  const Noise numbers(seed_, ~std::uint64_t{0});  // a replica beyond any study's
  ConfigurationChain chain(fluid_, box_, on_lattice(numbers), numbers);
  for (int path = 0; path < relaxation_paths; ++path) chain.relax();
  Eigen::MatrixXd potential(chain_paths, 1), pressure(chain_paths, 1);
  const int apart = std::max(1, chain_paths / static_cast<int>(std::max(1U, replicas_)));
  const double n = static_cast<double>(scene_.particles);
  const double thermal = fluid_.boltzmann() * scene_.fluid.temperature;
  for (int path = -pilot_burn_in - burn_in; path < chain_paths; ++path) {
    chain.advance_canonical();
    if (path < 0) continue;
    const auto sums = configuration_sums(chain.system());
    potential(path, 0) = sums.potential / n;
    pressure(path, 0) = (n * thermal + sums.virial / 3) / box_.volume();
    if (path % apart == 0) configurations_.push_back(chain.system().state());
  }
  while (configurations_.size() < replicas_) configurations_.push_back(chain.system().state());
  total_energy_ += n * potential.mean();
  if (scene_.frozen) return;  // every replica keeps a configuration of its own
  const auto set = [&](const char* name, const Eigen::MatrixXd& samples) {
    const auto result = estimate({samples}, [](const Eigen::VectorXd& m) { return m[0]; });
    references_[name] = {result.mean, result.error};
  };
  set("potential_energy", potential);
  set("pressure", pressure);
}

void PreparedScene::reference_of_shares() {
  references_["kinetic_share"] = {1, 0};
  references_["momentum_distance"] = {0, 0};
  if (law_->alike) references_["internal_energy_distance"] = {0, 0};
}

void PreparedScene::reference_from_chain(const Eigen::MatrixXd& samples) {
  reference_of_shares();
  if (scene_.frozen) return;  // every replica keeps a configuration of its own
  const auto law = full_law();
  const double n = static_cast<double>(scene_.particles), k = fluid_.boltzmann();
  const double total = law.total_shape(), a = law.shape;
  const auto set = [&](const char* name, const Eigen::MatrixXd& columns,
                       const DerivedQuantity& derived) {
    const auto result = estimate({columns}, derived);
    references_[name] = {result.mean, result.error};
  };
  const auto mean = [](const Eigen::VectorXd& m) { return m[0]; };
  const auto column = [&](int index) { return Eigen::MatrixXd(samples.col(index)); };
  // e = E - Psi, of which the kinetic and internal energies take their Dirichlet shares.
  set("potential_energy", column(0) / n, mean);
  set("kinetic_temperature", column(4) / (k * total), mean);
  set("internal_temperature", column(4).cwiseInverse() * (k * (total - 1)),
      [](const Eigen::VectorXd& m) { return 1 / m[0]; });
  // In this ensemble <lap Psi> = (A - 1) <|grad Psi|^2/(E - Psi)> exactly, which fluctuates less;
  // with energies that Psi depends on, (d/2 - 1) <|grad Psi|^2/K>.
  const bool thermal = fluid_.repulsion_follows_temperatures();
  const double exponent = thermal ? 0.5 * law.degrees - 1 : total - 1;
  Eigen::MatrixXd forces(samples.rows(), 2);
  forces << column(2), column(2).cwiseQuotient(column(thermal ? 5 : 4));
  set("configurational_temperature", forces,
      [&](const Eigen::VectorXd& m) { return m[0] / (k * exponent * m[1]); });
  set("pressure", column(4) * (n / (total * box_.volume())) + column(1) / (3 * box_.volume()),
      mean);
  set("internal_energy_mean", column(4) * ((a + law.excess_shape / n) / total), mean);
  if (!law.alike) return;
  Eigen::MatrixXd powers(samples.rows(), 3);
  powers.col(0) = column(4) * (a / total);
  powers.col(1) = column(4).array().square() * (a * (a + 1) / (total * (total + 1)));
  powers.col(2) =
      column(4).array().cube() * (a * (a + 1) * (a + 2) / (total * (total + 1) * (total + 2)));
  const auto variance = [](const Eigen::VectorXd& m) { return m[1] - m[0] * m[0]; };
  set("internal_energy_variance", powers, variance);
  set("internal_energy_skewness", powers, [&](const Eigen::VectorXd& m) {
    return (m[2] - 3 * m[0] * m[1] + 2 * std::pow(m[0], 3)) / std::pow(variance(m), 1.5);
  });
}

bool PreparedScene::starts_off_equilibrium(unsigned replica) const {
  return starts_in_law(scene_) && replicas_ >= 2 && replica + 1 == replicas_;
}

System PreparedScene::start(unsigned replica) const {
  const Noise numbers = noise(replica);
  const bool off = starts_off_equilibrium(replica);
  State state =
      configurations_.empty() || off
          ? place(box_, scene_.layout,
                  off && scene_.initial_positions == Placement::random ? Placement::lattice
                                                                       : scene_.initial_positions,
                  scene_.particles, scene_.pair_distance, numbers)
          : configurations_[replica];
  state.species = scene_species(scene_);
  if (scene_.initial_state == InitialState::canonical) {
    // Off equilibrium it is half as hot.
    draw_canonical(fluid_, scene_.layout, scene_.fluid.temperature * (off ? 0.5 : 1), numbers,
                   state);
  } else if (scene_.initial_state == InitialState::microcanonical) {
    double energy = ideal_energy();
    if (!configurations_.empty()) {
      state.internal_energy.assign(state.size(), 1.0);
      System probe(fluid_, box_, state, numbers, scene_.frozen);
      energy = total_energy_ - centre_of_mass_energy(scene_) - probe.potential_energy();
    }
    draw_start(energy, off, numbers, state);
  } else {
    const bool rest = scene_.initial_state == InitialState::rest;
    draw_given_spread(fluid_, scene_.layout, rest ? 0.0 : scene_.initial_velocity_spread,
                      scene_.initial_temperature, numbers, state);
    for (std::size_t i = 0; !rest && i < scene_.initial_velocities.size(); ++i) {
      state.velocity[i] = scene_.initial_velocities[i];
    }
  }
  boost_frame(scene_.frame_velocity, state);
  return System(fluid_, box_, std::move(state), numbers, scene_.frozen);
}

void PreparedScene::draw_start(double energy, bool off, const Noise& numbers, State& state) const {
  if (fluid_.has_constant_heat_capacities()) {
    (off ? draw_off_equilibrium : draw_microcanonical)(fluid_, scene_.layout, energy, numbers,
                                                       state);
    return;
  }
  const double kinetic = 0.5 * kinetic_degrees() * fluid_.boltzmann() * scene_.fluid.temperature;
  draw_alike(fluid_, scene_.layout, energy, off ? 0.5 * kinetic : kinetic, numbers, state);
}

std::optional<Reference> PreparedScene::reference(std::string_view observable) const {
  const auto found = references_.find(observable);
  if (found == references_.end()) return std::nullopt;
  return found->second;
}

}  // namespace driftless
