#pragma once

#include <signal.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace driftless {

/// While it lives, an interrupt (SIGINT, Ctrl-C) or a request to end (SIGTERM) ends the program at
/// once with one sentence on standard error and the exit code that shells give it, 130 or 143.
/// Nothing is lost that is written atomically. Make it before the threads that do the work: they
/// inherit that these signals are not theirs. A signal that the program was started to ignore, as
/// in the background of a script, stays ignored.
class InterruptNotice {
 public:
  /// `sentence` is called from a thread of its own.
  explicit InterruptNotice(std::function<std::string()> sentence);
  ~InterruptNotice();
  InterruptNotice(const InterruptNotice&) = delete;
  InterruptNotice& operator=(const InterruptNotice&) = delete;

 private:
  std::function<std::string()> sentence_;
  std::atomic<bool> over_ = false;
  sigset_t before_;
  std::thread watcher_;
};

}  // namespace driftless
