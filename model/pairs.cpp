#include "model/pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "model/lanes.hpp"
#include "model/picked_lanes.hpp"

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

/// The number of a pair's kind among those of so many species.
std::uint32_t kind_of(const PairIndices& pairs, std::size_t n, const CellGrid& cells,
                      std::size_t species) {
  return static_cast<std::uint32_t>(cells.species(pairs.i[n]) * species +
                                    cells.species(pairs.j[n]));
}

/// Puts the pairs of each group side by side.
void sort_by_group(const std::vector<std::uint32_t>& group, std::uint32_t groups,
                   PairGroups& sorted) {
  sorted.end.assign(groups + 1, 0);
  for (const auto g : group) ++sorted.end[g + 1];
  for (std::uint32_t g = 0; g < groups; ++g) sorted.end[g + 1] += sorted.end[g];
  resize_closely(sorted.order, group.size());
  for (std::uint32_t n = 0; n < group.size(); ++n) sorted.order[sorted.end[group[n]]++] = n;
  sorted.end.pop_back();
}

/// Each pair's group, the first in which neither of its particles is; `used` has a bit for each
/// group of a particle. Returns the number of groups.
std::uint32_t groups_of_few(const PairIndices& found, std::vector<std::uint64_t>& used,
                            std::vector<std::uint32_t>& group) {
  group.resize(found.size);
  for (std::size_t n = 0; n < found.size; ++n) used[found.i[n]] = used[found.j[n]] = 0;
  std::uint32_t groups = 0;
  std::uint32_t crowded = 64;  // pairs for which all groups are taken are each a group
  for (std::size_t n = 0; n < found.size; ++n) {
    auto &of_i = used[found.i[n]], &of_j = used[found.j[n]];
    const auto taken = of_i | of_j;
    const auto free = static_cast<std::uint32_t>(std::countr_one(taken));
    group[n] = free < 64 ? free : crowded++;
    groups = std::max(groups, group[n] + 1);
    if (free == 64) continue;
    of_i |= std::uint64_t{1} << free;
    of_j |= std::uint64_t{1} << free;
  }
  return groups;
}

/// Each pair's group, the one after those of its particles so far: group after group is then the
/// same as pair after pair. Returns the number of groups.
std::uint32_t groups_in_order(const PairIndices& found, std::vector<std::uint64_t>& last,
                              std::vector<std::uint32_t>& group) {
  group.resize(found.size);
  for (std::size_t n = 0; n < found.size; ++n) last[found.i[n]] = last[found.j[n]] = 0;
  std::uint32_t groups = 0;
  for (std::size_t n = 0; n < found.size; ++n) {
    auto &of_i = last[found.i[n]], &of_j = last[found.j[n]];
    group[n] = static_cast<std::uint32_t>(std::max(of_i, of_j));
    of_i = of_j = group[n] + 1;
    groups = std::max(groups, group[n] + 1);
  }
  return groups;
}

constexpr std::size_t particles_a_block = 500;  // so that a block's arrays stay in the cache

}  // namespace

void PairIndices::reserve(std::size_t more) {
  const std::size_t needed = size + more + 2 * Lanes::count();
  if (needed <= j.size()) return;
  i.resize(needed);
  j.resize(needed);
}

void PairIndices::resize(std::size_t pairs) {
  resize_closely(i, pairs + 2 * Lanes::count());
  resize_closely(j, pairs + 2 * Lanes::count());
  size = pairs;
}

void PairIndices::append(std::uint32_t of_i, std::uint32_t of_j) {
  if (size >= j.size()) reserve(size + 1);
  i[size] = of_i;
  j[size++] = of_j;
}

void PairIndices::pad(std::uint32_t of_i, std::uint32_t of_j) {
  reserve(0);
  const auto end = static_cast<std::ptrdiff_t>(size);
  std::fill_n(i.begin() + end, 2 * Lanes::count(), of_i);
  std::fill_n(j.begin() + end, 2 * Lanes::count(), of_j);
}

PairBlocks::PairBlocks(const CellGrid& cells, double range, unsigned threads, std::size_t species)
    : range_(range), species_(species), single_(cells.single()) {
  const Eigen::Vector3i& tiles = cells.tiles();
  const auto all = static_cast<std::size_t>(tiles.prod());
  for (int colour = 0; colour < 8; ++colour) {
    const Eigen::Vector3i parity(colour & 1, colour >> 1 & 1, colour >> 2 & 1);
    std::vector<PairBlock::Tile> alike;
    for (int z = parity[2]; z < tiles[2]; z += 2) {
      for (int y = parity[1]; y < tiles[1]; y += 2) {
        for (int x = parity[0]; x < tiles[0]; x += 2) {
          alike.push_back(
              {{cells.cell_of(0, x), cells.cell_of(1, y), cells.cell_of(2, z)},
               {cells.cell_of(0, x + 1), cells.cell_of(1, y + 1), cells.cell_of(2, z + 1)}});
        }
      }
    }
    if (alike.empty()) continue;
    add_blocks(alike, threads, cells.particles() * alike.size() / all);
  }
  order_search();
}

// So many that a block's arrays stay in the cache, and that threads have a few each, all alike.
void PairBlocks::add_blocks(const std::vector<PairBlock::Tile>& tiles, unsigned threads,
                            std::size_t particles) {
  const std::size_t for_cache = particles / particles_a_block + 1;
  const std::size_t a_thread =
      threads > 1 ? std::max<std::size_t>(4, for_cache / threads) : for_cache;
  const std::size_t blocks = std::min(tiles.size(), threads * a_thread);
  first_.push_back(blocks_.size());
  colours_.push_back(blocks);
  const auto tile = [&](std::size_t block) {
    return tiles.begin() + static_cast<std::ptrdiff_t>(tiles.size() * block / blocks);
  };
  for (std::size_t n = 0; n < blocks; ++n)
    blocks_.emplace_back().tiles.assign(tile(n), tile(n + 1));
}

