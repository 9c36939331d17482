#include <algorithm>
#include <bit>

#include "model/pairs.hpp"

// How pairs are put into groups that may be treated at once.
namespace driftless {
namespace {

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

}  // namespace

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

}  // namespace driftless
