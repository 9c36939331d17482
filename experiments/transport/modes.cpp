#include "experiments/transport/modes.hpp"

#include <numbers>
#include <stdexcept>

namespace driftless::transport {

Vector wave_vector(const Box& box, int axis, int number) {
  Vector k = Vector::Zero();
  k[axis] = 2 * std::numbers::pi * number / box.lengths[axis];
  return k;
}

Modes modes(System& system, int axis, int number) {
  const State& state = system.state();
  const double k = wave_vector(system.box(), axis, number)[axis];
  const auto particles = static_cast<double>(state.size());
  const double mass = system.fluid().mass();
  const bool potential = system.fluid().has_repulsion();
  const double mean_internal = system.internal_energy() / particles;
  const double mean_energy = system.total_energy() / particles;
  Modes sums{};
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Complex wave = std::polar(1.0, -k * state.position[i][axis]);
    const Vector& v = state.velocity[i];
    const double u = state.internal_energy[i];
    const double share = potential ? system.potential_shares()[i] : 0;
    sums.density += wave;
    sums.longitudinal += v[axis] * wave;
    for (int n = 0; n < 2; ++n) sums.transverse[n] += v[(axis + 1 + n) % 3] * wave;
    sums.internal_energy += (u - mean_internal) * wave;
    sums.energy += (0.5 * mass * v.squaredNorm() + u + share - mean_energy) * wave;
  }
  return sums;
}

std::vector<double> autocorrelation(const std::vector<Complex>& series, std::size_t lags) {
  if (series.size() < lags) throw std::invalid_argument("a series is shorter than its lags");
  std::vector<double> correlation(lags);
  for (std::size_t lag = 0; lag < lags; ++lag) {
    double sum = 0;
    const std::size_t pairs = series.size() - lag;
    for (std::size_t n = 0; n < pairs; ++n) {
      sum += (series[n + lag] * std::conj(series[n])).real();
    }
    correlation[lag] = sum / static_cast<double>(pairs);
  }
  return correlation;
}

std::vector<Complex> orthogonal_part(const std::vector<Complex>& series,
                                     const std::vector<Complex>& other) {
  Complex common = 0;
  double square = 0;
  for (std::size_t n = 0; n < series.size(); ++n) {
    common += series[n] * std::conj(other[n]);
    square += std::norm(other[n]);
  }
  // In a fluid at rest the coefficient is real; its imaginary part is noise.
  const double slope = square > 0 ? common.real() / square : 0;
  std::vector<Complex> rest = series;
  for (std::size_t n = 0; n < rest.size(); ++n) rest[n] -= slope * other[n];
  return rest;
}

}  // namespace driftless::transport
