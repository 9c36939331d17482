#include "experiments/reproduce/mackie_box.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiments/checkpoint.hpp"
#include "model/initial.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

/// Random places in the box, moved away from its walls.
State place_inside(const Box& box, std::size_t particles, double inset, const Noise& noise) {
  Box inner{box.lengths};
  Vector corner = Vector::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (!box.is_walled(axis)) continue;
    inner.lengths[axis] -= 2 * inset;
    corner[axis] = inset;
  }
  State state = place(inner, Layout::fluid, Placement::random, particles, 0, noise);
  for (auto& position : state.position) position += corner;
  return state;
}

bool is_bulk(const Box& box, const Vector& position, double margin) {
  for (int axis = 0; axis < 3; ++axis) {
    const double x = position[axis];
    if (box.is_walled(axis) && (x < margin || x > box.lengths[axis] - margin)) return false;
  }
  return true;
}

/// Momentum along the outward normal, of all walls.
double pushed(const Surroundings& surroundings) {
  double sum = 0;
  for (Eigen::Index face = 0; face < 6; ++face) {
    const double along = surroundings[static_cast<std::size_t>(face)].momentum[face / 2];
    sum += face % 2 == 1 ? along : -along;
  }
  return sum;
}

}  // namespace

std::optional<std::string> liquid_unsuited(const MethodChoice& method) {
  return first_refusal(method, {mackie_parameters(mackie_liquid)});
}

WallLayer wall_layer(const WallRepulsion& repulsion, double boltzmann, double temperature) {
  const double thermal = boltzmann * temperature;
  const double height = 0.5 * repulsion.strength * repulsion.range / thermal;  // psi(0)/kT
  if (height == 0) return {0, 0};
  // With y = 1 - x/r_w both are integrals of exp(-height y^2) over (0, 1).
  const double root = std::sqrt(height);
  const double passed = 0.5 * std::sqrt(std::acos(-1.0)) * std::erf(root) / root;
  return {repulsion.range * (1 - passed),
          repulsion.range * thermal * 0.5 * (passed - std::exp(-height))};
}

MackieBulk mackie_bulk(std::size_t particles, const WallRepulsion& repulsion, int walled_axes) {
  const double boltzmann = mackie_parameters(mackie_liquid).boltzmann;
  const double nominal = std::cbrt(static_cast<double>(particles));
  const double side = nominal - 2 * wall_layer(repulsion, boltzmann, mackie_temperature).excluded;
  return {side, std::pow(nominal / side, walled_axes)};
}

double mackie_conductivity(double density) {
  const double rate = mackie_parameters(mackie_liquid).conduction * density * density;
  return 2 * std::numbers::pi * rate * std::pow(mackie_liquid.range, 5) /
         (315 * mackie_temperature * mackie_temperature);
}

Box mackie_cube(std::size_t particles, const Wall& wall, int walled_axes) {
  Box box{Vector::Constant(std::cbrt(static_cast<double>(particles)))};
  for (int axis = 3 - walled_axes; axis < 3; ++axis) {
    const auto face = static_cast<std::size_t>(2 * axis);
    box.walls[face] = box.walls[face + 1] = wall;
  }
  return box;
}

State mackie_in_law(const FluidParameters& fluid, const Box& box, std::size_t particles,
                    double temperature, double inset, const Noise& noise) {
  State state = place_inside(box, particles, inset, noise);
  const auto law = microcanonical_law(Fluid(fluid), Layout::fluid, particles);
  draw_microcanonical(Fluid(fluid), Layout::fluid, law.energy_at(temperature), noise, state);
  return state;
}

State mackie_at_rest(const FluidParameters& fluid, const Box& box, std::size_t particles,
                     double temperature, double inset, const Noise& noise) {
  State state = place_inside(box, particles, inset, noise);
  for (auto& u : state.internal_energy) u = Fluid(fluid).internal_energy(temperature);
  return state;
}

const std::vector<std::string>& BoxSeries::names() {
  static const std::vector<std::string> all = {
      "time",   "kinetic", "internal", "potential", "inverse", "pushed", "bulk",
      "heat_0", "heat_1",  "heat_2",   "heat_3",    "heat_4",  "heat_5"};
  return all;
}

void BoxSeries::sample(System& system, std::uint64_t step) {
  const State& state = system.state();
  double inverse = 0, bulk = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    inverse += 1 / system.fluid().temperature(state.internal_energy[i]);
    if (is_bulk(system.box(), state.position[i], margin_)) ++bulk;
  }
  inverse /= static_cast<double>(state.size());
  for (const double value :
       {static_cast<double>(step) * time_step_, system.kinetic_energy(), system.internal_energy(),
        system.potential_energy(), inverse, pushed(state.surroundings), bulk}) {
    values_.push_back(value);
  }
  for (std::size_t face = 0; face < 6; ++face) {
    values_.push_back(state.surroundings[face].energy);
  }
}

json BoxSeries::save() { return {{"values", to_bytes(values_)}}; }

void BoxSeries::load(const json& saved) { values_ = from_bytes<double>(saved.at("values")); }

json BoxSeries::to_json() const {
  json columns = json::object();
  for (const auto& name : names()) columns[name] = json::array();
  for (std::size_t n = 0; n < values_.size(); ++n) {
    columns[names()[n % names().size()]].push_back(values_[n]);
  }
  return columns;
}

void run_box(System& system, const MethodChoice& method, double time_step, double duration,
             const std::vector<Observation>& observations, const Workplace& workplace,
             const json& identity) {
  const auto integrator = find_method(method.name)->make(method.options);
  StepProgress progress(time_step, !workplace.tells_steps);
  LongRunPlan plan;
  plan.identity = identity;
  plan.progress = &progress;
  plan.time_step = time_step;
  plan.last = static_cast<std::uint64_t>(std::llround(duration / time_step));
  long_run(system, *integrator, plan, observations, workplace.checkpoint, workplace.threads);
}

Eigen::VectorXd column_from(const json& series, const std::string& name, double time) {
  const auto times = series.at("time").get<std::vector<double>>();
  const auto values = series.at(name).get<std::vector<double>>();
  const double slack = 1e-9 * (1 + std::abs(time));
  const auto first = std::lower_bound(times.begin(), times.end(), time - slack) - times.begin();
  return Eigen::Map<const Eigen::VectorXd>(values.data() + first,
                                           static_cast<Eigen::Index>(values.size()) - first);
}

Row mackie_row(std::string quantity, std::string setting, std::string unit, const Interval& ours) {
  Row row;
  row.quantity = std::move(quantity);
  row.setting = std::move(setting);
  row.unit = std::move(unit);
  row.ours = ours;
  return row;
}

}  // namespace driftless::reproduce
