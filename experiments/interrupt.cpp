#include "experiments/interrupt.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace driftless {
namespace {

bool is_ignored(int signal) {
  struct sigaction action;
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

InterruptNotice::InterruptNotice(std::function<std::string()> sentence)
    : sentence_(std::move(sentence)) {
  sigset_t watched;
  sigemptyset(&watched);
  for (const int signal : {SIGINT, SIGTERM}) {
    if (!is_ignored(signal)) sigaddset(&watched, signal);
  }
  sigaddset(&watched, SIGUSR1);  // says that it is over
  pthread_sigmask(SIG_BLOCK, &watched, &before_);
  watcher_ = std::thread([this, watched] {
    int signal = 0;
    while (sigwait(&watched, &signal) != 0 || (signal == SIGUSR1 && !over_)) {
    }
    if (signal == SIGUSR1) return;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    fmt::print(stderr, "{}driftless: {}\n", terminal ? "\r\033[K" : "", sentence_());
    std::fflush(stderr);
    _exit(128 + signal);
  });
}

InterruptNotice::~InterruptNotice() {
  over_ = true;
  pthread_kill(watcher_.native_handle(), SIGUSR1);
  watcher_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace driftless
