#include "experiments/binned_law.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace driftless {
namespace {

void check(std::size_t bins) {
  if (bins < 2) throw std::invalid_argument("a binned law needs two bins");
}

void check(double a, double b, std::size_t bins) {
  if (!(a > 0.0) || !(b > 0.0) || !std::isfinite(a) || !std::isfinite(b)) {
    throw std::invalid_argument("a Beta law needs two positive shapes");
  }
  check(bins);
}

}  // namespace

BinnedLaw BinnedLaw::beta(double a, double b, std::size_t bins) {
  check(a, b, bins);
  std::vector<double> edges(bins + 1);
  for (std::size_t i = 1; i < bins; ++i) {
    // The nearer tail's probability, for its relative precision.
    const double below = static_cast<double>(i) / static_cast<double>(bins);
    const double above = static_cast<double>(bins - i) / static_cast<double>(bins);
    edges[i] =
        below <= above ? boost::math::ibeta_inv(a, b, below) : boost::math::ibetac_inv(a, b, above);
  }
  edges.back() = 1.0;
  return BinnedLaw(std::move(edges));
}

BinnedLaw BinnedLaw::signed_root(double b, std::size_t bins) {
  check(0.5, b, bins);
  std::vector<double> edges(bins + 1);
  for (std::size_t i = 0; 2 * i <= bins; ++i) {
    // P(|x| > edge) of the two mirrored edges; exactly 0 in the middle.
    const double outside = 2.0 * static_cast<double>(i) / static_cast<double>(bins);
    const double edge = i == 0          ? 1.0
                        : 2 * i == bins ? 0.0
                                        : std::sqrt(boost::math::ibetac_inv(0.5, b, outside));
    edges[i] = -edge;
    edges[bins - i] = edge;
  }
  return BinnedLaw(std::move(edges));
}

BinnedLaw BinnedLaw::normal(std::size_t bins) {
  check(bins);
  std::vector<double> edges(bins + 1);
  for (std::size_t i = 0; 2 * i <= bins; ++i) {
    // P(|x| > edge) of the two mirrored edges; exactly 0 in the middle.
    const double outside = 2.0 * static_cast<double>(i) / static_cast<double>(bins);
    const double edge = i == 0          ? std::numeric_limits<double>::infinity()
                        : 2 * i == bins ? 0.0
                                        : std::sqrt(2.0) * boost::math::erfc_inv(outside);
    edges[i] = -edge;
    edges[bins - i] = edge;
  }
  return BinnedLaw(std::move(edges));
}

BinnedLaw BinnedLaw::gamma(double shape, std::size_t bins) {
  if (!(shape > 0.0) || !std::isfinite(shape)) {
    throw std::invalid_argument("a Gamma law needs a positive shape");
  }
  check(bins);
  std::vector<double> edges(bins + 1);
  for (std::size_t i = 1; i < bins; ++i) {
    const double below = static_cast<double>(i) / static_cast<double>(bins);
    edges[i] = boost::math::gamma_p_inv(shape, below);
  }
  edges.back() = std::numeric_limits<double>::infinity();
  return BinnedLaw(std::move(edges));
}

BinnedLaw::BinnedLaw(std::vector<double> edges) : edges_(std::move(edges)) {
  for (std::size_t i = 1; i < edges_.size(); ++i) {
    if (!(edges_[i] > edges_[i - 1])) {
      throw std::invalid_argument("a law too narrow for its number of bins");
    }
  }
  const std::size_t cells = 16 * bins();
  const double first = edges_[1];
  const double last = edges_[bins() - 1];
  cells_per_unit_ = last > first ? static_cast<double>(cells) / (last - first) : 0.0;
  guide_.resize(cells + 1);
  for (std::size_t cell = 0; cell <= cells; ++cell) {
    const double start =
        first + (last - first) * static_cast<double>(cell) / static_cast<double>(cells);
    const auto above = std::upper_bound(edges_.begin(), edges_.end() - 1, start);
    guide_[cell] = static_cast<std::uint32_t>(above - edges_.begin()) - 1;
  }
}

std::size_t BinnedLaw::bin(double sample) const {
  const std::size_t last = bins() - 1;
  if (!(sample >= edges_[1])) return 0;
  if (sample >= edges_[last]) return last;
  std::size_t result = guide_[static_cast<std::size_t>((sample - edges_[1]) * cells_per_unit_)];
  // The cell may hold an edge, and rounding may have picked its neighbour.
  while (sample >= edges_[result + 1]) ++result;
  while (sample < edges_[result]) --result;
  return result;
}

double BinnedLaw::density(std::size_t bin) const {
  return 1.0 / (static_cast<double>(bins()) * (edges_[bin + 1] - edges_[bin]));
}

}  // namespace driftless
