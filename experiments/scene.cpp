#include "experiments/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/bounded_presets.hpp"
#include "experiments/scene_keys.hpp"

namespace driftless {
namespace {

using std::numbers::pi;

/// In the paper's units T_R = m = zeta_0 = 1, so that k = 1/2; B = 0.01 and C = 17 make
/// phi = k/B = 50 and L_0 = C phi = 850.
Scene mackie_1999() {
  Scene scene;
  scene.name = scene.preset = "mackie-1999";
  scene.fluid = {.boltzmann = 0.5,
                 .mass = 1,
                 .temperature = 1.1,
                 .heat_capacity = 50,
                 .repulsion = 0,
                 .repulsion_range = 1,
                 .friction = 1,
                 .friction_closure = FrictionClosure::friction,
                 .friction_range = 1.24,
                 .conduction = 850,
                 .heat_form = HeatForm::inverse_temperature,
                 .heat_range = 1.24,
                 .weight_exponent = 2};
  scene.initial_temperature = scene.fluid.temperature;
  scene.particles = 1000;
  scene.density = 1;
  return scene;
}

Scene soft_fluid() {
  Scene scene;
  scene.name = scene.preset = "soft-fluid";
  scene.fluid = {.boltzmann = 1,
                 .mass = 1,
                 .temperature = 1,
                 .heat_capacity = 60,
                 .repulsion = 25,
                 .repulsion_range = 1,
                 .friction = 4.5,
                 .friction_closure = FrictionClosure::noise,
                 .friction_range = 1,
                 .conduction = 1,
                 .heat_form = HeatForm::inverse_temperature,
                 .heat_range = 1,
                 .weight_exponent = 2};
  scene.particles = 648;
  scene.density = 3;
  return scene;
}

/// At this distance the weights are 0.49. Friction relaxes the sum of a pair's internal energies at
/// the rate 4 zeta w/m, conduction their difference at 2 L w/(phi T^2): L_0 = 2 phi zeta_0 T^2/m
/// makes the two alike.
Scene two_body() {
  Scene scene;
  scene.name = scene.preset = "two-body";
  scene.fluid = {.boltzmann = 1,
                 .mass = 1,
                 .temperature = 1,
                 .heat_capacity = 50,
                 .repulsion = 0,
                 .repulsion_range = 1,
                 .friction = 1,
                 .friction_closure = FrictionClosure::noise,
                 .friction_range = 1,
                 .conduction = 100,
                 .heat_form = HeatForm::inverse_temperature,
                 .heat_range = 1,
                 .weight_exponent = 2};
  scene.layout = Layout::pairs;
  scene.particles = 2000;
  scene.frozen = true;
  scene.pair_distance = 0.3;
  scene.initial_positions = Placement::lattice;
  return scene;
}

Scene groot_warren_1997() {
  Scene scene;
  scene.name = scene.preset = "groot-warren-1997";
  scene.fluid = {.boltzmann = 1,
                 .mass = 1,
                 .temperature = 1,
                 .heat_capacity = 1,
                 .repulsion = 25,
                 .repulsion_range = 1,
                 .friction = 4.5,
                 .friction_closure = FrictionClosure::noise,
                 .friction_range = 1,
                 .conduction = 0,
                 .heat_form = HeatForm::none,
                 .heat_range = 1,
                 .weight_exponent = 2,
                 .isothermal = true};
  scene.particles = 648;
  scene.density = 3;
  scene.initial_state = InitialState::canonical;
  return scene;
}

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

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"mackie-1999", "The ideal fluid with friction and conduction of Mackie et al.",
       "Mackie, Bonet Avalos, Navas, Phys. Chem. Chem. Phys. 1, 2039 (1999), section 3: B = 0.01, "
       "C = 17, r* = 1.24, density* = 1, T* = 1.1, in units T_R = m = zeta_0 = 1",
       mackie_1999()},
      {"soft-fluid", "The soft fluid of most DPD work, with internal energies",
       "Groot, Warren, J. Chem. Phys. 107, 4423 (1997): a = 25, density 3, friction 4.5; heat "
       "capacity 60 k as in common DPDE examples",
       soft_fluid()},
      {"two-body", "Many isolated frozen pairs, whose exact law is known at any heat capacity",
       "this program: one pair at a fixed distance, friction and conduction alike in speed",
       two_body()},
      {"groot-warren-1997", "The soft fluid with a bath, without internal energies",
       "Groot, Warren, J. Chem. Phys. 107, 4423 (1997): a = 25, density 3, sigma = 3 (friction "
       "4.5), k T = 1, isothermal",
       groot_warren_1997()},
      mackie_1999_box(),
      mackie_1999_roll(),
      soleymani_2020_slabs(),
  };
  return all;
}

const Preset* find_preset(std::string_view name) {
  const auto& all = presets();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Preset& p) { return p.name == name; });
  return found == all.end() ? nullptr : &*found;
}

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
