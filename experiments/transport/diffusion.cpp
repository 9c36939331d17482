#include "experiments/transport/diffusion.hpp"

namespace driftless::transport {

void Diffusion::follow(const System& system) {
  const State& state = system.state();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto id = state.id[i];
    travelled_[id] += system.box().minimum_image(state.position[i] - last_[id]);
    last_[id] = state.position[i];
  }
}

void Diffusion::take(const System& system) {
  const State& state = system.state();
  const std::size_t size = state.size();
  if (lag_ == displacement_.size()) lag_ = 0;
  if (lag_ == 0) {
    last_.resize(size), first_velocity_.resize(size);
    travelled_.assign(size, Vector::Zero());
    for (std::size_t i = 0; i < size; ++i) {
      last_[state.id[i]] = state.position[i];
      first_velocity_[state.id[i]] = state.velocity[i];
    }
  }
  follow(system);
  auto& moved = displacement_[lag_];
  auto& turned = velocity_[lag_];
  for (std::size_t i = 0; i < size; ++i) {
    const auto id = state.id[i];
    moved.value += travelled_[id].squaredNorm();
    turned.value += state.velocity[i].dot(first_velocity_[id]) / 3;
  }
  moved.count += static_cast<double>(size);
  turned.count += static_cast<double>(size);
  ++lag_;
}

std::vector<double> Diffusion::means(const std::vector<Sum>& sums) {
  std::vector<double> values;
  for (const auto& sum : sums) values.push_back(sum.count > 0 ? sum.value / sum.count : 0);
  return values;
}

double diffusion_from_displacement(const Decay& squared_displacement) {
  const auto& values = squared_displacement.values;
  const std::size_t first = values.size() / 2;
  const double count = static_cast<double>(values.size() - first);
  double t_mean = 0, y_mean = 0, covariance = 0, variance = 0;
  for (std::size_t n = first; n < values.size(); ++n) {
    t_mean += static_cast<double>(n) / count;
    y_mean += values[n] / count;
  }
  for (std::size_t n = first; n < values.size(); ++n) {
    const double t = static_cast<double>(n) - t_mean;
    covariance += t * (values[n] - y_mean);
    variance += t * t;
  }
  return covariance / (variance * squared_displacement.interval) / 6;
}

double diffusion_from_velocity(const Decay& velocity_autocorrelation) {
  return velocity_autocorrelation.values.front() / integral_rate(velocity_autocorrelation);
}

}  // namespace driftless::transport
