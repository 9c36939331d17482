#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace driftless {

/// Runs work(index) for every index below `count` on at most so many threads, in rising order of
/// their starts; the first exception ends it and is thrown again.
template <class Work>
void parallel(std::size_t count, unsigned threads, Work&& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  {
    std::vector<std::jthread> pool;
    for (unsigned n = 0; n < std::min<std::size_t>(threads, count); ++n) {
      pool.emplace_back([&] {
        try {
          for (auto index = next++; index < count; index = next++) work(index);
        } catch (...) {
          const std::lock_guard lock(failure_mutex);
          if (!failure) failure = std::current_exception();
          next = count;
        }
      });
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace driftless
