#include "model/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "model/lanes.hpp"

namespace driftless {

CellGrid::CellGrid(const Box& box, double range, std::size_t particles)
    : box_(box), lengths_(box.lengths), particles_(particles) {
  for (int axis = 0; axis < 3; ++axis) {
    if (box.is_walled(axis)) lengths_[axis] += range;
  }
  if (lengths_.minCoeff() < 2 * range) {
    std::ostringstream message;
    message << "the box's shortest side " << box.lengths.minCoeff()
            << " is below twice the range of the interaction " << range;
    throw std::invalid_argument(message.str());
  }
  cut(range);
}

void CellGrid::cut(double range) {
  // Of two cells each would be on both sides of the other.
  Eigen::Array3d fit = Eigen::Array3d::Ones();
  for (int axis = 0; axis < 3; ++axis) {
    const double ranges = range > 0 ? lengths_[axis] / range : 1.0;
    if (ranges >= 3) fit[axis] = ranges;
  }
  // No more than a few cells per particle, however dilute the system; what short sides leave of
  // them the long ones may have.
  const double most = std::max(3.0, 2 * std::cbrt(static_cast<double>(particles_)));
  double spare = 1;
  int long_sides = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (fit[axis] < most) spare *= most / fit[axis];
    if (fit[axis] >= most) ++long_sides;
  }
  const double most_of_long = most * std::pow(spare, 1.0 / std::max(1, long_sides));
  count_ = fit.min(most_of_long).cast<int>();
  // Below four cells no two groups of cells are apart.
  single_ = count_.maxCoeff() < 4;
  if (single_) count_ = Eigen::Vector3i::Ones();
}

void CellGrid::sort(const State& state, const Threads& threads) {
  particles_ = state.size();
  // Vectors of single precision are read beyond the end.
  const std::size_t padded = state.size() + 2 * Lanes::count();
  cell_.resize(state.size());
  entries_.resize(state.size());
  species_.resize(state.species.size());
  position_.resize(padded);
  for (auto& values : rough_) values.resize(padded);

  // Every thread counts a share of the particles, and has its own places in each cell.
  const auto cells = static_cast<std::size_t>(count_.prod());
  const std::size_t shares = threads.count();
  const std::size_t tasks[] = {shares};
  const auto share = [&](std::size_t n) { return state.size() * n / shares; };
  next_.resize(shares * cells);
  threads.phases(tasks, [&](unsigned, std::size_t, std::size_t n) {
    std::uint32_t* const counts = next_.data() + n * cells;
    std::fill_n(counts, cells, 0);
    assign(state, share(n), share(n + 1));
    for (std::size_t i = share(n); i < share(n + 1); ++i) ++counts[cell_[i]];
  });
  begin_.resize(cells + 1);
  std::uint32_t before = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    begin_[c] = before;
    for (std::size_t n = 0; n < shares; ++n) {
      before += std::exchange(next_[n * cells + c], before);
    }
  }
  begin_[cells] = before;
  threads.phases(tasks, [&](unsigned, std::size_t, std::size_t n) {
    std::uint32_t* const next = next_.data() + n * cells;
    for (std::size_t i = share(n); i < share(n + 1); ++i) {
      entries_[next[cell_[i]]++] = {static_cast<std::uint32_t>(i), state.id[i]};
    }
  });
  const auto by_id = [](const Entry& a, const Entry& b) { return a.id < b.id; };
  threads.ranges(cells, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      const auto from = entries_.begin() + begin_[c], to = entries_.begin() + begin_[c + 1];
      if (!std::is_sorted(from, to, by_id)) std::sort(from, to, by_id);
    }
    gather(state, begin_[first], begin_[last]);
  });
}

void CellGrid::assign(const State& state, std::size_t begin, std::size_t end) {
  const Eigen::Array3d scale = count_.cast<double>().array() / lengths_.array();
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Array3i cell = (state.position[i].array() * scale).cast<int>();
    // Rounding may lead out of the last cell.
    const Eigen::Array3i inside = cell.min(count_.array() - 1);
    cell_[i] = static_cast<std::uint32_t>(index(inside[0], inside[1], inside[2]));
  }
}

void CellGrid::gather(const State& state, std::size_t begin, std::size_t end) {
  for (std::size_t n = begin; n < end; ++n) {
    const std::uint32_t place = entries_[n].place;
    if (!species_.empty()) species_[n] = state.species[place];
    const Vector& position = state.position[place];
    position_[n] = {position[0], position[1], position[2], 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rough_[axis][n] = static_cast<float>(position[static_cast<Eigen::Index>(axis)]);
    }
  }
}

}  // namespace driftless
