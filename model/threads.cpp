#include "model/threads.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace driftless {
namespace {

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

constexpr unsigned pauses = 1500;  // some ten microseconds to a hundred

/// A number that belongs to one job, in one atomic word: whoever comes late, with an earlier job in
/// mind, sees that it is not meant.
class JobNumber {
 public:
  static std::uint64_t word(std::uint32_t job, std::size_t number) {
    return std::uint64_t{job} << 32 | static_cast<std::uint32_t>(number);
  }
  static bool is_of(std::uint64_t word, std::uint32_t job) { return word >> 32 == job; }
  static std::size_t number(std::uint64_t word) { return word & 0xffffffffU; }

  void set(std::uint32_t job, std::size_t number) {
    word_.store(word(job, number), std::memory_order_relaxed);
  }
  std::uint64_t get() const { return word_.load(std::memory_order_acquire); }
  /// Who waits for `last` hears of it.
  void increase(std::uint32_t job, std::size_t last) {
    if (word_.fetch_add(1, std::memory_order_acq_rel) + 1 == word(job, last)) word_.notify_all();
  }
  /// Until the number is `last` or the job is over. Who waits long may be waiting for somebody who
  /// has no core, and leaves its own to others.
  void wait_for(std::uint32_t job, std::size_t last) const {
    std::uint64_t seen = get();
    for (unsigned n = 0; seen != word(job, last) && is_of(seen, job); ++n, seen = get()) {
      if (n < pauses) {
        pause();
      } else {
        word_.wait(seen, std::memory_order_acquire);
      }
    }
  }
  /// Takes the present number, if it is below `end`, and leaves the next one.
  bool take(std::uint32_t job, std::size_t end, std::size_t& taken) {
    std::uint64_t seen = word_.load(std::memory_order_relaxed);
    while (is_of(seen, job) && number(seen) < end) {
      if (word_.compare_exchange_weak(seen, seen + 1, std::memory_order_acquire)) {
        taken = number(seen);
        return true;
      }
    }
    return false;
  }

 private:
  std::atomic<std::uint64_t> word_ = 0;
};

/// The tasks of a phase that are one thread's to begin with: what it works on stays in the cache of
/// its core, from phase to phase and from step to step.
struct alignas(64) Share {
  JobNumber next;
};

struct alignas(64) Phase {
  JobNumber tasks;
  alignas(64) JobNumber done;
  std::vector<Share> shares;
};

}  // namespace

// A job is some phases of tasks. Threads take tasks, their own share first and then what others
// have not come to; a phase ends when its tasks have ended, not when every thread has come by: a
// thread that another program has pushed off its core keeps nobody waiting unless it is in the
// middle of a task. Between phases threads stay awake for a little while, as waking them takes
// longer than most phases.
class Threads::Team {
 public:
  using Body = FunctionReference<void(unsigned, std::size_t, std::size_t)>;
  static constexpr std::size_t most_phases = 16;

  explicit Team(unsigned count) : count_(count) {
    for (auto& phase : phases_) phase.shares = std::vector<Share>(count);
    try {
      for (unsigned n = 1; n < count; ++n) workers_.emplace_back([this, n] { serve(n); });
    } catch (const std::system_error&) {
      // No more threads are to be had: fewer do the same.
    }
  }
  ~Team() {
    stop_ = true;
    begin(job_ + 1);
    for (auto& worker : workers_) worker.join();
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// At most so many phases, numbered from `first`. False, with nothing done, if the team is at
  /// work already.
  bool work(std::span<const std::size_t> tasks, std::size_t first, const Body& body) {
    if (busy_.test_and_set(std::memory_order_acquire)) return false;
    const std::uint32_t job = job_ + 1;
    length_.set(job, tasks.size());
    for (std::size_t n = 0; n < tasks.size(); ++n) {
      Phase& phase = phases_[n];
      phase.tasks.set(job, tasks[n]);
      phase.done.set(job, 0);
      for (unsigned thread = 0; thread < count_; ++thread) {
        phase.shares[thread].next.set(job, tasks[n] * thread / count_);
      }
    }
    body_ = &body;
    first_ = first;
    failed_ = false;
    begin(job);
    run(job, 0);
    const std::exception_ptr failure = failed_ ? std::move(failure_) : nullptr;
    busy_.clear(std::memory_order_release);
    if (failure) std::rethrow_exception(failure);
    return true;
  }

 private:
  void begin(std::uint32_t job) {
    job_.store(job, std::memory_order_release);
    job_.notify_all();
  }

  /// A worker's life.
  void serve(unsigned thread) {
    for (std::uint32_t known = 0;;) {
      for (unsigned n = 0; n < pauses && job_.load(std::memory_order_relaxed) == known; ++n) {
        pause();
      }
      job_.wait(known, std::memory_order_acquire);
      known = job_.load(std::memory_order_acquire);
      if (stop_) return;
      run(known, thread);
    }
  }

  /// Takes part in a job as long as there is anything to do.
  void run(std::uint32_t job, unsigned thread) {
    const std::uint64_t length = length_.get();
    if (!JobNumber::is_of(length, job)) return;
    for (std::size_t n = 0; n < JobNumber::number(length); ++n) {
      Phase& phase = phases_[n];
      const std::uint64_t tasks = phase.tasks.get();
      if (!JobNumber::is_of(tasks, job)) return;
      for (unsigned share = 0; share < count_; ++share) {
        take_share(job, n, JobNumber::number(tasks), (thread + share) % count_, thread);
      }
      phase.done.wait_for(job, JobNumber::number(tasks));
    }
  }

  void take_share(std::uint32_t job, std::size_t phase, std::size_t tasks, unsigned share,
                  unsigned thread) {
    const std::size_t end = tasks * (share + 1) / count_;
    std::size_t task = 0;
    while (phases_[phase].shares[share].next.take(job, end, task)) {
      // The job lasts until this task is done.
      try {
        if (!failed_) (*body_)(thread, first_ + phase, task);
      } catch (...) {
        if (!failed_.exchange(true)) failure_ = std::current_exception();
      }
      phases_[phase].done.increase(job, tasks);
    }
  }

  const unsigned count_;
  alignas(64) std::atomic<std::uint32_t> job_ = 0;
  alignas(64) std::atomic_flag busy_;
  JobNumber length_;  ///< of the job, in phases
  std::array<Phase, most_phases> phases_;
  const Body* body_ = nullptr;
  std::size_t first_ = 0;
  std::atomic<bool> failed_ = false;
  std::atomic<bool> stop_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> workers_;
};

Threads::Threads(unsigned count) : count_(std::max(1U, count)) {
  if (count_ > 1) team_ = std::make_shared<Team>(count_);
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
  // Where the team is at work already, in a task that has more of them, or for another system,
  // the tasks are done one after the other.
  for (std::size_t first = 0; first < tasks.size(); first += Team::most_phases) {
    const auto some = tasks.subspan(first, std::min(Team::most_phases, tasks.size() - first));
    if (team_ && team_->work(some, first, body)) continue;
    for (std::size_t phase = 0; phase < some.size(); ++phase) {
      for (std::size_t task = 0; task < some[phase]; ++task) body(0, first + phase, task);
    }
  }
}

}  // namespace driftless
