// final_state METHOD [SEED]: the instruction set of the library, then position, velocity and
// internal energy of each of 500 particles after 20 steps of the method, a line each.

#include <cstdio>
#include <cstdlib>

#include "integrators/integrator.hpp"
#include "model/initial.hpp"
#include "model/instruction_set.hpp"

namespace driftless {
namespace {

Fluid all_terms() {
  FluidParameters f;
  f.heat_capacity = 60;
  f.repulsion = 25;
  f.friction = 4.5;
  f.friction_closure = FrictionClosure::friction;
  f.conduction = 1;
  f.heat_form = HeatForm::temperature;
  return Fluid(f);
}

System system(const Fluid& fluid, std::uint64_t seed) {
  constexpr std::size_t particles = 500;
  const Noise noise(seed, 0);
  const Box box = make_box(fluid, Layout::fluid, particles, 3, 0);
  State state = place(box, Layout::fluid, Placement::lattice, particles, 0, noise);
  const auto law = microcanonical_law(fluid, Layout::fluid, particles);
  draw_microcanonical(fluid, Layout::fluid, law.energy_at(1), noise, state);
  return System(fluid, box, std::move(state), noise);
}

void print_final_state(const char* method, std::uint64_t seed) {
  const Fluid fluid = all_terms();
  System stepped = system(fluid, seed);
  const auto integrator = find_method(method)->make({});
  for (std::uint64_t step = 1; step <= 20; ++step) {
    stepped.set_step(step);
    integrator->step(stepped, 0.01);
  }
  std::printf("%s\n", std::string(instruction_set()).c_str());
  const State& end = stepped.state();
  for (std::size_t i = 0; i < end.size(); ++i) {
    const Vector &r = end.position[i], &v = end.velocity[i];
    std::printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", r[0], r[1], r[2], v[0], v[1], v[2],
                end.internal_energy[i]);
  }
}

}  // namespace
}  // namespace driftless

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  driftless::print_final_state(argv[1], argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  return 0;
}
