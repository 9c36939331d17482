#include "experiments/monitor.hpp"

#include "experiments/checkpoint.hpp"

namespace driftless {
namespace {

using nlohmann::json;

double internal_temperature(const System& system) {
  const auto& energies = system.state().internal_energy;
  double inverse = 0;
  for (std::size_t i = 0; i < system.size(); ++i) {
    inverse += 1 / system.equation_of_state(i).temperature(energies[i]);
  }
  return static_cast<double>(system.size()) / inverse;
}

double total_mass(const System& system) {
  double sum = 0;
  for (std::size_t i = 0; i < system.size(); ++i) sum += system.mass(i);
  return sum;
}

/// The walls of a box by their places among the surroundings: "lower_x_wall", ...
std::vector<std::pair<std::size_t, std::string>> walls_of(const Box& box) {
  std::vector<std::pair<std::size_t, std::string>> walls;
  for (std::size_t place = 0; place < box.walls.size(); ++place) {
    if (!box.walls[place]) continue;
    const std::string side = place % 2 == 0 ? "lower_" : "upper_";
    walls.emplace_back(place, side + "xyz"[place / 2] + "_wall");
  }
  return walls;
}

void add_received(const System& system, std::vector<double>& values) {
  const auto& surroundings = system.state().surroundings;
  double energy = 0;
  for (const auto& received : surroundings) energy += received.energy;
  values.push_back(energy);
  for (const auto& wall : walls_of(system.box())) {
    const auto& received = surroundings[wall.first];
    values.push_back(received.energy);
    values.push_back(received.momentum[static_cast<Eigen::Index>(wall.first / 2)]);
  }
}

}  // namespace

Monitor::Monitor(const System& system, double time_step, double kinetic_degrees)
    : time_step_(time_step), kinetic_degrees_(kinetic_degrees) {
  const auto add = [&](const std::string& name) { columns_.push_back({name, {}}); };
  const bool isothermal = system.fluid().isothermal();
  add("time");
  add("kinetic_energy");
  if (!isothermal) add("internal_energy");
  add("potential_energy");
  add("total_energy");
  if (system.fluid().boltzmann() > 0) add("kinetic_temperature");
  if (!isothermal) add("internal_temperature");
  for (const auto* name : {"momentum_x", "momentum_y", "momentum_z"}) add(name);
  add("surroundings_energy");
  for (const auto& wall : walls_of(system.box())) {
    add(wall.second + "_energy");
    add(wall.second + "_momentum");
  }
}

std::vector<double> Monitor::row(System& system, std::uint64_t step) const {
  const Fluid& fluid = system.fluid();
  const Vector momentum = system.momentum();
  const double kinetic = system.kinetic_energy(), potential = system.potential_energy();
  const double internal = system.internal_energy();
  std::vector<double> values = {static_cast<double>(step) * time_step_, kinetic};
  if (!fluid.isothermal()) values.push_back(internal);
  values.push_back(potential);
  values.push_back(kinetic + internal + potential);
  if (fluid.boltzmann() > 0) {
    const double about_centre = kinetic - 0.5 * momentum.squaredNorm() / total_mass(system);
    values.push_back(2 * about_centre / (kinetic_degrees_ * fluid.boltzmann()));
  }
  if (!fluid.isothermal()) values.push_back(internal_temperature(system));
  for (int axis = 0; axis < 3; ++axis) values.push_back(momentum[axis]);
  add_received(system, values);
  return values;
}

void Monitor::sample(System& system, std::uint64_t step) {
  if (seen_++ % stride_ != 0) return;
  const auto values = row(system, step);
  for (std::size_t i = 0; i < values.size(); ++i) columns_[i].values.push_back(values[i]);
  if (rows() <= most_rows) return;
  for (auto& column : columns_) {
    for (std::size_t i = 0; 2 * i < column.values.size(); ++i) {
      column.values[i] = column.values[2 * i];
    }
    column.values.resize((column.values.size() + 1) / 2);
  }
  stride_ *= 2;
}

json Monitor::to_json() const {
  json columns = json::object();
  for (const auto& column : columns_) columns[column.name] = column.values;
  return {{"columns", columns}};
}

json Monitor::save() {
  json columns = json::object();
  for (const auto& column : columns_) columns[column.name] = to_bytes(column.values);
  return {{"seen", seen_}, {"stride", stride_}, {"columns", columns}};
}

void Monitor::load(const json& saved) {
  seen_ = saved.at("seen").get<std::uint64_t>();
  stride_ = saved.at("stride").get<std::uint64_t>();
  for (auto& column : columns_) {
    column.values = from_bytes<double>(saved.at("columns").at(column.name));
  }
}

}  // namespace driftless
