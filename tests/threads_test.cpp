#include "model/threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

// What is asked of threads: every task once, phase after phase, whatever their number, whoever else
// is at work and whatever is thrown.
namespace driftless::testing {
namespace {

using Tasks = std::vector<std::size_t>;

/// Counts tasks, and faults: a phase begun before the one before has ended, or one number of a
/// thread at work twice at a time.
class Watch {
 public:
  Watch(const Tasks& tasks, unsigned threads) : tasks_(tasks), at_work_(threads) {
    for (const auto count : tasks) {
      times_.push_back(std::vector<std::atomic<int>>(count));
      ended_.push_back(std::make_unique<std::atomic<std::size_t>>(0));
    }
  }
  void task(unsigned thread, std::size_t phase, std::size_t task) {
    if (thread >= at_work_.size() || at_work_[thread].exchange(true)) ++faults_;
    for (std::size_t before = 0; before < phase; ++before) {
      if (*ended_[before] != tasks_[before]) ++faults_;
    }
    ++times_[phase][task];
    for (std::atomic<std::size_t> n = 0; n < 100 * (task % 3);) ++n;  // some take longer
    ++*ended_[phase];
    at_work_[thread] = false;
  }
  int faults() const { return faults_; }
  bool every_task_once() const {
    for (const auto& phase : times_) {
      for (const auto& times : phase) {
        if (times != 1) return false;
      }
    }
    return true;
  }

 private:
  Tasks tasks_;
  std::vector<std::vector<std::atomic<int>>> times_;
  std::vector<std::unique_ptr<std::atomic<std::size_t>>> ended_;
  std::vector<std::atomic<bool>> at_work_;
  std::atomic<int> faults_ = 0;
};

const std::vector<Tasks> jobs = {{1},
                                 {7},
                                 {0},
                                 {3, 0, 5},
                                 {0, 0, 2},
                                 {4, 4, 4, 4, 1, 1, 9, 2},
                                 {100, 1, 30},
                                 {2, 2, 2, 2, 2, 2, 2, 2, 2, 0, 2, 2, 2, 2, 2, 2, 2, 3},
                                 {}};

TEST(Threads, DoEveryTaskOncePhaseAfterPhase) {
  for (const unsigned count : {1U, 2U, 3U, 4U, 9U}) {
    const Threads threads(count);
    for (int round = 0; round < 30; ++round) {
      for (const auto& tasks : jobs) {
        Watch watch(tasks, count);
        threads.phases(tasks, [&](unsigned thread, std::size_t phase, std::size_t task) {
          watch.task(thread, phase, task);
        });
        ASSERT_EQ(watch.faults(), 0);
        ASSERT_TRUE(watch.every_task_once());
      }
    }
  }
}

TEST(Threads, AreWatchedClosely) {
  const Tasks tasks = {2, 2};
  Watch early(tasks, 1), twice(tasks, 1), left_out(tasks, 1), foreign(tasks, 1);
  for (const std::size_t n : {0U, 1U}) early.task(0, 1, n);
  EXPECT_EQ(early.faults(), 2);
  for (const std::size_t n : {0U, 0U, 1U}) twice.task(0, 0, n);
  EXPECT_FALSE(twice.every_task_once());
  for (const std::size_t n : {0U, 1U}) left_out.task(0, 0, n);
  EXPECT_FALSE(left_out.every_task_once());
  foreign.task(1, 0, 0);
  EXPECT_GT(foreign.faults(), 0);
}

TEST(Threads, CutRangesIntoPartsThatAreTheWhole) {
  for (const unsigned count : {1U, 2U, 5U}) {
    const Threads threads(count);
    for (const std::size_t size : {0U, 1U, 999U, 1000U, 12345U}) {
      std::vector<int> times(size);
      threads.ranges(size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) ++times[n];
      });
      EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(size));
    }
  }
}

TEST(Threads, WorkAgainAfterTheyHaveFallenAsleep) {
  const Threads threads(4);
  std::atomic<int> done = 0;
  for (int round = 0; round < 5; ++round) {
    const Tasks tasks = {8, 8};
    threads.phases(tasks, [&](unsigned, std::size_t, std::size_t) { ++done; });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(done, 5 * 16);
}

TEST(Threads, PassOnWhatATaskThrowsAndLeaveOutWhatWouldFollow) {
  for (const unsigned count : {1U, 4U}) {
    const Threads threads(count);
    for (int round = 0; round < 200; ++round) {
      const Tasks tasks = {10, 10};
      const auto thrower = static_cast<std::size_t>(round % 10);
      std::atomic<int> second_phase = 0;
      std::string heard;
      try {
        threads.phases(tasks, [&](unsigned, std::size_t phase, std::size_t task) {
          if (phase == 1) ++second_phase;
          if (round % 3 == 0 || task == thrower) throw std::runtime_error("a task's own words");
        });
      } catch (const std::runtime_error& error) {
        heard = error.what();
      }
      EXPECT_EQ(heard, "a task's own words");
      EXPECT_EQ(second_phase, 0);
      std::atomic<int> done = 0;
      threads.phases(tasks, [&](unsigned, std::size_t, std::size_t) { ++done; });
      EXPECT_EQ(done, 20);
    }
  }
}

TEST(Threads, DoTasksOfTasks) {
  const Threads threads(3);
  const Threads copy = threads;
  const Tasks outer = {6}, inner = {5, 5};
  std::atomic<int> done = 0;
  threads.phases(outer, [&](unsigned, std::size_t, std::size_t task) {
    const Threads& mine = task % 2 == 0 ? threads : copy;
    mine.phases(inner, [&](unsigned, std::size_t, std::size_t) { ++done; });
  });
  EXPECT_EQ(done, 60);
}

/// Work of many who ask at once, each for itself.
void expect_sums_of_all(std::size_t askers, const std::vector<Threads>& threads) {
  std::vector<long> sums(askers);
  {
    std::vector<std::jthread> all;
    for (std::size_t n = 0; n < askers; ++n) {
      all.emplace_back([&, n] {
        const Tasks tasks = {7, 13};
        for (int round = 0; round < 300; ++round) {
          std::atomic<long> sum = 0;
          threads[n % threads.size()].phases(tasks, [&](unsigned, std::size_t, std::size_t task) {
            sum += static_cast<long>(task + 1);
          });
          sums[n] += sum;
        }
      });
    }
  }
  for (const long sum : sums) EXPECT_EQ(sum, 300 * (7 * 8 / 2 + 13 * 14 / 2));
}

TEST(Threads, AreSharedByWhoeverAsksAtOnce) { expect_sums_of_all(4, {Threads(3)}); }

TEST(Threads, MayBeManyMoreThanCores) {
  std::vector<Threads> many;
  for (int n = 0; n < 6; ++n) many.emplace_back(8);
  expect_sums_of_all(6, many);
}

TEST(Threads, MayEndWithoutHavingWorked) {
  for (int n = 0; n < 50; ++n) EXPECT_EQ(Threads(5).count(), 5U);
}

}  // namespace
}  // namespace driftless::testing
