#include "experiments/trajectory.hpp"

#include <fmt/format.h>

#include <iterator>

#include "experiments/location.hpp"

namespace driftless {
namespace {

using nlohmann::json;
using Text = fmt::memory_buffer;

void add(Text& text, const Vector& vector) {
  fmt::format_to(std::back_inserter(text), " {:.9g} {:.9g} {:.9g}", vector[0], vector[1],
                 vector[2]);
}

void add_header(Text& text, const System& system, std::uint64_t step, double time_step) {
  const Vector& lengths = system.box().lengths;
  fmt::format_to(std::back_inserter(text),
                 "{}\nLattice=\"{:.17g} 0 0 0 {:.17g} 0 0 0 {:.17g}\" "
                 "Properties=species:S:1:pos:R:3:velo:R:3:momenta:R:3:masses:R:1{}:id:I:1 "
                 "Time={:.12g} Step={} pbc=\"T T T\"\n",
                 system.size(), lengths[0], lengths[1], lengths[2],
                 system.fluid().isothermal() ? "" : ":internal_energy:R:1:temperature:R:1",
                 static_cast<double>(step) * time_step, step);
}

void add_particle(Text& text, const System& system, std::size_t place) {
  const State& state = system.state();
  const Fluid& fluid = system.fluid();
  text.push_back('X');  // no chemical element, as ASE knows it
  add(text, state.position[place]);
  add(text, state.velocity[place]);
  add(text, fluid.mass() * state.velocity[place]);
  fmt::format_to(std::back_inserter(text), " {:.9g}", fluid.mass());
  if (!fluid.isothermal()) {
    const double u = state.internal_energy[place];
    fmt::format_to(std::back_inserter(text), " {:.9g} {:.9g}", u, fluid.temperature(u));
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
  for (std::size_t i = 0; i < system.size(); ++i) add_particle(text, system, i);
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
