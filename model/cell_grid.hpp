#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "model/state.hpp"

namespace driftless {

/// A particle's position, or its velocity and internal energy, or what it receives of momentum and
/// energy.
struct alignas(32) Quadruple {
  double x = 0, y = 0, z = 0, energy = 0;

  Quadruple& operator+=(const Quadruple& other) {
    x += other.x, y += other.y, z += other.z, energy += other.energy;
    return *this;
  }
};

/// A box cut into cells of at least the range of the interaction, and its particles in their order:
/// cell after cell, by ids within a cell. A box of less than four ranges along every side is one
/// cell, whose particles are in the order of ids. The cells are cut into tiles in turn, the work of
/// one thread at a time: two tiles are of one colour if they stand at places alike, even or odd,
/// along every axis, and share no particle then, neighbours included.
class CellGrid {
 public:
  /// Throws std::invalid_argument if the box is shorter than twice the range.
  CellGrid(const Box& box, double range, std::size_t particles);

  bool single() const { return single_; }
  const Eigen::Vector3i& count() const { return count_; }
  /// Whether particles see each other along an axis at any distance, by the nearest image, as it
  /// has one cell: beside it on both sides would be itself.
  bool thin(int axis) const { return count_[axis] == 1; }
  const Box& box() const { return box_; }
  /// The box's sides, longer by the range where walls stand: images are then never near.
  const Vector& lengths() const { return lengths_; }
  /// How many tiles along each axis: one, or an even number. Tile t begins with cell_of(axis, t).
  const Eigen::Vector3i& tiles() const { return tiles_; }
  /// How many there are of a colour.
  unsigned tiles_at_once() const {
    return static_cast<unsigned>(((tiles_.array() + 1) / 2).prod());
  }
  int cell_of(int axis, int tile) const { return tile * count_[axis] / tiles_[axis]; }
  /// Particles of cell c are begin(c) to begin(c + 1); along x cells follow each other.
  std::uint32_t begin(std::size_t cell) const { return begin_[cell]; }
  std::size_t index(int x, int y, int z) const {
    return row_[row(y, z)] + static_cast<std::size_t>(x);
  }
  std::size_t particles() const { return particles_; }
  /// Whether what is kept for each particle stays in a core's cache, in any order.
  bool few() const { return particles_ < 10000; }

  /// Sorts the particles anew.
  void sort(const State& state);
  /// The same in steps: begin_sort(), then assign() for every share of the storage, then fill() for
  /// every part of the cells; shares, and parts, may be treated at once. fill() returns which
  /// particles in the order of cells it has put there, from first to below second.
  void begin_sort(const State& state);
  void assign(const State& state, std::size_t share, std::size_t shares);
  std::pair<std::size_t, std::size_t> fill(const State& state, std::size_t part, std::size_t parts);
  /// Takes the storage as having been brought into the order of cells.
  void follow_storage();

  /// The particles in the order of cells; single precision carries `margin` more than the range.
  struct Entry {
    std::uint32_t place, id;  ///< place in the state's storage
  };
  const std::vector<Entry>& entries() const { return entries_; }
  std::uint32_t place(std::size_t n) const { return entries_[n].place; }
  std::uint32_t id(std::size_t n) const { return entries_[n].id; }
  std::uint8_t species(std::size_t n) const { return species_.empty() ? 0 : species_[n]; }
  const std::vector<Quadruple>& position() const { return position_; }
  const std::array<std::vector<float>, 3>& rough_position() const { return rough_; }
  /// The way back: the number in the order of cells of what lies at a place in storage.
  std::uint32_t number(std::size_t place) const { return number_[place]; }
  double rough_margin() const { return 4e-7 * lengths_.maxCoeff(); }

 private:
  void cut(double range);
  void cut_tiles();
  void order_rows();
  std::size_t row(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) +
           static_cast<std::size_t>(y);
  }
  void gather(const State& state, std::size_t begin, std::size_t end);

  Box box_;
  Vector lengths_;
  std::size_t particles_;
  bool single_ = false;
  Eigen::Vector3i count_, tiles_;
  std::vector<std::size_t> row_;  ///< first cell of each row along x
  std::vector<std::uint32_t> begin_, next_;
  std::vector<std::uint32_t> cell_, number_;  ///< of each place in storage
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> species_;  ///< empty: all 0
  std::vector<Quadruple> position_;
  std::array<std::vector<float>, 3> rough_;
};

}  // namespace driftless
