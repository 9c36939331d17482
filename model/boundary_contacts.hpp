#pragma once

#include <array>
#include <vector>

#include "model/cell_grid.hpp"
#include "model/fluid.hpp"
#include "model/pairs.hpp"
#include "model/state.hpp"

namespace driftless {

/// The particles near walls, and all in a field, as pairs (particle, wall): what kernels make of a
/// pair they make of a contact. The wall's side has numbers beyond the last particle's, a few for
/// each boundary, so that threads may share its particles; sums of these numbers are what the
/// boundary receives.
class BoundaryContacts {
 public:
  static constexpr std::size_t boundaries = 7;  ///< six walls and the field
  static constexpr std::size_t shares = 8;      ///< of each boundary's particles
  /// Numbers beyond the last particle's that stand for walls.
  static constexpr std::size_t numbers = boundaries * shares;
  /// Which boundary such a number belongs to.
  static std::size_t boundary(std::size_t number) { return number / shares; }
  /// What noise knows a boundary by; no particle has it.
  static std::uint32_t id(std::size_t boundary) {
    return 0xffffffffU - static_cast<std::uint32_t>(boundary);
  }

  /// Contacts of one species in a share of the particles, none twice among them.
  struct Group {
    PairIndices contacts;
    const PairLaw* law = nullptr;
    std::size_t boundary = 0, species = 0, share = 0;
  };

  /// Finds the contacts anew in steps: begin_find(), then find_in() for every group, for several at
  /// once. The fluid (Fluid::within) must live as long as they are used.
  void begin_find(const Fluid& fluid, const Box& box) {
    if (groups_.empty()) list_groups(fluid, box);
  }
  static void find_in(Group& group, const CellGrid& cells);

  bool any() const { return !groups_.empty(); }
  /// How many groups each phase has: those of a phase may be treated at once, phase after phase.
  std::span<const std::size_t> phases() const { return phases_; }
  Group& group(std::size_t phase, std::size_t task) { return groups_[first_[phase] + task]; }
  std::vector<Group>& all() { return groups_; }
  std::size_t contacts() const;

 private:
  void list_groups(const Fluid& fluid, const Box& box);

  std::vector<Group> groups_;
  std::vector<std::size_t> phases_, first_;
};

}  // namespace driftless
