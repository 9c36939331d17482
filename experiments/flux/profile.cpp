#include "experiments/flux/profile.hpp"

#include <cmath>

namespace driftless::flux {

Profile::Profile(const Box& box, int axis, std::size_t bins)
    : axis_(axis),
      bins_(bins),
      width_(box.lengths[axis] / static_cast<double>(bins)),
      bin_volume_(box.volume() / static_cast<double>(bins)),
      length_(box.lengths[axis]) {}

void Profile::sample(const System& system) {
  const State& state = system.state();
  const Fluid& fluid = system.fluid();
  boltzmann_ = fluid.boltzmann();
  // The centre of mass is at rest: it lacks one of N shares.
  kinetic_share_ = 1 - 1 / static_cast<double>(system.size());
  std::vector<double> row(3 * bins_, 0.0);
  for (std::size_t i = 0; i < system.size(); ++i) {
    const auto bin =
        std::min(bins_ - 1, static_cast<std::size_t>(state.position[i][axis_] / width_));
    row[count * bins_ + bin] += 1;
    row[inverse_temperature * bins_ + bin] +=
        1 / system.equation_of_state(i).temperature(state.internal_energy[i]);
    row[kinetic * bins_ + bin] += 0.5 * system.mass(i) * state.velocity[i].squaredNorm();
  }
  rows_.push_back(std::move(row));
}

Eigen::MatrixXd Profile::samples(const std::vector<std::size_t>& bins,
                                 const std::vector<Quantity>& quantities) const {
  Eigen::MatrixXd matrix(rows_.size(), bins.size() * quantities.size());
  for (std::size_t n = 0; n < rows_.size(); ++n) {
    Eigen::Index column = 0;
    for (const Quantity quantity : quantities) {
      for (const std::size_t bin : bins) matrix(n, column++) = rows_[n][quantity * bins_ + bin];
    }
  }
  return matrix;
}

Estimate Profile::density(std::size_t bin) const {
  return estimate({samples({bin}, {count})},
                  [&](const auto& means) { return means[0] / bin_volume_; });
}

Estimate Profile::internal_temperature(std::size_t bin) const {
  return estimate({samples({bin}, {count, inverse_temperature})},
                  [](const auto& means) { return means[0] / means[1]; });
}

Estimate Profile::kinetic_temperature(std::size_t bin) const {
  const double unit = 1.5 * boltzmann_ * kinetic_share_;
  return estimate({samples({bin}, {count, kinetic})},
                  [&](const auto& means) { return means[1] / (unit * means[0]); });
}

Profile::Line Profile::line(const std::vector<std::size_t>& bins, double origin) const {
  const auto number = static_cast<Eigen::Index>(bins.size());
  Eigen::VectorXd x(number);
  for (Eigen::Index n = 0; n < number; ++n) {
    double away = centre(bins[static_cast<std::size_t>(n)]) - origin;
    away -= length_ * std::round(away / length_);
    x[n] = std::abs(away);
  }
  const Eigen::VectorXd centred = (x.array() - x.mean()).matrix();
  const auto data = std::vector{samples(bins, {count, inverse_temperature})};
  const auto temperatures = [number](const Eigen::VectorXd& means) -> Eigen::VectorXd {
    return means.head(number).cwiseQuotient(means.tail(number));
  };
  Line line;
  line.slope = estimate(data, [&](const Eigen::VectorXd& means) {
    return centred.dot(temperatures(means)) / centred.squaredNorm();
  });
  line.middle =
      estimate(data, [&](const Eigen::VectorXd& means) { return temperatures(means).mean(); });
  line.mean_density = estimate(
      data, [&](const Eigen::VectorXd& means) { return means.head(number).mean() / bin_volume_; });
  return line;
}

}  // namespace driftless::flux
