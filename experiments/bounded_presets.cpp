#include "experiments/bounded_presets.hpp"

namespace driftless {
namespace {

/// The ideal fluid of Mackie et al. in units T_R = m = zeta_0 = 1, so that k = 1/2: phi = k/B, L_0
/// = C phi, density 1.
Scene mackie_scene(const char* name, double B, double C, double range, double temperature) {
  Scene scene;
  scene.name = scene.preset = name;
  auto& fluid = scene.fluid;
  fluid.boltzmann = 0.5;
  fluid.temperature = scene.initial_temperature = temperature;
  fluid.heat_capacity = fluid.boltzmann / B;
  fluid.friction = 1;
  fluid.friction_closure = FrictionClosure::friction;
  fluid.conduction = C * fluid.heat_capacity;
  fluid.heat_form = HeatForm::inverse_temperature;
  fluid.friction_range = fluid.heat_range = range;
  scene.density = 1;
  return scene;
}

/// A wall that exchanges friction and heat as two particles do.
Wall reservoir(const FluidParameters& fluid, double temperature) {
  return {.temperature = temperature,
          .friction = fluid.friction,
          .friction_range = fluid.friction_range,
          .conduction = fluid.conduction,
          .heat_range = fluid.heat_range};
}

Scene box_scene() {
  Scene scene = mackie_scene("mackie-1999-box", 0.01, 17, 1.24, 1.1);
  scene.particles = 30000;
  Wall wall = reservoir(scene.fluid, scene.fluid.temperature);
  wall.repulsion = 1.8;
  wall.repulsion_range = 1.24;
  scene.walls.fill(wall);
  return scene;
}

Scene roll_scene() {
  constexpr double hot = 2.8, cold = 0.8;
  Scene scene = mackie_scene("mackie-1999-roll", 0.1, 0.001, 2, 0.5 * (hot + cold));
  scene.particles = 100000;
  scene.walls[0] = reservoir(scene.fluid, hot);
  scene.walls[1] = reservoir(scene.fluid, cold);
  scene.walls[4] = scene.walls[5] = Wall{};
  scene.gravity = Vector(0, 0, -0.01);
  return scene;
}

Scene slabs_scene() {
  Scene scene;
  scene.name = scene.preset = "soleymani-2020-slabs";
  scene.fluid = {.boltzmann = 1,
                 .mass = 1,
                 .temperature = 1,
                 .heat_capacity = 60,
                 .repulsion = 25,
                 .repulsion_range = 1,
                 .friction = 4.5,
                 .friction_closure = FrictionClosure::noise,
                 .friction_range = 1,
                 .conduction = 300,
                 .heat_form = HeatForm::inverse_temperature,
                 .heat_range = 1,
                 .weight_exponent = 2};
  scene.particles = 2160;
  scene.density = 3;
  scene.sides = Vector(6, 6, 20);
  // A flux of 6 each way from the hot slab, through an area of 6 x 6.
  scene.heat_slabs = HeatSlabs{.drive = SlabDrive::heat_rate,
                               .axis = 2,
                               .hot = {4.5, 5.5},
                               .cold = {14.5, 15.5},
                               .rate = 2 * 36 * 6};
  return scene;
}

}  // namespace

Preset mackie_1999_box() {
  return {"mackie-1999-box",
          "The equilibrium box of Mackie et al., between reservoirs on six faces",
          "Mackie, Bonet Avalos, Navas, Phys. Chem. Chem. Phys. 1, 2039 (1999), Fig. 1-3: 30000 "
          "particles, B = 0.01, C = 17, r* = 1.24, walls at T* = 1.1; the walls' repulsion, 1.8 "
          "over 1.24, and that all faces are walls is chosen here",
          box_scene()};
}

Preset mackie_1999_roll() {
  return {"mackie-1999-roll", "The convection roll of Mackie et al. between a hot and a cold wall",
          "Mackie, Bonet Avalos, Navas, Phys. Chem. Chem. Phys. 1, 2039 (1999), Fig. 4-6: 100000 "
          "particles, B = 0.1, C = 0.001, r* = 2, T* from 2.8 to 0.8, g* = 0.01; hard walls, the "
          "left one hot, floor and ceiling adiabatic, the depth periodic are chosen here",
          roll_scene()};
}

Preset soleymani_2020_slabs() {
  return {"soleymani-2020-slabs",
          "The soft fluid between a hot and a cold slab that a heat rate drives",
          "Soleymani, Ripoll, Gompper, Fedosov, J. Chem. Phys. 152, 064112 (2020), section III.2, "
          "whose numbers are not known to us; chosen here: density 3, a = 25, friction 4.5, heat "
          "capacity 60, conduction 300, a heat flux of 6 each way",
          slabs_scene()};
}

}  // namespace driftless