// So that a thread finds the pairs of those blocks that it visits later, colour by colour.
void PairBlocks::order_search() {
  std::vector<double> place(blocks_.size());  // in the colour, which threads share in this order
  for (std::size_t colour = 0; colour < colours_.size(); ++colour) {
    const auto count = static_cast<double>(colours_[colour]);
    for (std::size_t n = 0; n < colours_[colour]; ++n) {
      place[first_[colour] + n] = (static_cast<double>(n) + 0.5) / count;
    }
  }
  search_order_.resize(blocks_.size());
  std::iota(search_order_.begin(), search_order_.end(), std::size_t{0});
  std::stable_sort(search_order_.begin(), search_order_.end(),
                   [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
}

void PairBlocks::begin_find(const CellGrid& cells) {
  used_.resize(cells.few() ? 0 : cells.particles());
  sorted_by_ids_ = false;
}

void PairBlocks::find(const CellGrid& cells) {
  begin_find(cells);
  for (auto& block : blocks_) find_in(block, cells);
}

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

void PairBlocks::sort_by_kind(PairBlock& block, const CellGrid& cells) const {
  const auto kinds = static_cast<std::uint32_t>(species_ * species_);
  if (kinds == 1) {
    block.kind_end.assign(1, static_cast<std::uint32_t>(block.found.size));
    return;
  }
  thread_local std::vector<std::uint32_t> kind;
  kind.resize(block.found.size);
  for (std::size_t n = 0; n < kind.size(); ++n) kind[n] = kind_of(block.found, n, cells, species_);
  thread_local PairGroups sorted;
  sort_by_group(kind, kinds, sorted);
  thread_local PairIndices before;
  before = block.found;
  for (std::size_t n = 0; n < before.size; ++n) {
    block.found.i[n] = before.i[sorted.order[n]];
    block.found.j[n] = before.j[sorted.order[n]];
  }
  block.kind_end = sorted.end;
}

std::size_t PairBlocks::pairs() const {
  std::size_t sum = 0;
  for (const auto& block : blocks_) sum += block.found.size;
  return sum;
}

void PairBlocks::split_by_kind(const PairIndices& pairs, const CellGrid& cells,
                               std::vector<std::uint32_t>& group, std::uint32_t& groups) const {
  const auto kinds = static_cast<std::uint32_t>(species_ * species_);
  if (kinds == 1) return;
  for (std::size_t n = 0; n < pairs.size; ++n) {
    group[n] = group[n] * kinds + kind_of(pairs, n, cells, species_);
  }
  groups *= kinds;
}

GroupedPairs PairBlocks::group(PairBlock& block, const CellGrid& cells) {
  // What was found has been sorted by kind.
  if (single_ && species_ > 1) return by_ids(cells);
  if (!block.grouped) {
    // Threads hold each other up where they write side by side, as they do wherever tiles of few
    // particles meet.
    thread_local std::vector<std::uint64_t> own;
    if (cells.few()) own.resize(cells.particles());
    auto& used = cells.few() ? own : used_;
    thread_local std::vector<std::uint32_t> group;
    auto groups = single_ ? groups_in_order(block.found, used, group)
                          : groups_of_few(block.found, used, group);
    split_by_kind(block.found, cells, group, groups);
    sort_by_group(group, groups, block.groups);
    block.grouped = true;
  }
  return {block.found, block.groups};
}

GroupedPairs PairBlocks::by_ids(const CellGrid& cells) {
  if (sorted_by_ids_) return {by_ids_, groups_by_ids_};
  sorted_by_ids_ = true;
  struct Pair {
    std::uint64_t ids;
    std::uint32_t i, j;
  };
  std::vector<Pair> all;
  for (const auto& block : blocks_) {
    for (std::size_t n = 0; n < block.found.size; ++n) {
      const auto i = block.found.i[n], j = block.found.j[n];
      all.push_back({std::uint64_t{cells.id(i)} << 32 | cells.id(j), i, j});
    }
  }
  std::sort(all.begin(), all.end(), [](const Pair& a, const Pair& b) { return a.ids < b.ids; });
  by_ids_.size = 0;
  by_ids_.reserve(all.size());
  for (const auto& pair : all) by_ids_.append(pair.i, pair.j);
  std::vector<std::uint64_t> used(cells.particles());
  std::vector<std::uint32_t> group;
  auto groups = groups_in_order(by_ids_, used, group);
  split_by_kind(by_ids_, cells, group, groups);
  sort_by_group(group, groups, groups_by_ids_);
  return {by_ids_, groups_by_ids_};
}

void PairSearch::find(const State& state, FunctionReference<void(const Found&)> visit) {
  cells_.sort(state);
  blocks_.find(cells_);
  for (const auto& block : blocks_.all()) {
    for (std::size_t n = 0; n < block.found.size; ++n) {
      const auto i = cells_.place(block.found.i[n]), j = cells_.place(block.found.j[n]);
      const Vector difference = cells_.box().minimum_image(state.position[i] - state.position[j]);
      const double squared = difference.squaredNorm();
      if (squared < range_ * range_) visit({i, j, difference, squared});
    }
  }
}

}  // namespace driftless
