#include "model/threads.hpp"

#include <omp.h>

namespace driftless {

void Threads::ranges(std::size_t size,
                     FunctionReference<void(std::size_t, std::size_t)> body) const {
  constexpr std::size_t worth_a_thread = 500;
  if (count_ == 1 || size < 2 * worth_a_thread) {
    if (size > 0) body(0, size);
    return;
  }
#pragma omp parallel num_threads(static_cast <int>(count_))
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto team = static_cast<std::size_t>(omp_get_num_threads());
    const std::size_t begin = size * thread / team, end = size * (thread + 1) / team;
    if (begin < end) body(begin, end);
  }
}

void Threads::phases(std::span<const std::size_t> tasks,
                     FunctionReference<void(unsigned, std::size_t, std::size_t)> body) const {
  if (count_ == 1) {
    for (std::size_t phase = 0; phase < tasks.size(); ++phase) {
      for (std::size_t task = 0; task < tasks[phase]; ++task) body(0, phase, task);
    }
    return;
  }
#pragma omp parallel num_threads(static_cast <int>(count_))
  {
    const auto thread = static_cast<unsigned>(omp_get_thread_num());
    for (std::size_t phase = 0; phase < tasks.size(); ++phase) {
      const std::size_t count = tasks[phase];
#pragma omp for schedule(dynamic, 1)
      for (std::size_t task = 0; task < count; ++task) body(thread, phase, task);
    }
  }
}

}  // namespace driftless
