#include "experiments/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/scene_keys.hpp"

namespace driftless {
namespace {

using std::numbers::pi;

/// [w], the volume integral of (1 - r/range)^s: 8 pi range^3/((s + 1)(s + 2)(s + 3)).
double weight_volume(double range, double exponent) {
  return 8 * pi * std::pow(range, 3) / ((exponent + 1) * (exponent + 2) * (exponent + 3));
}

/// L_0, whichever form the conduction is quoted in; 0 if nothing conducts.
double inverse_temperature_conduction(const FluidParameters& fluid) {
  if (!fluid.has_conduction()) return 0;
  const double square = fluid.temperature * fluid.temperature;
  return fluid.heat_form == HeatForm::temperature ? fluid.conduction * square : fluid.conduction;
}

/// Rate at which conduction through a summed weight relaxes one particle's internal energy.
double conduction_rate(const FluidParameters& fluid, double weight) {
  return weight * inverse_temperature_conduction(fluid) /
         (heat_capacity(Fluid(fluid)) * fluid.temperature * fluid.temperature);
}

/// Friction takes kinetic energy at this rate from a pair, or from the particles of a fluid.
double kinetic_relaxation_rate(const Scene& scene) {
  const auto& f = scene.fluid;
  if (scene.layout == Layout::pairs) {
    return 4 * f.friction * Fluid(f).friction_weight(scene.pair_distance) / f.mass;
  }
  return 2 * scene.density * f.friction * weight_volume(f.friction_range, f.weight_exponent) /
         (3 * f.mass);
}

/// The slower of the two motions of a pair's energies, of those that there are: the sum follows the
/// kinetic energy, which friction relaxes at 4 zeta w/m; conduction relaxes the difference.
double pair_relaxation_rate(const Scene& scene) {
  const Fluid fluid(scene.fluid);
  const double distance = scene.pair_distance;
  const double sum = kinetic_relaxation_rate(scene);
  const double difference = 2 * conduction_rate(scene.fluid, fluid.heat_weight(distance));
  return sum > 0 && difference > 0 ? std::min(sum, difference) : std::max(sum, difference);
}

double fluid_relaxation_rate(const Scene& scene) {
  const auto& f = scene.fluid;
  double rate = scene.density * conduction_rate(f, weight_volume(f.heat_range, f.weight_exponent));
  if (f.boltzmann > 0) {
    const double shape = heat_capacity(Fluid(f)) / f.boltzmann + 1;
    rate += scene.density * f.friction * weight_volume(f.friction_range, f.weight_exponent) /
            (2 * f.mass * shape);
  }
  return rate;
}

}  // namespace

Box scene_box(const Scene& scene) {
  Box box = make_box(Fluid(scene.fluid), scene.layout, scene.particles, scene.density,
                     scene.pair_distance);
  if (scene.layout == Layout::fluid) {
    // A cube keeps its side to the last bit.
    const double unit = scene.sides == Vector::Ones() ? 1 : std::cbrt(scene.sides.prod());
    box.lengths = box.lengths.cwiseProduct(scene.sides / unit);
  }
  box.walls = scene.walls;
  box.gravity = scene.gravity;
  return box;
}

std::vector<std::uint8_t> scene_species(const Scene& scene) {
  std::vector<std::uint8_t> species;
  if (scene.further_shares.empty()) return species;
  for (std::size_t i = 0; i < scene.particles; ++i) {
    // Multiples of the golden ratio are spread evenly over (0, 1).
    double place = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
    std::uint8_t found = 0;
    for (std::size_t n = 0; n < scene.further_shares.size() && found == 0; ++n) {
      if (place < scene.further_shares[n]) found = static_cast<std::uint8_t>(n + 1);
      place -= scene.further_shares[n];
    }
    species.push_back(found);
  }
  return species;
}

double kinetic_relaxation_time(const Scene& scene) {
  const double rate = kinetic_relaxation_rate(scene);
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

double relaxation_time(const Scene& scene) {
  if (scene.fluid.isothermal) return std::numeric_limits<double>::infinity();
  const double rate =
      scene.layout == Layout::pairs ? pair_relaxation_rate(scene) : fluid_relaxation_rate(scene);
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

}  // namespace driftless
