#include "model/threads.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <thread>
#include <vector>

namespace driftless {

namespace {

/// The tasks of a phase that are one thread's to begin with: what it works on stays in the cache of
/// its core, from phase to phase and from step to step.
struct alignas(64) Share {
  std::atomic<std::size_t> next = 0;
  std::size_t end = 0;
};

/// A phase of tasks at work.
struct Phase {
  std::vector<Share> shares;
  std::atomic<std::size_t> done = 0;

  Phase(std::size_t tasks, unsigned threads) : shares(threads) {
    for (unsigned n = 0; n < threads; ++n) {
      shares[n].next = tasks * n / threads;
      shares[n].end = tasks * (n + 1) / threads;
    }
  }
  /// run(task) for the tasks of a thread and then for those that others have not come to.
  template <class Run>
  void work(unsigned thread, Run&& run) {
    for (std::size_t n = 0; n < shares.size(); ++n) {
      Share& share = shares[(thread + n) % shares.size()];
      for (auto task = share.next++; task < share.end; task = share.next++) {
        run(task);
        ++done;
      }
    }
  }
};

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

void wait_a_little(unsigned& times) {
  // Who waits long may be waiting for somebody who has no core.
  if (++times < 2000) {
    pause();
  } else {
    std::this_thread::yield();
  }
}

}  // namespace

// A phase ends when its tasks have ended, not when every thread has come by: a thread that another
// program has pushed off its core keeps nobody waiting unless it is in the middle of a task.
// Between phases threads stay awake, as waking them takes longer than most phases.
struct Threads::Arena : tbb::task_arena {
  using tbb::task_arena::task_arena;
};

Threads::Threads(unsigned count) : count_(std::max(1U, count)) {
  if (count_ > 1) arena_ = std::make_shared<Arena>(static_cast<int>(count_));
}

void Threads::ranges(std::size_t size,
                     FunctionReference<void(std::size_t, std::size_t)> body) const {
  constexpr std::size_t worth_a_task = 500;
  const std::size_t tasks = std::min<std::size_t>(count_, size / worth_a_task);
  if (count_ == 1 || tasks < 2) {
    if (size > 0) body(0, size);
    return;
  }
  const std::size_t one_phase[] = {tasks};
  phases(one_phase, [&](unsigned, std::size_t, std::size_t task) {
    body(size * task / tasks, size * (task + 1) / tasks);
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
  std::deque<Phase> progress;
  for (const std::size_t count : tasks) progress.emplace_back(count, count_);
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  const auto work = [&](unsigned) {
    const auto thread = static_cast<unsigned>(tbb::this_task_arena::current_thread_index());
    for (std::size_t phase = 0; phase < tasks.size(); ++phase) {
      progress[phase].work(thread, [&](std::size_t task) {
        try {
          if (!failed) body(thread, phase, task);
        } catch (...) {
          if (!failed.exchange(true)) failure = std::current_exception();
        }
      });
      for (unsigned times = 0; progress[phase].done < tasks[phase];) wait_a_little(times);
    }
  };
  // A task may ask for tasks of its own: who waits for those must not begin to work on phases that
  // cannot end before it.
  arena_->execute([&] {
    tbb::this_task_arena::isolate(
        [&] { tbb::parallel_for(0U, count_, work, tbb::simple_partitioner()); });
  });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace driftless
