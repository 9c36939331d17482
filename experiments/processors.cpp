#include "experiments/processors.hpp"

#include <sched.h>

#include <algorithm>
#include <thread>

namespace driftless {

unsigned usable_processors() {
  cpu_set_t allowed;
  // It fails on machines of more processors than the set can hold.
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) {
    return static_cast<unsigned>(std::max(1, CPU_COUNT(&allowed)));
  }
  return std::max(1U, std::thread::hardware_concurrency());
}

unsigned useful_threads(std::size_t particles) {
  constexpr std::size_t particles_a_thread = 750;
  const std::size_t worth = std::max<std::size_t>(1, particles / particles_a_thread);
  return static_cast<unsigned>(std::min<std::size_t>(usable_processors(), worth));
}

}  // namespace driftless
