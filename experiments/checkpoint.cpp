#include "experiments/checkpoint.hpp"

#include <algorithm>
#include <fstream>

#include "experiments/files.hpp"
#include "experiments/location.hpp"

namespace driftless {
namespace {

using nlohmann::json;

json state_to_json(const State& state) {
  const auto& received = state.surroundings;
  return {{"position", to_bytes(state.position)},
          {"velocity", to_bytes(state.velocity)},
          {"internal_energy", to_bytes(state.internal_energy)},
          {"id", to_bytes(state.id)},
          {"species", to_bytes(state.species)},
          {"surroundings", to_bytes(std::vector<Received>(received.begin(), received.end()))}};
}

State state_from_json(const json& object) {
  State state;
  state.position = from_bytes<Vector>(object.at("position"));
  state.velocity = from_bytes<Vector>(object.at("velocity"));
  state.internal_energy = from_bytes<double>(object.at("internal_energy"));
  state.id = from_bytes<std::uint32_t>(object.at("id"));
  state.species = from_bytes<std::uint8_t>(object.at("species"));
  const auto received = from_bytes<Received>(object.at("surroundings"));
  if (received.size() != surrounding_places) throw std::invalid_argument("bytes are missing");
  std::copy(received.begin(), received.end(), state.surroundings.begin());
  return state;
}

json counters_to_json(const Counters& counters) {
  return {{"pair_evaluations", counters.pair_evaluations},
          {"random_numbers", counters.random_numbers},
          {"solver_iterations", counters.solver_iterations}};
}

Counters counters_from_json(const json& object) {
  return {object.at("pair_evaluations").get<std::uint64_t>(),
          object.at("random_numbers").get<std::uint64_t>(),
          object.at("solver_iterations").get<std::uint64_t>()};
}

/// Whatever is read as CBOR and is no checkpoint has no format.
json parse(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  json document = json::from_cbor(file, true, false);
  return document.is_object() ? document : json::object();
}

std::string shown(const json& document, const std::string& pointer) {
  const json::json_pointer place(pointer);
  return document.contains(place) ? describe(document.at(place)) : "absent";
}

/// "scene/friction" for "/scene/friction".
std::string first_difference(const json& there, const json& here) {
  const json patch = json::diff(there, here);
  const auto pointer = patch.at(0).at("path").get<std::string>();
  return (pointer.empty() ? "it" : pointer.substr(1)) + " is " + shown(there, pointer) +
         " there and " + shown(here, pointer) + " here";
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  const json document = {{"format", checkpoint_format},
                         {"identity", checkpoint.identity},
                         {"step", checkpoint.step},
                         {"state", state_to_json(checkpoint.state)},
                         {"integrator", to_bytes(checkpoint.integrator)},
                         {"counters", counters_to_json(checkpoint.counters)},
                         {"observers", checkpoint.observers}};
  std::string bytes;
  json::to_cbor(document, bytes);
  write_atomically(path, bytes);
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path, const json& identity) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  const Location place(path.string());
  const json document = parse(path);
  const json format = document.value("format", json());
  if (format != checkpoint_format) {
    place.refuse("is no checkpoint that this program can read, for its format is " +
                 describe(format) + "; allowed is \"" + checkpoint_format + "\", or another file");
  }
  if (document.value("identity", json()) != identity) {
    place.refuse("is the checkpoint of another run: " +
                 first_difference(document.value("identity", json()), identity) +
                 "; allowed is the run that wrote it, or another file");
  }
  try {
    Checkpoint checkpoint;
    checkpoint.identity = identity;
    checkpoint.step = document.at("step").get<std::uint64_t>();
    checkpoint.state = state_from_json(document.at("state"));
    checkpoint.integrator = from_bytes<double>(document.at("integrator"));
    checkpoint.counters = counters_from_json(document.at("counters"));
    checkpoint.observers = document.at("observers");
    return checkpoint;
  } catch (const std::exception& fault) {
    place.refuse(std::string("is a damaged checkpoint (") + fault.what() +
                 "); allowed is a whole one, or another file");
  }
}

}  // namespace driftless
