#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/state.hpp"
#include "model/threads.hpp"

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
/// cell, whose particles are in the order of ids.
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
  /// Particles of cell c are begin(c) to begin(c + 1), x fastest.
  std::uint32_t begin(std::size_t cell) const { return begin_[cell]; }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(x);
  }
  std::size_t particles() const { return particles_; }

  /// Sorts the particles anew.
  void sort(const State& state, const Threads& threads);
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
  /// The way back to storage: visit(place, number in the order of cells) for a share of the places,
  /// one thread's. Numbers jump, places less so: reading here and there costs less than writing.
  std::size_t shares() const { return parts_; }
  template <class Visit>
  void for_each_of_share(std::size_t share, Visit&& visit) const;
  double rough_margin() const { return 4e-7 * lengths_.maxCoeff(); }

 private:
  struct HandedOut {
    std::uint32_t id, place, cell_or_number;
  };

  void cut(double range);
  void assign(const State& state, std::size_t begin, std::size_t end);
  void gather(const State& state, std::size_t begin, std::size_t end);
  void cut_parts(std::size_t parts);
  /// Puts a share of the storage in the order of parts of the cells.
  void hand_out(const State& state, std::size_t share);
  /// Sorts the particles of a part of the cells.
  void fill_cells(const State& state, std::size_t part);
  template <class Visit>
  void for_each_of_part(const State& state, std::size_t part, Visit&& visit) const;
  std::size_t share_begin(std::size_t share) const { return particles_ * share / parts_; }
  std::size_t part_begin(std::size_t part) const { return next_.size() * part / parts_; }
  std::size_t part_of(std::uint32_t cell) const { return part_of_cell_[cell]; }
  std::size_t part_size(std::size_t share, std::size_t part) const;

  Box box_;
  Vector lengths_;
  std::size_t particles_;
  bool single_ = false;
  Eigen::Vector3i count_;
  std::vector<std::uint32_t> begin_, next_;
  std::size_t parts_ = 0;  ///< of storage and of cells, one for each thread
  std::vector<std::uint16_t> part_of_cell_;
  /// Each share of the storage in the order of parts; with one part storage stays as it is.
  std::vector<HandedOut> handed_out_;
  std::vector<std::uint32_t> part_end_;        ///< of each share's parts there
  std::vector<std::uint32_t> cell_or_number_;  ///< of each place in storage
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> species_;  ///< empty: all 0
  std::vector<Quadruple> position_;
  std::array<std::vector<float>, 3> rough_;
};

template <class Visit>
void CellGrid::for_each_of_share(std::size_t share, Visit&& visit) const {
  for (std::size_t n = share_begin(share); n < share_begin(share + 1); ++n) {
    if (parts_ > 1) {
      visit(handed_out_[n].place, handed_out_[n].cell_or_number);
    } else {
      visit(n, cell_or_number_[n]);
    }
  }
}

}  // namespace driftless
