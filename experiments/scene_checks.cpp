#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/driven_integrator.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/scene_part_checks.hpp"

namespace driftless {
namespace {

/// The box's shortest side; a wall's images are a range away.
double shortest_side(const Scene& scene, const Fluid& fluid) {
  const Box box = scene_box(scene);
  Vector lengths = box.lengths;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.is_walled(axis)) lengths[axis] += fluid.range();
  }
  return lengths.minCoeff();
}

std::size_t fewest_that_fit(Scene scene, const Fluid& fluid) {
  const double too_short = 2 * fluid.range() / scene_box(scene).lengths.minCoeff();
  const double estimate = static_cast<double>(scene.particles) * std::pow(too_short, 3);
  scene.particles = static_cast<std::size_t>(std::max(2.0, std::floor(estimate)));
  while (shortest_side(scene, fluid) < 2 * fluid.range()) ++scene.particles;
  return scene.particles;
}

/// A particle must not meet a second image of another one.
void check_box(const Scene& scene, const Fluid& fluid, const Location& location) {
  const double side = shortest_side(scene, fluid);
  if (!(side < 2 * fluid.range())) return;
  const double needed =
      static_cast<double>(scene.particles) * std::pow(2 * fluid.range() / side, 3);
  const std::string allowed =
      needed < 1e7
          ? fmt::format("at least {} particles at density {}", fewest_that_fit(scene, fluid),
                        describe(scene.density))
          : fmt::format("a lower density than {} or a shorter range", describe(scene.density));
  location.member("particles")
      .refuse(fmt::format("is {}, which makes a box of {}, shorter than twice the range {}; "
                          "allowed is {}",
                          scene.particles, describe(side), describe(fluid.range()), allowed));
}

void check_exponents(const FluidParameters& fluid, const Location& location) {
  constexpr double largest = 20;
  for (const auto& [key, value] :
       {std::pair("friction_temperature_exponent", fluid.friction_temperature_exponent),
        std::pair("conduction_temperature_exponent", fluid.conduction_temperature_exponent)}) {
    if (std::abs(value) <= largest) continue;
    location.member(key).refuse(fmt::format("is {}; allowed is a number from -{} to {}",
                                            describe(value), largest, largest));
  }
}

void check_surroundings(const Scene& scene, const Fluid& fluid, const Location& location) {
  if (!(scene.sides.minCoeff() > 0)) {
    location.member("sides").refuse(
        "has a side that is not above 0; allowed are three numbers > 0");
  }
  check_walls(scene, location.member("walls"));
  check_gravity(scene, location.member("gravity"));
  try {
    (void)fluid.within(scene_box(scene));
  } catch (const std::invalid_argument& error) {
    location.member("walls").refuse(std::string("do not fit the scene: ") + error.what());
  }
  if (!scene.heat_slabs) return;
  check_slabs(*scene.heat_slabs, location.member("heat_slabs"));
  try {
    (void)driven(nullptr, scene, Noise(0, 0));
  } catch (const std::invalid_argument& error) {
    location.member("heat_slabs").refuse(std::string("do not fit the scene: ") + error.what());
  }
}

void check_pairs(const Scene& scene, const Fluid& fluid, const Location& location) {
  if (scene.particles % 2 != 0) {
    location.member("particles")
        .refuse(fmt::format("is {}, which leaves one particle without a partner; allowed is an "
                            "even number",
                            scene.particles));
  }
  if (!scene.frozen) {
    location.member("frozen").refuse(
        "is false, but pairs are isolated only while they stand still; allowed is true");
  }
  if (!fluid.has_friction() && !fluid.has_conduction()) {
    location.member("friction")
        .refuse(
            "is 0 and nothing conducts, so that no pair exchanges anything; allowed is "
            "friction > 0, or conduction > 0 with a heat_form");
  }
  double range = fluid.range();
  if (fluid.has_friction()) range = std::min(range, fluid.parameters().friction_range);
  if (fluid.has_conduction()) range = std::min(range, fluid.parameters().heat_range);
  if (scene.pair_distance >= range) {
    location.member("pair_distance")
        .refuse(fmt::format("is {}, beyond the range {} of what acts; allowed is a number > 0 "
                            "and < {}",
                            describe(scene.pair_distance), describe(range), describe(range)));
  }
}

