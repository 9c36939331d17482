// write_trajectory FOLDER: trajectories of short runs, and beside each what the system was, in
// JSON with all digits.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/files.hpp"
#include "experiments/judge/small_system.hpp"
#include "experiments/trajectory.hpp"

namespace {

using namespace driftless;
using nlohmann::json;

constexpr double step_size = 0.01;

json to_json(const Vector& vector) { return {vector[0], vector[1], vector[2]}; }

/// Writes down what a trajectory should hold, in the order of ids, which is the reverse of storage.
class Witness : public Observer {
 public:
  void sample(System& system, std::uint64_t step) override {
    const State& state = system.state();
    json frame = {{"step", step},
                  {"time", static_cast<double>(step) * step_size},
                  {"lengths", to_json(system.box().lengths)},
                  {"periodic", {true, true, !system.box().is_walled(2)}}};
    for (std::size_t i = state.size(); i-- > 0;) {
      frame["id"].push_back(state.id[i]);
      frame["position"].push_back(to_json(state.position[i]));
      frame["velocity"].push_back(to_json(state.velocity[i]));
      frame["mass"].push_back(system.mass(i));
      frame["symbol"].push_back(state.species.empty() ? "X" : state.species[i] == 0 ? "H" : "He");
      frame["internal_energy"].push_back(state.internal_energy[i]);
      frame["temperature"].push_back(
          system.equation_of_state(i).temperature(state.internal_energy[i]));
    }
    frames_.push_back(frame);
  }
  json save() override { return frames_; }
  void load(const json& saved) override { frames_ = saved; }

 private:
  json frames_ = json::array();
};

void write(const std::filesystem::path& folder, const std::string& name, bool isothermal,
           bool two_species) {
  judge::Terms terms;
  terms.potential = true;
  terms.isothermal = isothermal;
  auto fluid = judge::small_fluid(terms, 0.5);
  State start = judge::small_state(fluid);
  Box box{Vector(3, 3.25, 4)};
  if (two_species) {
    fluid.further_species = {{.mass = 3, .heat_capacity = 30}};
    for (std::size_t i = 0; i < start.size(); ++i) start.species.push_back(i % 2);
    box.walls[4] = box.walls[5] = Wall{.repulsion = 20};
  }
  // Ids that are no places.
  for (auto& id : start.id) id = 3 * (26 - id) + 5;
  System system(Fluid(fluid), box, start, Noise(7, 0));
  const auto integrator = find_method("shardlow-s1")->make({});
  Trajectory trajectory(folder / (name + ".xyz"), step_size);
  Witness witness;
  LongRunPlan plan;
  plan.time_step = step_size;
  plan.last = 20;
  long_run(system, *integrator, plan,
           {{"trajectory", &trajectory, 4, 0}, {"witness", &witness, 4, 0}}, {}, 1);
  write_atomically(folder / (name + ".json"), witness.save().dump());
}

}  // namespace

int main(int, char** argv) {
  write(argv[1], "energies", false, false);
  write(argv[1], "isothermal", true, false);
  write(argv[1], "walls_and_species", false, true);
}
