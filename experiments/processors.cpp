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

}  // namespace driftless
