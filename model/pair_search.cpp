#include <algorithm>
#include <array>

#include "model/lanes.hpp"
#include "model/pairs.hpp"
#include "model/picked_lanes.hpp"

// How pairs are found among the cells.
namespace driftless {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;

/// Particles side by side in the order of cells that may be near those of a cell, and the shift to
/// the image at which the cell sees them.
struct Segment {
  std::uint32_t begin, end;
  float shift[3];
};

/// The segments that meet every pair of cells once: a cell itself and the next one in x, then the
/// four rows ahead in y and z. Along a thin axis there is no other cell.
class Neighbours {
 public:
  Neighbours(const CellGrid& cells, int x, int y, int z) : cells_(cells), x_(x) {
    add_row(x, y, z);
    if (!cells.thin(1)) add_row(x - 1, y + 1, z);
    if (cells.thin(2)) return;
    if (!cells.thin(1)) add_row(x - 1, y - 1, z + 1);
    add_row(x - 1, y, z + 1);
    if (!cells.thin(1)) add_row(x - 1, y + 1, z + 1);
  }
  std::span<Segment> segments() { return {segments_, count_}; }
  std::size_t particles() const {
    std::size_t sum = 0;
    for (std::size_t n = 0; n < count_; ++n) sum += segments_[n].end - segments_[n].begin;
    return sum;
  }

 private:
  /// The cells from `from` to x + 1 of a row, which may lie beyond the edges.
  void add_row(int from, int y, int z) {
    const auto& count = cells_.count();
    const Vector& length = cells_.lengths();
    const int last = count[0] - 1;
    float shift_y = 0, shift_z = 0;
    if (y < 0) y += count[1], shift_y = -static_cast<float>(length[1]);
    if (y >= count[1]) y -= count[1], shift_y = static_cast<float>(length[1]);
    if (z >= count[2]) z -= count[2], shift_z = static_cast<float>(length[2]);
    const auto row = cells_.index(0, y, z);
    const auto add = [&](int first, int end, float shift_x) {
      segments_[count_++] = {cells_.begin(row + static_cast<std::size_t>(first)),
                             cells_.begin(row + static_cast<std::size_t>(end)),
                             {shift_x, shift_y, shift_z}};
    };
    add(std::max(from, 0), std::min(x_ + 1, last) + 1, 0);
    if (cells_.thin(0)) return;
    if (from < 0) add(last, last + 1, -static_cast<float>(length[0]));
    if (x_ == last) add(0, 1, static_cast<float>(length[0]));
  }

  const CellGrid& cells_;
  int x_;
  Segment segments_[15];
  std::size_t count_ = 0;
};

/// As many particles side by side as there are lanes of single precision.
struct Candidates {
  std::array<hn::Vec<Floats>, 3> position;
  hn::Vec<Indices> number;
  hn::Mask<Floats> counted;

  Candidates(const CellGrid& cells, std::uint32_t first, std::uint32_t end)
      : number(counting_from(first)), counted(hn::FirstN(Floats(), end - first)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = hn::LoadU(Floats(), cells.rough_position()[axis].data() + first);
    }
  }
};

/// Where found pairs are written; its own copy of what PairIndices knows, which a compiler may keep
/// in registers.
struct Writer {
  std::uint32_t *i, *j;
  std::size_t size;

  explicit Writer(PairIndices& found) : i(found.i.data()), j(found.j.data()), size(found.size) {}
};

/// The sides of which differences are brought to the nearest image.
struct Images {
  std::array<float, 3> length, inverse;  ///< 0 for the other sides

  explicit Images(const CellGrid& cells) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<std::size_t>(axis);
      length[n] = static_cast<float>(cells.lengths()[axis]);
      inverse[n] = cells.thin(axis) ? 1 / length[n] : 0;
    }
  }
};

/// Writes the pairs of particle i with those candidates that are nearer than the root of `limit` to
/// a point, its image. There is room for a whole vector of them. `wrap` finds the nearest image
/// where there are any.
template <bool wrap>
HWY_INLINE void add_near(Writer& found, const Images& images, std::uint32_t i,
                         const Candidates& candidates, const std::array<float, 3>& point,
                         hn::Mask<Floats> counted, float limit) {
  const Floats floats;
  const Indices indices;
  auto squared = hn::Zero(floats);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto difference = hn::Sub(candidates.position[axis], hn::Set(floats, point[axis]));
    if constexpr (wrap) {
      const auto sides = hn::Round(hn::Mul(difference, hn::Set(floats, images.inverse[axis])));
      difference = hn::NegMulAdd(sides, hn::Set(floats, images.length[axis]), difference);
    }
    squared = hn::MulAdd(difference, difference, squared);
  }
  const auto near =
      hn::RebindMask(indices, hn::And(hn::Lt(squared, hn::Set(floats, limit)), counted));
  hn::StoreU(hn::Set(indices, i), indices, found.i + found.size);
  found.size += store_picked(candidates.number, near, found.j + found.size);
}

