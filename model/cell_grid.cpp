#include "model/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "model/lanes.hpp"
#include "model/picked_lanes.hpp"

namespace driftless {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Fills `places` with those whose cell is one from `first` to below `last`; returns how many there
/// are, and how many places are of cells below. Cells are readable beyond the end by a vector.
std::pair<std::size_t, std::uint32_t> find_places(const std::vector<std::uint32_t>& cells,
                                                  std::size_t particles, std::uint32_t first,
                                                  std::uint32_t last,
                                                  std::vector<std::uint32_t>& places) {
  const Indices indices;
  const auto begin = hn::Set(indices, first), length = hn::Set(indices, last - first);
  std::size_t count = 0, below = 0;
  for (std::size_t n = 0; n < particles; n += hn::Lanes(indices)) {
    // One thread's part is a share of the particles, as large as the others' or nearly.
    if (places.size() < count + hn::Lanes(indices)) places.resize(count + count / 8 + 1024);
    const auto counted = hn::FirstN(indices, particles - n);
    const auto cell = hn::LoadU(indices, cells.data() + n);
    const auto inside = hn::Lt(hn::Sub(cell, begin), length);
    below += hn::CountTrue(indices, hn::And(counted, hn::Lt(cell, begin)));
    count += store_picked(counting_from(static_cast<std::uint32_t>(n)), hn::And(counted, inside),
                          places.data() + count);
  }
  return {count, static_cast<std::uint32_t>(below)};
}

/// How many pairs of tiles, of the two colours, so many cells are cut into: tiles of one colour are
/// apart by no less than two cells. A few pairs ought to be alike, as threads wait for the largest.
int pairs_of_tiles(int cells) {
  const int most = cells / 4;
  for (int pairs = most; most < 5 && pairs > 1; --pairs) {
    if (cells % pairs == 0) return pairs;
  }
  return most;
}

}  // namespace

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
  cut_tiles();
  order_rows();
}

void CellGrid::cut_tiles() {
  for (int axis = 0; axis < 3; ++axis) {
    tiles_[axis] = count_[axis] < 4 ? 1 : 2 * pairs_of_tiles(count_[axis]);
  }
  // Columns have half as many colours, each a phase to wait for; of many particles those of a tile
  // stay in the cache.
  if (!few() || tiles_.minCoeff() == 1) return;
  int along = 0;
  tiles_.minCoeff(&along);
  tiles_[along] = 1;
}

// What a thread works on lies side by side: tiles that are neighbours and of different colours.
void CellGrid::order_rows() {
  struct Row {
    int z_tiles, y_tiles, z, y;
    auto operator<=>(const Row&) const = default;
  };
  std::vector<Row> rows;
  for (int z_tile = 0; z_tile < tiles_[2]; ++z_tile) {
    for (int y_tile = 0; y_tile < tiles_[1]; ++y_tile) {
      for (int z = cell_of(2, z_tile); z < cell_of(2, z_tile + 1); ++z) {
        for (int y = cell_of(1, y_tile); y < cell_of(1, y_tile + 1); ++y) {
          rows.push_back({z_tile / 2, y_tile / 2, z, y});
        }
      }
    }
  }
  std::sort(rows.begin(), rows.end());
  row_.resize(rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    row_[row(rows[n].y, rows[n].z)] = n * static_cast<std::size_t>(count_[0]);
  }
}

void CellGrid::sort(const State& state) {
  begin_sort(state);
  assign(state, 0, 1);
  fill(state, 0, 1);
}

void CellGrid::begin_sort(const State& state) {
  particles_ = state.size();
  // Vectors of single precision are read beyond the end.
  const std::size_t padded = state.size() + 2 * Lanes::count();
  cell_.resize(padded);
  number_.resize(state.size());
  entries_.resize(state.size());
  species_.resize(state.species.size());
  position_.resize(padded);
  for (auto& values : rough_) values.resize(padded);

  const auto cells = static_cast<std::size_t>(count_.prod());
  next_.resize(cells);
  begin_.resize(cells + 1);
  begin_[cells] = static_cast<std::uint32_t>(state.size());
}

void CellGrid::follow_storage() {
  for (std::uint32_t n = 0; n < particles_; ++n) entries_[n].place = number_[n] = n;
}

void CellGrid::assign(const State& state, std::size_t share, std::size_t shares) {
  const Eigen::Array3d scale = count_.cast<double>().array() / lengths_.array();
  const std::size_t begin = particles_ * share / shares, end = particles_ * (share + 1) / shares;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Array3i cell = (state.position[i].array() * scale).cast<int>();
    // Rounding may lead out of the last cell.
    const Eigen::Array3i inside = cell.min(count_.array() - 1);
    cell_[i] = static_cast<std::uint32_t>(index(inside[0], inside[1], inside[2]));
  }
}

// Wherever they are stored: no two parts write side by side.
std::pair<std::size_t, std::size_t> CellGrid::fill(const State& state, std::size_t part,
                                                   std::size_t parts) {
  const std::size_t first = next_.size() * part / parts, last = next_.size() * (part + 1) / parts;
  thread_local std::vector<std::uint32_t> places;
  const auto [count, from] = find_places(cell_, particles_, static_cast<std::uint32_t>(first),
                                         static_cast<std::uint32_t>(last), places);
  std::fill_n(next_.begin() + static_cast<std::ptrdiff_t>(first), last - first, 0);
  for (std::size_t n = 0; n < count; ++n) ++next_[cell_[places[n]]];
  std::uint32_t before = from;
  for (std::size_t c = first; c < last; ++c) {
    begin_[c] = before;
    before += std::exchange(next_[c], before);
  }
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint32_t place = places[n];
    entries_[next_[cell_[place]]++] = {place, state.id[place]};
  }
  const auto by_id = [](const Entry& a, const Entry& b) { return a.id < b.id; };
  for (std::size_t c = first; c < last; ++c) {
    const auto begin = entries_.begin() + begin_[c], end = entries_.begin() + next_[c];
    if (!std::is_sorted(begin, end, by_id)) std::sort(begin, end, by_id);
  }
  gather(state, from, before);
  return {from, before};
}

void CellGrid::gather(const State& state, std::size_t begin, std::size_t end) {
  for (std::size_t n = begin; n < end; ++n) {
    const std::uint32_t place = entries_[n].place;
    number_[place] = static_cast<std::uint32_t>(n);
    if (!species_.empty()) species_[n] = state.species[place];
    const Vector& position = state.position[place];
    position_[n] = {position[0], position[1], position[2], 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rough_[axis][n] = static_cast<float>(position[static_cast<Eigen::Index>(axis)]);
    }
  }
}

}  // namespace driftless
