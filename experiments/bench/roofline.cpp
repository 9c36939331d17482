#include "experiments/bench/roofline.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>

#include "model/cell_grid.hpp"
#include "model/threads.hpp"

namespace driftless {
namespace {

constexpr double number = sizeof(double), index = sizeof(std::uint32_t), vector = 3 * number,
                 quadruple = sizeof(Quadruple);
constexpr double halo = 43.0 / 8;
constexpr double pair = 2 * index;
constexpr double motion = vector + number;

// Once for each set of positions; model/cell_grid.cpp and model/pair_search.cpp.
constexpr Traffic sort = {"particles into cells",
                          vector +                 // positions
                              3 * index + index +  // cells written, read twice; ids
                              2 * number +         // entries read; grid's counters, about
                              quadruple +          // position by cells
                              3 * sizeof(float) +  // and in single precision
                              2 * index + vector,  // entries written; positions fetched
                          0};
constexpr Traffic search = {"pairs found", 3 * sizeof(float) + 2 * index, pair};

// Velocities and energies into the order of cells.
constexpr Traffic gather = {"motion by cells", 2 * index + quadruple + motion, 0};
// And sums, or motion, back.
constexpr Traffic scatter = {"results by particles", 2 * index + quadruple + 2 * motion, 0};
// A sum over pairs of what depends on positions alone: sums cleared, then read and written.
constexpr Traffic repulsion = {"pass over pairs: repulsion",
                               quadruple + halo*(quadruple + 2 * quadruple), pair};
constexpr Traffic exchange = {"pass over pairs: exchange",
                              quadruple + halo*(2 * quadruple + 2 * index + 2 * quadruple), pair};
// Pairs put into groups, an order of them, then visited; the particles' motion itself is changed.
constexpr Traffic groups = {"pairs into groups", halo * 2 * number, pair + index};
constexpr Traffic sweep = {"pass over pairs: sweep", halo*(quadruple + 2 * index + 2 * quadruple),
                           pair + index};

constexpr Traffic check = {"check of the motion", motion, 0};
constexpr Traffic move = {"move", 2 * vector + vector, 0};
constexpr Traffic apply = {"exchange applied", motion + 2 * motion, 0};
constexpr Traffic kick = {"kick", vector + 2 * vector, 0};

}  // namespace

std::vector<Traffic> step_traffic(const std::string& kernel) {
  if (kernel == "force-parallel") {
    return {sort, search, gather, exchange, scatter, check, move, apply, check};
  }
  if (kernel == "sequential") {
    return {sort, search, groups, gather,    sweep,   scatter, check,
            kick, check,  move,   repulsion, scatter, kick};
  }
  throw std::invalid_argument("no such kernel: " + kernel);
}

double bytes_per_step(const std::string& kernel, double pairs_per_particle) {
  double sum = 0;
  for (const auto& part : step_traffic(kernel)) {
    sum += part.in_order + part.per_pair * pairs_per_particle;
  }
  return sum;
}

std::size_t beyond_the_cache() {
  constexpr std::size_t least = std::size_t{128} << 20, most = std::size_t{1} << 30;
  std::size_t cache = 0;
#if defined(_SC_LEVEL3_CACHE_SIZE)
  const long found = sysconf(_SC_LEVEL3_CACHE_SIZE);
  if (found > 0) cache = static_cast<std::size_t>(found);
#endif
  return std::clamp(2 * cache, least, most);
}

double triad_bandwidth(std::size_t bytes, unsigned threads) {
  constexpr int passes = 5;
  constexpr double factor = 3;
  const std::size_t size = bytes / sizeof(double);
  const auto fresh = [&] { return std::make_unique<double[]>(size); };
  const auto a = fresh(), b = fresh(), c = fresh();
  const Threads workers(threads);
  workers.ranges(size, [&](std::size_t begin, std::size_t end) {
    std::fill(b.get() + begin, b.get() + end, 1.0);
    std::fill(c.get() + begin, c.get() + end, 2.0);
  });
  double best = 0;
  for (int pass = 0; pass < passes; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    workers.ranges(size, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) a[n] = b[n] + factor * c[n];
    });
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best = std::max(best, 3 * static_cast<double>(size * sizeof(double)) / elapsed.count());
  }
  if (size > 0 && a[size / 2] != 1.0 + factor * 2.0) throw std::logic_error("the triad is wrong");
  return best;
}

}  // namespace driftless
