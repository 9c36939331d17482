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
  return cell_index(cell[0], cell[1], cell[2]);
}

void PairSearch::sort_into_cells(const State& state) {
  std::vector<std::uint32_t> cell(state.size());
  cell_begin_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    cell[i] = static_cast<std::uint32_t>(cell_of(state.position[i]));
    ++cell_begin_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < cell_begin_.size(); ++c) cell_begin_[c] += cell_begin_[c - 1];
  auto next = cell_begin_;
  cell_position_.resize(state.size());
  cell_place_.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto entry = next[cell[i]]++;
    cell_position_[entry] = state.position[i];
    cell_place_[entry] = static_cast<std::uint32_t>(i);
  }
}

void PairSearch::keep(const State& state, std::uint32_t a, std::uint32_t b,
                      const Vector& difference) {
  const double squared = difference.squaredNorm();
  if (state.id[a] < state.id[b]) {
    unsorted_.push_back({a, b, difference, squared});
  } else {
    unsorted_.push_back({b, a, -difference, squared});
  }
}

void PairSearch::gather(std::size_t begin, std::size_t end, const Vector& shift) {
  for (std::size_t entry = begin; entry < end; ++entry) {
    candidates_.x.push_back(cell_position_[entry][0] + shift[0]);
    candidates_.y.push_back(cell_position_[entry][1] + shift[1]);
    candidates_.z.push_back(cell_position_[entry][2] + shift[2]);
    candidates_.place.push_back(cell_place_[entry]);
  }
}

void PairSearch::gather_half_shell(const Eigen::Vector3i& cell) {
  for (auto* values : {&candidates_.x, &candidates_.y, &candidates_.z}) values->clear();
  candidates_.place.clear();
  // Every pair of cells once: the cell itself and the next one in x, then the four rows ahead in y
  // and z. A cell beyond an edge is seen at its shifted image.
  const int x = cell[0], last = cells_[0] - 1;
  const auto row = [&](int from, int to, int y, int z) {
    Vector shift(from < 0 ? -box_.lengths[0] : from > last ? box_.lengths[0] : 0, 0, 0);
    if (y < 0) shift[1] = -box_.lengths[1];
    if (y >= cells_[1]) shift[1] = box_.lengths[1];
    if (z >= cells_[2]) shift[2] = box_.lengths[2];
    const auto inside = [&](int index, int axis) { return (index + cells_[axis]) % cells_[axis]; };
    y = inside(y, 1);
    z = inside(z, 2);
    gather(cell_begin_[cell_index(inside(from, 0), y, z)],
           cell_begin_[cell_index(inside(to, 0), y, z) + 1], shift);
  };
  row(x, x, cell[1], cell[2]);
  row(x + 1, x + 1, cell[1], cell[2]);
  constexpr int ahead[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
  for (const auto& [dy, dz] : ahead) {
    const int y = cell[1] + dy, z = cell[2] + dz;
    row(std::max(x - 1, 0), std::min(x + 1, last), y, z);
    if (x == 0) row(-1, -1, y, z);
    if (x == last) row(last + 1, last + 1, y, z);
  }
}

void PairSearch::visit_candidates(const State& state, std::size_t first) {
  const auto& [x, y, z, place] = candidates_;
  const std::size_t count = place.size();
  const Vector position(x[first], y[first], z[first]);
  squared_.resize(count);
  within_.resize(count);
  for (std::size_t other = first + 1; other < count; ++other) {
    const double dx = position[0] - x[other], dy = position[1] - y[other],
                 dz = position[2] - z[other];
    squared_[other] = dx * dx + dy * dy + dz * dz;
  }
  // Most candidates fail and none predictably so: the filter has no branch.
  const double limit = range_ * range_;
  std::size_t kept = 0;
  for (std::size_t other = first + 1; other < count; ++other) {
    within_[kept] = static_cast<std::uint32_t>(other);
    kept += squared_[other] < limit ? 1 : 0;
  }
  for (std::size_t n = 0; n < kept; ++n) {
    const auto other = within_[n];
    keep(state, place[first], place[other], position - Vector(x[other], y[other], z[other]));
  }
}

void PairSearch::visit_cells(const State& state) {
  sort_into_cells(state);
  Eigen::Vector3i cell;
  for (cell[2] = 0; cell[2] < cells_[2]; ++cell[2]) {
    for (cell[1] = 0; cell[1] < cells_[1]; ++cell[1]) {
      for (cell[0] = 0; cell[0] < cells_[0]; ++cell[0]) {
        const auto index = cell_index(cell[0], cell[1], cell[2]);
        const std::size_t own = cell_begin_[index + 1] - cell_begin_[index];
        if (own == 0) continue;
        gather_half_shell(cell);
        for (std::size_t first = 0; first < own; ++first) visit_candidates(state, first);
      }
    }
  }
}

void PairSearch::visit_all(const State& state) {
  for (std::uint32_t i = 0; i < state.size(); ++i) {
    for (std::uint32_t j = i + 1; j < state.size(); ++j) {
      const Vector difference = box_.minimum_image(state.position[i] - state.position[j]);
      if (difference.squaredNorm() < range_ * range_) keep(state, i, j, difference);
    }
  }
}

void PairSearch::sort_by_ids(const State& state) {
  // rank of each place in the order of ids; the order of storage almost always
  std::vector<std::uint32_t> order(state.size()), rank(state.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto earlier = [&](auto a, auto b) { return state.id[a] < state.id[b]; };
  if (!std::is_sorted(order.begin(), order.end(), earlier)) {
    std::sort(order.begin(), order.end(), earlier);
  }
  for (std::uint32_t n = 0; n < order.size(); ++n) rank[order[n]] = n;
  std::vector<std::uint32_t> next(state.size() + 1, 0);
  for (const auto& pair : unsorted_) ++next[rank[pair.i] + 1];
  for (std::size_t n = 1; n < next.size(); ++n) next[n] += next[n - 1];
  const auto begin = next;
  found_.resize(unsorted_.size());
  for (const auto& pair : unsorted_) found_[next[rank[pair.i]]++] = pair;
  for (std::size_t n = 0; n + 1 < begin.size(); ++n) {
    // Insertion sort: a particle has a handful of partners.
    for (std::size_t m = begin[n]; m < begin[n + 1]; ++m) {
      const Found pair = found_[m];
      std::size_t place = m;
      for (; place > begin[n] && rank[found_[place - 1].j] > rank[pair.j]; --place) {
        found_[place] = found_[place - 1];
      }
      found_[place] = pair;
    }
  }
}

const std::vector<PairSearch::Found>& PairSearch::find(const State& state) {
  unsorted_.clear();
  if (range_ > 0) use_cells_ ? visit_cells(state) : visit_all(state);
  sort_by_ids(state);
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
