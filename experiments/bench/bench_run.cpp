#include "experiments/bench/bench_run.hpp"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <vector>

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

namespace {

PassSeconds difference(const PassSeconds& after, const PassSeconds& before) {
  return {after.search - before.search, after.noise - before.noise,
          after.arithmetic - before.arithmetic, after.scatter - before.scatter};
}

/// The stages of some steps, in seconds altogether.
StageSeconds look_at(BenchRun& run, std::size_t steps) {
  System& system = run.system();
  const PassSeconds before = system.pass_seconds();
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t n = 0; n < steps; ++n) run.advance();
  const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start;
  const PassSeconds passes = difference(system.pass_seconds(), before);
  const double known = passes.search + passes.noise + passes.arithmetic + passes.scatter;
  return {passes.search, passes.noise, passes.arithmetic, passes.scatter, total.count() - known};
}

}  // namespace

StageSeconds stages_of(BenchRun& run) {
  constexpr std::size_t enough = 100'000;   // particles moved, in one look
  constexpr std::size_t least = 2'000'000;  // and larger systems are looked at fewer times
  const std::size_t particles = run.system().size();
  const auto steps = std::clamp<std::size_t>(enough / particles, 1, 30);
  const auto looks = std::clamp<std::size_t>(least / (steps * particles), 2, 9);
  run.system().measure_passes();
  std::vector<StageSeconds> seen;
  for (std::size_t n = 0; n < looks; ++n) seen.push_back(look_at(run, steps));
  const auto calm = *std::min_element(
      seen.begin(), seen.end(),
      [](const StageSeconds& a, const StageSeconds& b) { return a.total() < b.total(); });
  const double per = 1 / static_cast<double>(steps * particles);
  return {per * calm.search, per * calm.noise, per * calm.arithmetic, per * calm.scatter,
          per * calm.integration};
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
