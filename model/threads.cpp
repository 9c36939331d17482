#include "model/threads.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace driftless {

namespace {

constexpr unsigned patience = 2000;  // pauses: some ten microseconds to a hundred

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

/// Waits until a condition holds. Who waits long may be waiting for somebody who has no core.
template <class Condition>
void wait_until(Condition&& holds) {
  for (unsigned times = 0; !holds(); ++times) {
    if (times < patience) {
      pause();
    } else {
      std::this_thread::yield();
    }
  }
}

/// The tasks of a phase that are one thread's to begin with: what it works on stays in the cache of
/// its core, from phase to phase and from step to step.
struct alignas(64) Share {
  std::atomic<std::size_t> next = 0;
  std::size_t end = 0;

  /// run(task) for those that nobody has come to.
  template <class Run>
  void work(std::atomic<std::size_t>& done, Run&& run) {
    // Looking costs others less than taking.
    while (next < end) {
      const std::size_t task = next++;
      if (task >= end) return;
      run(task);
      ++done;
    }
  }
};

/// A phase of tasks at work.
class Phase {
 public:
  explicit Phase(unsigned threads) : shares_(threads) {}

  void begin(std::size_t tasks) {
    tasks_ = tasks;
    done_ = 0;
    for (std::size_t n = 0; n < shares_.size(); ++n) {
      shares_[n].next = tasks * n / shares_.size();
      shares_[n].end = tasks * (n + 1) / shares_.size();
    }
  }
  /// run(task) for the tasks of a thread and then for those that others have not come to; ends when
  /// all have ended.
  template <class Run>
  void work(unsigned thread, Run&& run) {
    for (std::size_t n = 0; n < shares_.size() && done_ < tasks_; ++n) {
      shares_[(thread + n) % shares_.size()].work(done_, run);
    }
    wait_until([&] { return done_ == tasks_; });
  }

 private:
  std::size_t tasks_ = 0;
  std::vector<Share> shares_;
  alignas(64) std::atomic<std::size_t> done_ = 0;
};

}  // namespace

// A phase ends when its tasks have ended, not when every thread has come by: a thread that another
// program has pushed off its core keeps nobody waiting unless it is in the middle of a task. The
// threads are oneTBB's. They stay awake for a little while between phases, and from job to job, as
// calling them takes longer than most jobs; then they leave for others, or to sleep.
class Threads::Team {
 public:
  using Body = FunctionReference<void(unsigned, std::size_t, std::size_t)>;

  explicit Team(unsigned count)
      : arena_(static_cast<int>(count)), workers_(count), helpers_(count - 1) {
    for (auto& helper : helpers_) helper = std::make_shared<Helper>();
  }
  ~Team() {
    ending_ = true;
    for (auto& helper : helpers_) {
      auto called = Presence::called;
      helper->presence.compare_exchange_strong(called, Presence::absent);
      wait_until([&] { return helper->presence == Presence::absent; });
    }
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// False, with nothing done, if the team is at work already.
  bool work(std::span<const std::size_t> tasks, const Body& body) {
    if (busy_.exchange(true)) return false;
    while (phases_.size() < tasks.size()) phases_.push_back(std::make_unique<Phase>(workers_));
    for (std::size_t n = 0; n < tasks.size(); ++n) phases_[n]->begin(tasks[n]);
    length_ = tasks.size();
    body_ = &body;
    failed_ = false;
    ++job_;
    call_helpers();
    take_part(0);
    const std::uint64_t job = job_++;
    for (auto& helper : helpers_) wait_until([&] { return helper->job != job; });
    const std::exception_ptr failure = std::exchange(failure_, nullptr);
    busy_ = false;
    if (failure) std::rethrow_exception(failure);
    return true;
  }

 private:
  enum class Presence { absent, called, present };
  /// Outlives the team where it has been called and nobody has come.
  struct alignas(64) Helper {
    std::atomic<Presence> presence = Presence::absent;
    std::atomic<std::uint64_t> job = 0;  ///< at which it may be at work
  };

  void call_helpers() {
    for (unsigned n = 0; n < helpers_.size(); ++n) {
      if (helpers_[n]->presence != Presence::absent) continue;
      helpers_[n]->presence = Presence::called;
      arena_.enqueue([this, helper = helpers_[n], thread = n + 1] {
        auto called = Presence::called;
        if (!helper->presence.compare_exchange_strong(called, Presence::present)) return;
        help(*helper, thread);
        helper->presence = Presence::absent;
      });
    }
  }

  /// A helper's presence: takes part in jobs until none has come for a while.
  void help(Helper& helper, unsigned thread) {
    std::uint64_t known = 0;
    for (unsigned idle = 0; idle < patience && !ending_; ++idle) {
      const std::uint64_t job = job_;
      if (job == known || job % 2 == 0) {
        pause();
        continue;
      }
      helper.job = job;
      // The job goes on now and waits for its helpers, or it ended before.
      if (job_ == job) take_part(thread);
      helper.job = 0;
      known = job;
      idle = 0;
    }
  }

  void take_part(unsigned thread) {
    for (std::size_t phase = 0; phase < length_; ++phase) {
      phases_[phase]->work(thread, [&](std::size_t task) {
        try {
          if (!failed_) (*body_)(thread, phase, task);
        } catch (...) {
          if (!failed_.exchange(true)) failure_ = std::current_exception();
        }
      });
    }
  }

  tbb::task_arena arena_;
  const unsigned workers_;
  std::vector<std::shared_ptr<Helper>> helpers_;
  std::atomic<bool> busy_ = false, ending_ = false;
  // The job.
  std::vector<std::unique_ptr<Phase>> phases_;
  std::size_t length_ = 0;
  const Body* body_ = nullptr;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  alignas(64) std::atomic<std::uint64_t> job_ = 0;  ///< its number, odd as long as it goes on
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
  if (team_ && team_->work(tasks, body)) return;
  for (std::size_t phase = 0; phase < tasks.size(); ++phase) {
    for (std::size_t task = 0; task < tasks[phase]; ++task) body(0, phase, task);
  }
}

}  // namespace driftless
