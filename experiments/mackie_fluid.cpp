#include "experiments/mackie_fluid.hpp"

namespace driftless {

FluidParameters mackie_parameters(const MackieFluid& fluid) {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.heat_capacity = f.boltzmann / fluid.B;
  f.friction = 1;
  f.friction_closure = FrictionClosure::friction;
  f.conduction = fluid.C * f.heat_capacity;
  f.heat_form = HeatForm::inverse_temperature;
  f.friction_range = f.heat_range = fluid.range;
  return f;
}

Wall mackie_reservoir(const FluidParameters& fluid, double temperature,
                      const WallRepulsion& repulsion) {
  return {.temperature = temperature,
          .repulsion = repulsion.strength,
          .repulsion_range = repulsion.range,
          .friction = fluid.friction,
          .friction_range = fluid.friction_range,
          .conduction = fluid.conduction,
          .heat_range = fluid.heat_range};
}

}  // namespace driftless
