#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/cell_grid.hpp"
#include "model/pair.hpp"
#include "model/threads.hpp"

namespace driftless {

/// A vector that grows takes twice the room; of what is kept for every pair that is too much.
template <class Value>
void resize_closely(std::vector<Value>& values, std::size_t size) {
  if (size > values.capacity()) values.reserve(size + size / 16);
  values.resize(size);
}

/// Pairs of particles by their numbers in the order of cells; id_i < id_j. Both arrays are readable
/// to the next multiple of the lanes.
struct PairIndices {
  std::vector<std::uint32_t> i, j;
  std::size_t size = 0;

  /// Makes room for `more` pairs beyond the present ones.
  void reserve(std::size_t more);
  /// Makes room for so many pairs and no more, and forgets the present ones.
  void resize(std::size_t pairs);
  void append(std::uint32_t of_i, std::uint32_t of_j);
  /// Fills what is readable beyond the last pair.
  void pad(std::uint32_t of_i, std::uint32_t of_j);
};

/// Groups of pairs that may be treated at once, as no particle is twice in a group; a group stands
/// for a place in the order of a sweep. The kind of group g is g modulo the number of kinds.
struct PairGroups {
  std::vector<std::uint32_t> order;  ///< group after group the places of their pairs in a list
  std::vector<std::uint32_t> end;    ///< of each group

  std::uint32_t begin_of(std::size_t group) const { return group > 0 ? end[group - 1] : 0; }
};

/// A list of pairs and their groups; good until pairs are found anew.
struct GroupedPairs {
  const PairIndices& pairs;
  const PairGroups& groups;
};

/// A part of all pairs, found and visited together.
struct PairBlock {
  struct Tile {
    Eigen::Vector3i from, to;  ///< cells [from, to)
  };
  std::vector<Tile> tiles;
  PairIndices found;  ///< kind after kind
  std::vector<std::uint32_t>
      kind_end;  ///< of each kind of pair: kind = i's species * species + j's
  PairGroups groups;
  bool grouped = false;
  /// What is kept of the pairs for several rounds (PairPass::work_in), none after find(), and of
  /// which step and stage the noise among it is.
  std::vector<double> kept;
  std::uint64_t kept_step = 0;
  unsigned kept_stage = 0;
};

/// All pairs within a range, in blocks of tiles of one colour: blocks of a colour may be treated at
/// once, and what comes out does not depend on how tiles are put together to blocks. A single cell
/// is one block, its pairs in the order of ids.
class PairBlocks {
 public:
  PairBlocks(const CellGrid& cells, double range, unsigned threads, std::size_t species = 1);

  /// Finds the pairs anew. Single precision decides: a pair beyond the range by up to the cells'
  /// margin may be among them.
  void find(const CellGrid& cells);
  /// The same in steps: begin_find(), then find_in() for every block, for several at once.
  void begin_find(const CellGrid& cells);
  void find_in(PairBlock& block, const CellGrid& cells) const;
  /// The blocks in such an order that who finds a share of them visits them later.
  std::size_t blocks() const { return blocks_.size(); }
  PairBlock& to_search(std::size_t n) { return blocks_[search_order_[n]]; }

  std::size_t pairs() const;
  /// How many blocks each colour has.
  std::span<const std::size_t> colours() const { return colours_; }
  PairBlock& block(std::size_t colour, std::size_t n) { return blocks_[first_[colour] + n]; }
  std::vector<PairBlock>& all() { return blocks_; }

  /// Puts a block's pairs into groups, once: each pair into the first group that has neither of its
  /// particles; in a single cell so that the order is that of ids. Blocks of one colour at once.
  GroupedPairs group(PairBlock& block, const CellGrid& cells);
  /// All pairs one after the other in the order of ids (i, then j): a group is of pairs that do not
  /// see each other's results.
  GroupedPairs by_ids(const CellGrid& cells);

 private:
  void add_blocks(const std::vector<PairBlock::Tile>& tiles, unsigned threads,
                  std::size_t particles);
  void order_search();

  void search_block(PairIndices& found, const PairBlock& block, const CellGrid& cells) const;
  void sort_by_kind(PairBlock& block, const CellGrid& cells) const;
  /// Makes of each group one for each kind.
  void split_by_kind(const PairIndices& pairs, const CellGrid& cells,
                     std::vector<std::uint32_t>& group, std::uint32_t& groups) const;

  double range_;
  std::size_t species_;
  bool single_;
  std::vector<PairBlock> blocks_;
  std::vector<std::size_t> colours_, first_;
  std::vector<std::size_t> search_order_;  ///< of the blocks
  std::vector<std::uint64_t> used_;        ///< groups of each particle, a bit each, of many
  PairIndices by_ids_;
  PairGroups groups_by_ids_;
  bool sorted_by_ids_ = false;
};

/// All pairs within a range of any state, for who looks from outside.
class PairSearch {
 public:
  struct Found {
    std::uint32_t i, j;  ///< places in storage, id[i] < id[j]
    Vector difference;   ///< minimum image of r_i - r_j
    double squared_distance;
  };

  /// `particles` bounds the number of cells. Throws std::invalid_argument if the box is shorter
  /// than twice the range.
  PairSearch(const Box& box, double range, std::size_t particles)
      : range_(range), cells_(box, range, particles), blocks_(cells_, range, 1) {}

  /// visit(const Found&) for every pair closer than the range.
  void find(const State& state, FunctionReference<void(const Found&)> visit);

 private:
  double range_;
  CellGrid cells_;
  PairBlocks blocks_;
};

}  // namespace driftless
