#include "experiments/judge/two_body/bins.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

namespace driftless::two_body {
namespace {

using boost::math::ibeta;
using boost::math::ibetac;

constexpr int most_thermal_speeds = 8;

int even_number(double range, double width) {
  return 2 * static_cast<int>(std::ceil(range / width / 2));
}

/// ln of the masses of equal bins over a symmetric law, from those of its half below the middle,
/// `below(s)` being the law's mass up to s, where s runs from 0 to 1/2 of the range.
template <class Below>
std::vector<double> log_masses(int bins, Below&& below) {
  std::vector<double> masses(static_cast<std::size_t>(bins));
  for (int n = 0; n < bins / 2; ++n) {
    const double mass = below((n + 1.0) / bins) - below(double(n) / bins);
    masses[static_cast<std::size_t>(n)] = std::log(mass);
    masses[static_cast<std::size_t>(bins - 1 - n)] = std::log(mass);
  }
  return masses;
}

int place(double position, int bins) {
  return std::clamp(static_cast<int>(position * bins), 0, bins - 1);
}

}  // namespace

PairBins::PairBins(const Bench& bench) {
  if (bench.fluid.isothermal()) {
    thermal_speed_ = std::sqrt(bench.thermal_energy() / bench.reduced_mass());
    velocities_ = 6 * most_thermal_speeds;
    log_mass_ = log_masses(velocities_, [](double s) {
      return s > 0 ? 0.5 * std::erfc(most_thermal_speeds * (1 - 2 * s) / std::sqrt(2.0)) : 0;
    });
    return;
  }
  const double shape = bench.law().shape;
  const double total = 2 * shape + 0.5;
  velocities_ = even_number(2, std::sqrt(0.5 / total) / 3);
  shares_ = even_number(1, std::sqrt(0.25 / (2 * shape + 1)) / 3);
  const auto velocities = log_masses(velocities_, [&](double s) {
    const double speed = 1 - 2 * s;  // K/e = speed^2 ~ Beta(1/2, 2a)
    return 0.5 * ibetac(0.5, 2 * shape, speed * speed);
  });
  const auto shares = log_masses(shares_, [&](double s) { return ibeta(shape, shape, s); });
  for (const double a : velocities) {
    for (const double b : shares) log_mass_.push_back(a + b);
  }
}

std::uint16_t PairBins::bin(const PairView& pair) const {
  if (thermal_speed_ > 0) {
    const double speeds = pair.velocity / thermal_speed_ / most_thermal_speeds;
    return static_cast<std::uint16_t>(place(0.5 * (1 + speeds), velocities_));
  }
  const double share = std::sqrt(pair.kinetic / pair.energy());
  const int row = place(0.5 * (1 + std::copysign(share, pair.velocity)), velocities_);
  const int column = place(pair.u_i / (pair.u_i + pair.u_j), shares_);
  return static_cast<std::uint16_t>(row * shares_ + column);
}

}  // namespace driftless::two_body
