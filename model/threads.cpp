#include "model/threads.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace driftless {

// A phase ends when its tasks have ended, not when every thread has come by: a thread that another
// program has pushed off its core keeps nobody waiting unless it is in the middle of a task.
struct Threads::Arena : tbb::task_arena {
  using tbb::task_arena::task_arena;

  /// body(thread, task) for every task.
  template <class Body>
  static void run(std::size_t tasks, const Body& body) {
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(
        Range(0, tasks, 1),
        [&](const Range& some) {
          const auto thread = static_cast<unsigned>(tbb::this_task_arena::current_thread_index());
          for (std::size_t task = some.begin(); task < some.end(); ++task) body(thread, task);
        },
        tbb::simple_partitioner());
  }
};

Threads::Threads(unsigned count) : count_(std::max(1U, count)) {
  if (count_ > 1) arena_ = std::make_shared<Arena>(static_cast<int>(count_));
}

void Threads::ranges(std::size_t size,
                     FunctionReference<void(std::size_t, std::size_t)> body) const {
  constexpr std::size_t worth_a_task = 500;
  const std::size_t tasks = std::min<std::size_t>(2 * count_, size / worth_a_task);
  if (count_ == 1 || tasks < 2) {
    if (size > 0) body(0, size);
    return;
  }
  arena_->execute([&] {
    Arena::run(tasks, [&](unsigned, std::size_t task) {
      body(size * task / tasks, size * (task + 1) / tasks);
    });
  });
}

void Threads::phases(std::span<const std::size_t> tasks,
                     FunctionReference<void(unsigned, std::size_t, std::size_t)> body) const {
  if (count_ == 1) {
    for (std::size_t phase = 0; phase < tasks.size(); ++phase) {
      for (std::size_t task = 0; task < tasks[phase]; ++task) body(0, phase, task);
    }
    return;
  }
  arena_->execute([&] {
    for (std::size_t phase = 0; phase < tasks.size(); ++phase) {
      Arena::run(tasks[phase],
                 [&](unsigned thread, std::size_t task) { body(thread, phase, task); });
    }
  });
}

}  // namespace driftless
