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
  cell_or_number_.resize(state.size());
  entries_.resize(state.size());
  species_.resize(state.species.size());
  position_.resize(padded);
  for (auto& values : rough_) values.resize(padded);

  const auto cells = static_cast<std::size_t>(count_.prod());
  next_.resize(cells);
  begin_.resize(cells + 1);
  begin_[cells] = static_cast<std::uint32_t>(state.size());
  // Every thread hands a share of the particles out to parts of the cells, a part being one
  // thread's: no two threads write side by side.
  if (parts_ != threads.count()) cut_parts(threads.count());
  handed_out_.resize(parts_ > 1 ? state.size() : 0);
  part_end_.resize(parts_ * parts_);
  const std::size_t tasks[] = {parts_, parts_};
  threads.phases(tasks, [&](unsigned, std::size_t phase, std::size_t task) {
    if (phase == 0) {
      hand_out(state, task);
    } else {
      fill_cells(state, task);
    }
  });
}

void CellGrid::follow_storage() {
  for (std::uint32_t n = 0; n < particles_; ++n) {
    entries_[n].place = n;
    if (parts_ > 1) handed_out_[n] = {entries_[n].id, n, n};
    cell_or_number_[n] = n;
  }
}

void CellGrid::cut_parts(std::size_t parts) {
  parts_ = parts;
  part_of_cell_.resize(next_.size());
  for (std::size_t part = 0; part < parts; ++part) {
    std::fill(part_of_cell_.begin() + static_cast<std::ptrdiff_t>(part_begin(part)),
              part_of_cell_.begin() + static_cast<std::ptrdiff_t>(part_begin(part + 1)), part);
  }
}

void CellGrid::hand_out(const State& state, std::size_t share) {
  const std::size_t first = share_begin(share), last = share_begin(share + 1);
  assign(state, first, last);
  if (parts_ == 1) return;
  // Counted in memory of its own: threads that count side by side hold each other up.
  std::vector<std::uint32_t> end(parts_ + 32);
  for (std::size_t i = first; i < last; ++i) ++end[part_of(cell_or_number_[i])];
  auto before = static_cast<std::uint32_t>(first);
  for (std::size_t part = 0; part < parts_; ++part) before += std::exchange(end[part], before);
  for (std::size_t i = first; i < last; ++i) {
    handed_out_[end[part_of(cell_or_number_[i])]++] = {state.id[i], static_cast<std::uint32_t>(i),
                                                       cell_or_number_[i]};
  }
  std::copy_n(end.begin(), parts_, &part_end_[share * parts_]);
}

std::size_t CellGrid::part_size(std::size_t share, std::size_t part) const {
  const std::uint32_t* const end = &part_end_[share * parts_];
  return end[part] - (part > 0 ? end[part - 1] : share_begin(share));
}

template <class Visit>
void CellGrid::for_each_of_part(const State& state, std::size_t part, Visit&& visit) const {
  if (parts_ == 1) {
    for (std::uint32_t i = 0; i < state.size(); ++i) visit(i, state.id[i], cell_or_number_[i]);
    return;
  }
  for (std::size_t share = 0; share < parts_; ++share) {
    const std::uint32_t end = part_end_[share * parts_ + part];
    for (auto n = end - static_cast<std::uint32_t>(part_size(share, part)); n < end; ++n) {
      visit(n, handed_out_[n].id, handed_out_[n].cell_or_number);
    }
  }
}

void CellGrid::fill_cells(const State& state, std::size_t part) {
  const std::size_t first = part_begin(part), last = part_begin(part + 1);
  std::uint32_t before = 0;
  for (std::size_t share = 0; parts_ > 1 && share < parts_; ++share) {
    for (std::size_t n = 0; n < part; ++n) {
      before += static_cast<std::uint32_t>(part_size(share, n));
    }
  }
  const std::uint32_t from = before;
  std::fill_n(next_.begin() + static_cast<std::ptrdiff_t>(first), last - first, 0);
  for_each_of_part(state, part, [&](auto, auto, auto cell) { ++next_[cell]; });
  for (std::size_t c = first; c < last; ++c) {
    begin_[c] = before;
    before += std::exchange(next_[c], before);
  }
  for_each_of_part(state, part, [&](std::uint32_t n, std::uint32_t id, std::uint32_t cell) {
    entries_[next_[cell]++] = {n, id};
  });
  const auto by_id = [](const Entry& a, const Entry& b) { return a.id < b.id; };
  for (std::size_t c = first; c < last; ++c) {
    const auto begin = entries_.begin() + begin_[c], end = entries_.begin() + next_[c];
    if (!std::is_sorted(begin, end, by_id)) std::sort(begin, end, by_id);
  }
  gather(state, from, before);
}

void CellGrid::assign(const State& state, std::size_t begin, std::size_t end) {
  const Eigen::Array3d scale = count_.cast<double>().array() / lengths_.array();
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Array3i cell = (state.position[i].array() * scale).cast<int>();
    // Rounding may lead out of the last cell.
    const Eigen::Array3i inside = cell.min(count_.array() - 1);
    cell_or_number_[i] = static_cast<std::uint32_t>(index(inside[0], inside[1], inside[2]));
  }
}

void CellGrid::gather(const State& state, std::size_t begin, std::size_t end) {
  for (std::size_t n = begin; n < end; ++n) {
    std::uint32_t& place = entries_[n].place;  // at first where it has been handed out
    const auto number = static_cast<std::uint32_t>(n);
    if (parts_ > 1) {
      HandedOut& from = handed_out_[place];
      place = from.place;
      from.cell_or_number = number;
    } else {
      cell_or_number_[place] = number;
    }
    if (!species_.empty()) species_[n] = state.species[place];
    const Vector& position = state.position[place];
    position_[n] = {position[0], position[1], position[2], 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rough_[axis][n] = static_cast<float>(position[static_cast<Eigen::Index>(axis)]);
    }
  }
}

}  // namespace driftless
