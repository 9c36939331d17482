#include "model/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace driftless {
namespace {

// Closer pairs have no direction; they are left out everywhere alike.
constexpr double smallest_distance = 1e-10;

}  // namespace

PairSearch::PairSearch(const Box& box, double range, std::size_t particles)
    : box_(box), range_(range) {
  if (box.lengths.minCoeff() < 2 * range) {
    std::ostringstream message;
    message << "the box's shortest side " << box.lengths.minCoeff()
            << " is below twice the range of the interaction " << range;
    throw std::invalid_argument(message.str());
  }
  // Cells of at least one range, but no more than a few per particle, however dilute the system.
  const double most = std::max(3.0, 2 * std::cbrt(static_cast<double>(particles)));
  for (int axis = 0; axis < 3; ++axis) {
    const double fit = range > 0 ? box.lengths[axis] / range : 1.0;
    cells_[axis] = static_cast<int>(std::min(fit, most));
  }
  use_cells_ = cells_.minCoeff() >= 3;
}

std::size_t PairSearch::cell_of(const Vector& position) const {
  Eigen::Vector3i cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = position[axis] / box_.lengths[axis] * cells_[axis];
    cell[axis] = std::clamp(static_cast<int>(x), 0, cells_[axis] - 1);
  }
  return (static_cast<std::size_t>(cell[2]) * cells_[1] + cell[1]) * cells_[0] + cell[0];
}

void PairSearch::sort_into_cells(const State& state) {
  const std::size_t cells = static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2];
  std::vector<std::uint32_t> cell(state.size());
  cell_begin_.assign(cells + 1, 0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    cell[i] = static_cast<std::uint32_t>(cell_of(state.position[i]));
    ++cell_begin_[cell[i] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) cell_begin_[c + 1] += cell_begin_[c];
  auto next = cell_begin_;
  entries_.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    entries_[next[cell[i]]++] = {state.position[i], state.id[i], static_cast<std::uint32_t>(i)};
  }
}

void PairSearch::visit_row(const State& state, std::uint32_t i, int row, int first, int last,
                           const Vector& shifted) {
  const std::size_t begin = cell_begin_[static_cast<std::size_t>(row) * cells_[0] + first];
  const std::size_t end = cell_begin_[static_cast<std::size_t>(row) * cells_[0] + last + 1];
  const double limit = range_ * range_;
  for (std::size_t k = begin; k < end; ++k) {
    const Entry& other = entries_[k];
    const Vector difference = shifted - other.position;
    const double squared = difference.squaredNorm();
    if (squared < limit && other.id > state.id[i]) {
      found_.push_back({i, other.place, difference, squared});
    }
  }
}

void PairSearch::neighbours(const State& state, std::uint32_t i) {
  const Vector& position = state.position[i];
  const auto cell = cell_of(position);
  const int x = static_cast<int>(cell % cells_[0]);
  const int y = static_cast<int>(cell / cells_[0] % cells_[1]);
  const int z = static_cast<int>(cell / cells_[0] / cells_[1]);
  // The image of i nearest to a neighbour cell beyond the edge is shifted by one box length.
  const auto wrapped = [&](int index, int axis, double& shift) {
    shift = index < 0 ? box_.lengths[axis] : index >= cells_[axis] ? -box_.lengths[axis] : 0.0;
    return (index + cells_[axis]) % cells_[axis];
  };
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      Vector shift = Vector::Zero();
      const int row = wrapped(z + dz, 2, shift[2]) * cells_[1] + wrapped(y + dy, 1, shift[1]);
      const int first = std::max(x - 1, 0), last = std::min(x + 1, cells_[0] - 1);
      visit_row(state, i, row, first, last, position + shift);
      if (x == 0 || x == cells_[0] - 1) {
        const int beyond = wrapped(x == 0 ? -1 : cells_[0], 0, shift[0]);
        visit_row(state, i, row, beyond, beyond, position + shift);
      }
    }
  }
}

const std::vector<PairSearch::Found>& PairSearch::find(const State& state) {
  found_.clear();
  if (range_ <= 0) return found_;
  if (use_cells_) sort_into_cells(state);
  std::vector<std::uint32_t> by_id(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) by_id[i] = static_cast<std::uint32_t>(i);
  const auto earlier = [&](auto a, auto b) { return state.id[a] < state.id[b]; };
  if (!std::is_sorted(by_id.begin(), by_id.end(), earlier)) {
    std::sort(by_id.begin(), by_id.end(), earlier);
  }
  for (const std::uint32_t i : by_id) {
    const auto begin = static_cast<std::ptrdiff_t>(found_.size());
    if (use_cells_) {
      neighbours(state, i);
    } else {
      for (std::uint32_t j = 0; j < state.size(); ++j) {
        if (state.id[j] <= state.id[i]) continue;
        const Vector difference = box_.minimum_image(state.position[i] - state.position[j]);
        const double squared = difference.squaredNorm();
        if (squared < range_ * range_) found_.push_back({i, j, difference, squared});
      }
    }
    std::sort(found_.begin() + begin, found_.end(),
              [&](const Found& a, const Found& b) { return state.id[a.j] < state.id[b.j]; });
  }
  return found_;
}

PairList::PairList(const Box& box, const Fluid& fluid, std::size_t particles)
    : search_(box, fluid.range(), particles) {}

void PairList::update(const State& state, const Fluid& fluid, std::uint64_t version) {
  if (version_ == version) return;
  version_ = version;
  drawn_ = false;
  geometry_.clear();
  for (const auto& found : search_.find(state)) {
    const double r = std::sqrt(found.squared_distance);
    if (r < smallest_distance) continue;
    geometry_.push_back({found.i, found.j, found.difference / r, r,
                         fluid.has_friction() ? fluid.friction_weight(r) : 0.0,
                         fluid.has_conduction() ? fluid.heat_weight(r) : 0.0});
  }
}

std::uint64_t PairList::draw(const State& state, const Fluid& fluid, const Noise& noise,
                             unsigned stage) {
  if (drawn_ && drawn_step_ == noise.step() && drawn_stage_ == stage) return 0;
  drawn_ = true;
  drawn_step_ = noise.step();
  drawn_stage_ = stage;
  normals_.assign(geometry_.size(), {0.0, 0.0});
  if (!fluid.fluctuates()) return 0;
  std::uint64_t numbers = 0;
  for (std::size_t pair = 0; pair < geometry_.size(); ++pair) {
    const auto& g = geometry_[pair];
    const bool friction = g.w_friction > 0, heat = g.w_heat > 0;
    if (!friction && !heat) continue;
    normals_[pair] = noise.pair_normals(state.id[g.i], state.id[g.j], stage, friction, heat);
    numbers += static_cast<std::uint64_t>(friction) + static_cast<std::uint64_t>(heat);
  }
  return numbers;
}

}  // namespace driftless
