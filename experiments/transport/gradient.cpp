#include "experiments/transport/gradient.hpp"

#include <cmath>

namespace driftless::transport {
namespace {

double shape_of(HeatShape shape, double angle) {
  const double wave = std::cos(angle);
  if (shape == HeatShape::cosine) return wave;
  const double edge = std::sqrt(0.5);  // of slabs a quarter of the box wide
  return wave > edge ? 1 : wave < -edge ? -1 : 0;
}

}  // namespace

void HeatSource::apply(System& system, double duration) {
  const double k = wave_vector(system.box(), axis_, 1)[axis_];
  const auto& positions = system.state().position;
  const auto given = [&](std::size_t i) { return shape_of(shape_, k * positions[i][axis_]); };
  double mean = 0, wave = 0, cosines = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double cosine = std::cos(k * positions[i][axis_]);
    mean += given(i) / static_cast<double>(positions.size());
    wave += given(i) * cosine;
    cosines += cosine;
  }
  heat_ += rate_ * duration * (wave - mean * cosines);
  duration_ += duration;
  system.update(
      [&](std::size_t i, Vector&, double& u) { u += rate_ * duration * (given(i) - mean); });
}

void HeatSource::measure(System& system) {
  // <u> = (phi + k) T.
  const double capacity = system.fluid().parameters().heat_capacity + system.fluid().boltzmann();
  temperature_ += modes(system, axis_, 1).internal_energy.real() / capacity;
  ++samples_;
}

double HeatSource::conductivity(const System& system) const {
  const double k = wave_vector(system.box(), axis_, 1)[axis_];
  const double density = static_cast<double>(system.size()) / system.box().volume();
  return density * (heat_ / duration_) / (k * k * temperature_ / samples_);
}

double HeatSource::amplitude(const System& system) const {
  const auto& fluid = system.fluid().parameters();
  return 2 * temperature_ / samples_ / (static_cast<double>(system.size()) * fluid.temperature);
}

void HeatSource::reset() { heat_ = duration_ = temperature_ = samples_ = 0; }

}  // namespace driftless::transport