void check_given_velocities(const Scene& scene, const Location& location) {
  const auto& velocities = scene.initial_velocities;
  const Location place = location.member("initial_velocities");
  if (!velocities.empty() && velocities.size() != scene.particles) {
    place.refuse(
        fmt::format("is a list of {} velocities; allowed is one for each of the {} "
                    "particles",
                    velocities.size(), scene.particles));
  }
  if (scene.layout != Layout::pairs) return;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    if (velocities[i][1] == 0 && velocities[i][2] == 0) continue;
    place.element(i).refuse(fmt::format("is [{}, {}, {}], not along its pair; allowed is [x, 0, 0]",
                                        describe(velocities[i][0]), describe(velocities[i][1]),
                                        describe(velocities[i][2])));
  }
}

/// The exact law is one of fluctuations, of an isolated system or of one with a bath.
void check_law(const Scene& scene, const Location& location) {
  const Location place = location.member("initial_state");
  const std::string state(to_string(scene.initial_state));
  if (!(scene.fluid.boltzmann > 0)) {
    place.refuse("is \"" + state +
                 "\", but nothing fluctuates where boltzmann is 0; allowed is \"rest\", or "
                 "\"given\" with initial_velocities or initial_velocity_spread");
  }
  const bool canonical = scene.initial_state == InitialState::canonical;
  if (canonical == scene.fluid.isothermal) return;
  place.refuse("is \"" + state + "\", the law of " +
               (canonical ? "a bath, and isothermal is false; allowed is \"microcanonical\""
                          : "isolated systems, and isothermal is true; allowed is \"canonical\"") +
               ", \"rest\" or \"given\"");
}

void check_bath(const Fluid& fluid, const Location& location) {
  if (!fluid.isothermal() || fluid.has_friction()) return;
  location.member("friction")
      .refuse(
          "is 0, but friction and its noise are the only contact with the bath where isothermal is "
          "true; allowed is a number > 0");
}

void check_equation_of_state(const FluidParameters& fluid, const Location& location) {
  if (fluid.isothermal) return;
  if (!fluid.equation_of_state.empty()) {
    try {
      EquationOfState::table(fluid.equation_of_state);
    } catch (const std::invalid_argument& error) {
      location.member("equation_of_state")
          .refuse(std::string("holds no equation of state: ") + error.what());
    }
    return;
  }
  const double unit = fluid.boltzmann > 0 ? fluid.boltzmann : 1;
  const double limit = fluid.heat_capacity / fluid.temperature;
  if (fluid.heat_capacity_slope == 0 || fluid.heat_capacity_slope < limit) return;
  location.member("heat_capacity_slope")
      .refuse(fmt::format("is {}, which takes the heat capacity to 0 or below above the "
                          "temperature 0; allowed is a number >= 0 and < {}, "
                          "heat_capacity/temperature",
                          describe(fluid.heat_capacity_slope / unit), describe(limit / unit)));
}

void check_thermal_repulsion(const Scene& scene, const Location& location) {
  const FluidParameters& fluid = scene.fluid;
  if (fluid.thermal_repulsion == 0) return;
  const Location place = location.member("thermal_repulsion");
  const std::string value = describe(fluid.thermal_repulsion);
  if (fluid.heat_capacity_slope != 0 || !fluid.equation_of_state.empty()) {
    place.refuse("is " + value +
                 ", which is built for constant heat capacities; allowed is 0 with " +
                 (fluid.equation_of_state.empty() ? "heat_capacity_slope" : "equation_of_state"));
  }
  if (scene.frozen) {
    place.refuse("is " + value +
                 ", but a force on frozen particles works without end; allowed is 0 where frozen "
                 "is true");
  }
}

}  // namespace

void check_scene(const Scene& scene, const Location& location) try {
  check_equation_of_state(scene.fluid, location);
  check_thermal_repulsion(scene, location);
  check_exponents(scene.fluid, location);
  check_species_pairs(scene, location.member("species_pairs"));
  const Fluid fluid(scene.fluid);
  if (scene.frozen && fluid.has_repulsion()) {
    location.member("repulsion")
        .refuse(fmt::format("is {}, but a force on frozen particles works without end; allowed is "
                            "0 where frozen is true",
                            describe(scene.fluid.repulsion)));
  }
  check_bath(fluid, location);
  check_species(scene, location);
  check_surroundings(scene, fluid, location);
  if (scene.layout == Layout::pairs) {
    check_pairs(scene, fluid, location);
  } else {
    check_box(scene, fluid, location);
  }
  if (starts_in_law(scene)) check_law(scene, location);
  check_given_velocities(scene, location);
} catch (const std::invalid_argument& error) {
  location.refuse(error.what());  // a product or quotient of keys, each within its range
}

}  // namespace driftless
