#include "experiments/bench/bench_run.hpp"

#include <malloc.h>

#include <algorithm>
#include <chrono>

namespace driftless {
namespace {

/// Bytes that the program has allocated now; none if the C library does not count them.
std::optional<std::size_t> allocated_bytes() {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return {};
#endif
}

/// Position, velocity, internal energy, id.
constexpr std::size_t state_bytes = 2 * sizeof(Vector) + sizeof(double) + sizeof(std::uint32_t);

}  // namespace

StageSeconds stages_of(BenchRun& run) {
  constexpr std::size_t enough = 2'000'000;  // visits of a particle
  System& system = run.system();
  const auto steps = std::clamp<std::size_t>(enough / system.size(), 2, 20);
  system.measure_passes();
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t n = 0; n < steps; ++n) run.advance();
  const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start;
  const PassSeconds passes = system.pass_seconds();
  const double per = 1 / static_cast<double>(steps * system.size());
  const double known = passes.search + passes.noise + passes.arithmetic + passes.scatter;
  return {per * passes.search, per * passes.noise, per * passes.arithmetic, per * passes.scatter,
          per * (total.count() - known)};
}

std::optional<double> bytes_per_particle(std::unique_ptr<BenchRun>& run) {
  const std::size_t particles = run->system().size();
  const auto before = allocated_bytes();
  run.reset();
  const auto after = allocated_bytes();
  // Less than the State itself: another allocator has taken over.
  if (!before || !after || *before < *after + state_bytes * particles) return {};
  return static_cast<double>(*before - *after) / static_cast<double>(particles) -
         static_cast<double>(state_bytes);
}

}  // namespace driftless
