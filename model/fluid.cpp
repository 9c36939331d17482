#include "model/fluid.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "model/state.hpp"

namespace driftless {
namespace {

void require(bool allowed, const char* name, double value, const char* range) {
  if (allowed && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " is " << value << ", allowed is " << range;
  throw std::invalid_argument(message.str());
}

void check_pairs(const FluidParameters& f) {
  const std::size_t species = f.further_species.size() + 1;
  for (const auto& pair : f.pairs) {
    require(pair.a < species && pair.b < species, "species of a pair", std::max(pair.a, pair.b),
            "a number below that of the species");
    require(pair.repulsion.value_or(0) >= 0, "repulsion of a pair", pair.repulsion.value_or(0),
            ">= 0");
    require(pair.friction.value_or(0) >= 0, "friction of a pair", pair.friction.value_or(0),
            ">= 0");
    require(pair.conduction.value_or(0) >= 0, "conduction of a pair", pair.conduction.value_or(0),
            ">= 0");
  }
}

void check_wall(const Wall& wall, double length) {
  require(wall.temperature.value_or(1) > 0, "temperature of a wall", wall.temperature.value_or(1),
          "> 0");
  require(wall.repulsion >= 0, "repulsion of a wall", wall.repulsion, ">= 0");
  require(wall.friction >= 0, "friction of a wall", wall.friction, ">= 0");
  require(wall.conduction >= 0, "conduction of a wall", wall.conduction, ">= 0");
  for (const double range : {wall.repulsion_range, wall.friction_range, wall.heat_range}) {
    require(range > 0 && 2 * range <= length, "range of a wall", range,
            "above 0, at most half of the distance of the walls");
  }
}

/// At the one temperature that there is the two closures are the same; with `noise` nothing is
/// noise-induced.
FluidParameters with_bath(FluidParameters parameters) {
  if (!parameters.isothermal) return parameters;
  parameters.friction_closure = FrictionClosure::noise;
  parameters.heat_capacity = 1;
  parameters.heat_capacity_slope = 0;
  parameters.equation_of_state.clear();
  parameters.friction_temperature_exponent = parameters.conduction_temperature_exponent = 0;
  return parameters;
}

void check_coefficient_laws(const FluidParameters& f) {
  const auto check = [&f](const char* name, double exponent, const CoefficientLaw& law) {
    require(law.is_constant() || exponent == 0, name, exponent, "0 where a law is given");
    if (law.is_constant() || !f.isothermal) return;
    throw std::invalid_argument(
        "the law of a coefficient follows temperatures, allowed is none in an isothermal fluid");
  };
  check("friction_temperature_exponent", f.friction_temperature_exponent, f.friction_law);
  check("conduction_temperature_exponent", f.conduction_temperature_exponent, f.conduction_law);
}

}  // namespace

Fluid::Fluid(const FluidParameters& parameters) : parameters_(with_bath(parameters)) {
  const auto& f = parameters_;
  require(f.boltzmann >= 0, "boltzmann", f.boltzmann, ">= 0");
  require(f.mass > 0, "mass", f.mass, "> 0");
  require(f.temperature > 0, "temperature", f.temperature, "> 0");
  require(f.heat_capacity > 0, "heat_capacity", f.heat_capacity, "> 0");
  require(f.repulsion >= 0, "repulsion", f.repulsion, ">= 0");
  require(f.thermal_repulsion >= 0, "thermal_repulsion", f.thermal_repulsion, ">= 0");
  require(!f.isothermal || f.thermal_repulsion == 0, "thermal_repulsion", f.thermal_repulsion,
          "0 in an isothermal fluid, whose particles have no temperatures");
  require(f.repulsion_range > 0, "repulsion_range", f.repulsion_range, "> 0");
  require(f.friction >= 0, "friction", f.friction, ">= 0");
  require(f.friction_range > 0, "friction_range", f.friction_range, "> 0");
  require(f.conduction >= 0, "conduction", f.conduction, ">= 0");
  require(f.heat_range > 0, "heat_range", f.heat_range, "> 0");
  require(!f.isothermal || !f.has_conduction(), "conduction", f.conduction,
          "0 in an isothermal fluid, whose particles have no heat to exchange");
  require(f.weight_exponent > 0, "weight_exponent", f.weight_exponent, "> 0");
  check_coefficient_laws(f);
  add_partner({f.mass, f.heat_capacity, f.heat_capacity_slope, f.equation_of_state});
  for (const auto& species : f.further_species) {
    require(species.mass > 0, "mass of a species", species.mass, "> 0");
    require(species.heat_capacity > 0, "heat_capacity of a species", species.heat_capacity, "> 0");
    add_partner(species);
  }
  require(f.thermal_repulsion == 0 || has_constant_heat_capacities(), "thermal_repulsion",
          f.thermal_repulsion, "0 where a heat capacity follows the temperature");
  require(partners_.size() <= 256, "number of species", static_cast<double>(partners_.size()),
          "at most 256");
  check_pairs(f);
  for (std::size_t i = 0; i < species(); ++i) {
    for (std::size_t j = 0; j < species(); ++j) {
      laws_.emplace_back(f, coefficients(i, j), partners_[i], partners_[j]);
      note_terms(laws_.back());
    }
  }
}

void Fluid::add_partner(const SpeciesParameters& species) {
  const auto& f = parameters_;
  const auto state = [&] {
    if (f.isothermal) return EquationOfState::constant_heat_capacity(1);
    if (species.equation_of_state.empty()) {
      return EquationOfState::linear_heat_capacity(species.heat_capacity,
                                                   species.heat_capacity_slope, f.temperature);
    }
    require(species.heat_capacity_slope == 0, "heat_capacity_slope", species.heat_capacity_slope,
            "0 where an equation of state is given by points");
    return EquationOfState::table(species.equation_of_state);
  };
  partners_.push_back({species.mass, state()});
}

bool Fluid::has_constant_heat_capacities() const {
  return std::all_of(partners_.begin(), partners_.end(), [](const Partner& partner) {
    return partner.state.has_constant_heat_capacity();
  });
}

PairCoefficients Fluid::coefficients(std::size_t species_i, std::size_t species_j) const {
  const auto& f = parameters_;
  PairCoefficients found{f.repulsion,  f.repulsion_range, f.friction,         f.friction_range,
                         f.conduction, f.heat_range,      f.thermal_repulsion};
  for (const auto& pair : f.pairs) {
    const bool meant = (pair.a == species_i && pair.b == species_j) ||
                       (pair.a == species_j && pair.b == species_i);
    if (!meant) continue;
    found.repulsion = pair.repulsion.value_or(found.repulsion);
    found.friction = pair.friction.value_or(found.friction);
    found.conduction = pair.conduction.value_or(found.conduction);
  }
  return found;
}

void Fluid::note_terms(const PairLaw& law) {
  has_repulsion_ = has_repulsion_ || law.has_repulsion();
  has_friction_ = has_friction_ || law.has_friction();
  has_conduction_ = has_conduction_ || law.has_conduction();
  friction_noise_follows_energies_ =
      friction_noise_follows_energies_ || law.friction_noise_follows_energies();
  heat_noise_follows_energies_ = heat_noise_follows_energies_ || law.heat_noise_follows_energies();
}

double Fluid::range() const {
  double range = 0;
  for (const auto& law : laws_) range = std::max(range, law.range());
  return range;
}

Fluid Fluid::within(const Box& box) const {
  Fluid fluid = *this;
  fluid.boundary_laws_.clear();
  if (!box.is_bounded()) return fluid;
  fluid.boundary_laws_.resize((box.walls.size() + 1) * species());
  for (std::size_t face = 0; face < box.walls.size(); ++face) fluid.add_wall(box, face);
  fluid.add_field(box);
  return fluid;
}

void Fluid::add_wall(const Box& box, std::size_t face) {
  const auto& wall = box.walls[face];
  if (wall.has_value() != box.walls[face ^ 1].has_value()) {
    throw std::invalid_argument(
        "a wall stands at one side of the box alone, allowed are both or none");
  }
  if (!wall) return;
  check_wall(*wall, box.lengths[static_cast<Eigen::Index>(face / 2)]);
  PairCoefficients coefficients{.repulsion = wall->repulsion,
                                .repulsion_range = wall->repulsion_range};
  if (wall->temperature) {
    coefficients.friction = wall->friction;
    coefficients.friction_range = wall->friction_range;
    coefficients.conduction = isothermal() ? 0 : wall->conduction;
    coefficients.heat_range = wall->heat_range;
  }
  const double temperature = wall->temperature.value_or(parameters_.temperature);
  const Partner side{std::numeric_limits<double>::infinity(),
                     EquationOfState::reservoir(temperature)};
  for (std::size_t n = 0; n < species(); ++n) {
    const PairLaw law(parameters_, coefficients, partners_[n], side);
    note_terms(law);
    boundary_laws_[face * species() + n] = law;
  }
}

void Fluid::add_field(const Box& box) {
  if (box.gravity.isZero(0)) return;
  Eigen::Index axis = 0;
  box.gravity.cwiseAbs().maxCoeff(&axis);
  const bool along = box.gravity.cwiseAbs().sum() == std::abs(box.gravity[axis]);
  if (!along || !std::isfinite(box.gravity[axis]) || !box.is_walled(static_cast<int>(axis))) {
    throw std::invalid_argument("gravity must be finite and along one axis that has walls");
  }
  for (std::size_t n = 0; n < species(); ++n) {
    const auto law =
        PairLaw::uniform_field(parameters_, partners_[n].mass * box.gravity[axis], partners_[n]);
    note_terms(law);
    boundary_laws_[box.walls.size() * species() + n] = law;
  }
}

}  // namespace driftless
