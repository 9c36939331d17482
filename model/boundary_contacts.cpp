#include "model/boundary_contacts.hpp"

namespace driftless {

void BoundaryContacts::list_groups(const Fluid& fluid, const Box& box) {
  groups_.clear();
  phases_.clear();
  first_.clear();
  if (!box.is_bounded()) return;
  // Opposite walls have no particle in common; every other two may have.
  for (std::size_t first = 0; first < boundaries; first += 2) {
    first_.push_back(groups_.size());
    for (std::size_t boundary = first; boundary < std::min(first + 2, boundaries); ++boundary) {
      for (std::size_t species = 0; species < fluid.species(); ++species) {
        const PairLaw* const law = fluid.boundary_law(boundary, species);
        if (!law) continue;
        for (std::size_t share = 0; share < shares; ++share) {
          groups_.push_back({{}, law, boundary, species, share});
        }
      }
    }
    phases_.push_back(groups_.size() - first_.back());
  }
}

void BoundaryContacts::find_in(Group& group, const CellGrid& cells) {
  const std::size_t particles = cells.particles(), share = group.share;
  const auto begin = static_cast<std::uint32_t>(particles * share / shares);
  const auto end = static_cast<std::uint32_t>(particles * (share + 1) / shares);
  const auto side = static_cast<std::uint32_t>(particles + group.boundary * shares + share);
  const bool field = group.boundary == field_place, upper = group.boundary % 2 == 1;
  const std::size_t axis = group.boundary / 2;
  const double length = field ? 0 : cells.box().lengths[static_cast<Eigen::Index>(axis)];
  const double range = group.law->range();
  group.contacts.size = 0;
  for (std::uint32_t n = begin; n < end; ++n) {
    if (cells.species(n) != group.species) continue;
    if (!field) {
      const Quadruple& at = cells.position()[n];
      const double x = axis == 0 ? at.x : axis == 1 ? at.y : at.z;
      if ((upper ? length - x : x) >= range) continue;
    }
    group.contacts.append(n, side);
  }
  group.contacts.pad(begin < end ? begin : 0, side);
}

std::size_t BoundaryContacts::contacts() const {
  std::size_t sum = 0;
  for (const auto& group : groups_) sum += group.contacts.size;
  return sum;
}

}  // namespace driftless