template <bool wrap>
void search_cell(PairIndices& all, const CellGrid& cells, int x, int y, int z, float limit) {
  const auto cell = cells.index(x, y, z);
  const auto begin = cells.begin(cell), end = cells.begin(cell + 1);
  if (begin == end) return;
  const float* const position[3] = {cells.rough_position()[0].data(),
                                    cells.rough_position()[1].data(),
                                    cells.rough_position()[2].data()};
  const Images images(cells);
  Neighbours neighbours(cells, x, y, z);
  const auto segments = neighbours.segments();
  all.reserve((end - begin) * neighbours.particles());
  Writer found(all);
  for (const auto& segment : segments) {
    const bool own = &segment == &segments[0];
    for (auto first = segment.begin; first < segment.end; first += hn::Lanes(Floats())) {
      const Candidates candidates(cells, first, segment.end);
      for (auto i = begin; i < end; ++i) {
        const std::array<float, 3> point = {position[0][i] - segment.shift[0],
                                            position[1][i] - segment.shift[1],
                                            position[2][i] - segment.shift[2]};
        auto counted = candidates.counted;
        if (own) {
          const auto later = hn::Gt(candidates.number, hn::Set(Indices(), i));
          counted = hn::And(counted, hn::RebindMask(Floats(), later));
        }
        add_near<wrap>(found, images, i, candidates, point, counted, limit);
      }
    }
  }
  all.size = found.size;
}

void search_all(PairIndices& all, const CellGrid& cells, float limit) {
  const auto particles = static_cast<std::uint32_t>(cells.particles());
  const auto& position = cells.rough_position();
  const Images images(cells);
  for (std::uint32_t i = 0; i < particles; ++i) {
    all.reserve(particles);
    Writer found(all);
    for (auto first = i + 1; first < particles; first += hn::Lanes(Floats())) {
      const Candidates candidates(cells, first, particles);
      add_near<true>(found, images, i, candidates, {position[0][i], position[1][i], position[2][i]},
                     candidates.counted, limit);
    }
    all.size = found.size;
  }
}

/// Makes i the one of the smaller id.
void order_by_ids(const PairIndices& found, PairIndices& ordered, const CellGrid& cells) {
  const Indices indices;
  const hn::RebindToSigned<Indices> numbers;
  static_assert(sizeof(CellGrid::Entry) == 2 * sizeof(std::uint32_t));
  const std::uint32_t* const base = &cells.entries().data()->id;
  const auto id_of = [&](auto particle) {
    const auto twice = hn::BitCast(numbers, hn::Add(particle, particle));
    return hn::BitCast(indices, hn::GatherIndex(indices, base, twice));
  };
  for (std::size_t n = 0; n < found.size; n += hn::Lanes(indices)) {
    const auto i = hn::LoadU(indices, found.i.data() + n),
               j = hn::LoadU(indices, found.j.data() + n);
    const auto swap = hn::Gt(id_of(i), id_of(j));
    hn::StoreU(hn::IfThenElse(swap, j, i), indices, ordered.i.data() + n);
    hn::StoreU(hn::IfThenElse(swap, i, j), indices, ordered.j.data() + n);
  }
}

/// What is beyond the last pair is a particle with itself.
void pad(PairIndices& pairs) {
  // One of this block: another may be at work on any other particle.
  const std::uint32_t own = pairs.size > 0 ? pairs.i[pairs.size - 1] : 0;
  pairs.pad(own, own);
}

}  // namespace

void PairBlocks::find_in(PairBlock& block, const CellGrid& cells) const {
  block.grouped = false;
  block.kept.clear();
  // Found in a place with room for all candidates, kept in one as large as what is found.
  thread_local PairIndices found;
  search_block(found, block, cells);
  pad(found);
  block.found.resize(found.size);
  if (cells.single()) {
    std::copy_n(found.i.begin(), found.size, block.found.i.begin());
    std::copy_n(found.j.begin(), found.size, block.found.j.begin());
  } else {
    order_by_ids(found, block.found, cells);
  }
  pad(block.found);
  sort_by_kind(block, cells);
}

void PairBlocks::search_block(PairIndices& found, const PairBlock& block,
                              const CellGrid& cells) const {
  found.size = 0;
  const double reach = range_ + cells.rough_margin();
  const auto limit = static_cast<float>(reach * reach);
  if (range_ == 0) return;
  if (cells.single()) return search_all(found, cells, limit);
  const bool thin = cells.count().minCoeff() == 1;
  const auto search = thin ? search_cell<true> : search_cell<false>;
  for (const auto& [from, to] : block.tiles) {
    for (int z = from[2]; z < to[2]; ++z) {
      for (int y = from[1]; y < to[1]; ++y) {
        for (int x = from[0]; x < to[0]; ++x) search(found, cells, x, y, z, limit);
      }
    }
  }
}

}  // namespace driftless
