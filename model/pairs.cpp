#include "model/pairs.hpp"

#include <algorithm>
#include <numeric>

#include "model/lanes.hpp"

namespace driftless {
namespace {

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

std::size_t PairBlocks::pairs() const {
  std::size_t sum = 0;
  for (const auto& block : blocks_) sum += block.found.size;
  return sum;
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
