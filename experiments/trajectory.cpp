#include "experiments/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <string_view>
#include <vector>

#include "experiments/location.hpp"

namespace driftless {
namespace {

using nlohmann::json;
using Text = fmt::memory_buffer;

/// Readers expect chemical elements; X is none, as ASE knows it.
std::string_view species_symbol(const System& system, std::size_t place) {
  constexpr std::array<std::string_view, 10> elements = {"H", "He", "Li", "Be", "B",
                                                         "C", "N",  "O",  "F",  "Ne"};
  if (system.fluid().species() == 1) return "X";
  const auto& species = system.state().species;
  const std::size_t number = species.empty() ? 0 : species[place];
  return number < elements.size() ? elements[number] : "X";
}

void add(Text& text, const Vector& vector) {
  fmt::format_to(std::back_inserter(text), " {:.9g} {:.9g} {:.9g}", vector[0], vector[1],
                 vector[2]);
}

void add_header(Text& text, const System& system, std::uint64_t step, double time_step) {
  const Vector& lengths = system.box().lengths;
  const auto periodic = [&](int axis) { return system.box().is_walled(axis) ? 'F' : 'T'; };
  fmt::format_to(std::back_inserter(text),
                 "{}\nLattice=\"{:.17g} 0 0 0 {:.17g} 0 0 0 {:.17g}\" "
                 "Properties=species:S:1:pos:R:3:velo:R:3:momenta:R:3:masses:R:1{}:id:I:1 "
                 "Time={:.12g} Step={} pbc=\"{} {} {}\"\n",
                 system.size(), lengths[0], lengths[1], lengths[2],
                 system.fluid().isothermal() ? "" : ":internal_energy:R:1:temperature:R:1",
                 static_cast<double>(step) * time_step, step, periodic(0), periodic(1),
                 periodic(2));
}

void add_particle(Text& text, const System& system, std::size_t place) {
  const State& state = system.state();
  const double mass = system.mass(place);
  const std::string_view symbol = species_symbol(system, place);
  text.append(symbol.data(), symbol.data() + symbol.size());
  add(text, state.position[place]);
  add(text, state.velocity[place]);
  add(text, mass * state.velocity[place]);
  fmt::format_to(std::back_inserter(text), " {:.9g}", mass);
  if (!system.fluid().isothermal()) {
    const double u = state.internal_energy[place];
    fmt::format_to(std::back_inserter(text), " {:.9g} {:.9g}", u,
                   system.equation_of_state(place).temperature(u));
  }
  fmt::format_to(std::back_inserter(text), " {}\n", state.id[place]);
}

}  // namespace

Trajectory::Trajectory(std::filesystem::path path, double time_step)
    : path_(std::move(path)), time_step_(time_step) {}

void Trajectory::open() {
  if (file_.is_open()) return;
  file_.open(path_, std::ios::binary | (bytes_ == 0 ? std::ios::trunc : std::ios::app));
}

void Trajectory::write(const std::string& text) {
  open();
  file_ << text;
  file_.flush();
  if (!file_) Location(path_.string()).refuse("cannot be written");
  bytes_ += text.size();
}

void Trajectory::sample(System& system, std::uint64_t step) {
  Text text;
  add_header(text, system, step, time_step_);
  // In the order of ids: storage changes its order, and not every reader follows ids.
  const auto& id = system.state().id;
  std::vector<std::size_t> place(system.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::sort(place.begin(), place.end(), [&](auto a, auto b) { return id[a] < id[b]; });
  for (const std::size_t i : place) add_particle(text, system, i);
  write(fmt::to_string(text));
  ++frames_;
}

json Trajectory::save() { return {{"frames", frames_}, {"bytes", bytes_}}; }

void Trajectory::load(const json& saved) {
  file_.close();
  frames_ = saved.at("frames").get<std::uint64_t>();
  bytes_ = saved.at("bytes").get<std::uint64_t>();
  if (bytes_ == 0) return;
  std::error_code error;
  const auto there = std::filesystem::file_size(path_, error);
  if (error || there < bytes_) {
    Location(path_.string())
        .refuse(fmt::format("holds {} bytes, but {} when the checkpoint was written; allowed is "
                            "the file as the run left it, or a start without the checkpoint",
                            error ? 0 : there, bytes_));
  }
  std::filesystem::resize_file(path_, bytes_, error);
  if (error) Location(path_.string()).refuse("cannot be written");
}

}  // namespace driftless
