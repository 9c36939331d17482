#include <algorithm>

#include "experiments/avalos_mackie_fluid.hpp"
#include "experiments/mackie_fluid.hpp"
#include "experiments/scene.hpp"

// The presets: scenes of the literature, by name.
namespace driftless {
namespace {

Scene mackie_scene(const MackieFluid& fluid, double temperature) {
  Scene scene;
  scene.fluid = mackie_parameters(fluid);
  scene.fluid.temperature = scene.initial_temperature = temperature;
  scene.density = 1;
  return scene;
}

Scene mackie_1999() {
  Scene scene = mackie_scene(mackie_liquid, mackie_temperature);
  scene.particles = 1000;
  return scene;
}

Scene soft_fluid() {
  Scene scene;
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
  Scene scene = soft_fluid();
  scene.fluid.heat_capacity = 1;
  scene.fluid.conduction = 0;
  scene.fluid.heat_form = HeatForm::none;
  scene.fluid.isothermal = true;
  scene.initial_state = InitialState::canonical;
  return scene;
}

/// At X = C r*^5 = 50, where what particles carry and what they conduct are of one size.
Scene avalos_mackie_1999() {
  Scene scene;
  scene.fluid = am99::fluid(am99::few, 50 / std::pow(am99::few, 5));
  scene.particles = 1000;
  scene.density = 1;
  return scene;
}

/// An ideal fluid whose species differ in mass, heat capacity and the coefficients of every pair.
Scene mixture_scene() {
  Scene scene = soft_fluid();
  auto& f = scene.fluid;
  f.repulsion = 0;
  f.conduction = 30;
  f.further_species = {{.mass = 4, .heat_capacity = 100}, {.mass = 0.5, .heat_capacity = 30}};
  f.pairs = {{.a = 0, .b = 1, .friction = 6, .conduction = 20},
             {.a = 0, .b = 2, .friction = 3, .conduction = 40},
             {.a = 1, .b = 1, .friction = 9, .conduction = 60},
             {.a = 1, .b = 2, .friction = 4, .conduction = 10},
             {.a = 2, .b = 2, .friction = 2, .conduction = 15}};
  scene.further_shares = {0.3, 0.3};
  return scene;
}

Scene box_scene() {
  Scene scene = mackie_scene(mackie_liquid, mackie_temperature);
  scene.particles = 30000;
  scene.walls.fill(mackie_reservoir(scene.fluid, mackie_temperature, mackie_repulsion));
  return scene;
}

Scene roll_scene() {
  // Where heat in is heat out: from the walls' mean the fluid would take thousands of t* to it.
  constexpr double stationary = 1.42;
  Scene scene = mackie_scene(mackie_gas, stationary);
  scene.particles = 100000;
  scene.walls[0] = mackie_reservoir(scene.fluid, mackie_hot);
  scene.walls[1] = mackie_reservoir(scene.fluid, mackie_cold);
  scene.walls[4] = scene.walls[5] = Wall{};
  scene.gravity = Vector(0, 0, -mackie_gravity);
  return scene;
}

Scene slabs_scene() {
  Scene scene = soft_fluid();
  scene.fluid.conduction = 300;
  scene.particles = 2160;
  scene.sides = Vector(6, 6, 20);
  // A flux of 6 each way from the hot slab, through an area of 6 x 6.
  scene.heat_slabs = HeatSlabs{.drive = SlabDrive::heat_rate,
                               .axis = 2,
                               .hot = {4.5, 5.5},
                               .cold = {14.5, 15.5},
                               .rate = 2 * 36 * 6};
  return scene;
}

/// The scenes know nothing of their names yet.
std::vector<Preset> without_names() {
  return {
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
      {"avalos-mackie-1999", "The ideal fluid whose transport Bonet Avalos and Mackie measured",
       "Bonet Avalos, Mackie, J. Chem. Phys. 111, 5267 (1999), Fig. 1: n = 8, X = 50, density* = "
       "T* = 1; B = 0.01 is chosen here",
       avalos_mackie_1999()},
      {"marsh-coveney-1998-mixture", "An ideal mixture of three species, each pair its own laws",
       "Marsh, Coveney, J. Phys. A 31, 6561 (1998), section III, which simulates none; the numbers "
       "are chosen here",
       mixture_scene()},
      {"mackie-1999-box", "The equilibrium box of Mackie et al., between reservoirs on six faces",
       "Mackie, Bonet Avalos, Navas, Phys. Chem. Chem. Phys. 1, 2039 (1999), Fig. 1-3: 30000 "
       "particles, B = 0.01, C = 17, r* = 1.24, walls at T* = 1.1; the walls' repulsion, 1.8 "
       "over 1.24, and that all faces are walls is chosen here",
       box_scene()},
      {"mackie-1999-roll", "The convection roll of Mackie et al. between a hot and a cold wall",
       "Mackie, Bonet Avalos, Navas, Phys. Chem. Chem. Phys. 1, 2039 (1999), Fig. 4-6: 100000 "
       "particles, B = 0.1, C = 0.001, r* = 2, T* from 2.8 to 0.8, g* = 0.01; hard walls, the "
       "left one hot, floor and ceiling adiabatic, the depth periodic are chosen here",
       roll_scene()},
      {"soleymani-2020-slabs",
       "The soft fluid between a hot and a cold slab that a heat rate drives",
       "Soleymani, Ripoll, Gompper, Fedosov, J. Chem. Phys. 152, 064112 (2020), section III.2, "
       "whose numbers are not known to us; chosen here: density 3, a = 25, friction 4.5, heat "
       "capacity 60, conduction 300, a heat flux of 6 each way",
       slabs_scene()},
  };
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = [] {
    std::vector<Preset> named = without_names();
    for (auto& preset : named) preset.scene.name = preset.scene.preset = preset.name;
    return named;
  }();
  return all;
}

const Preset* find_preset(std::string_view name) {
  const auto& all = presets();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Preset& p) { return p.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace driftless
