#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

namespace driftless {

/// A reference to something that can be called, good as long as that lives.
template <class Signature>
class FunctionReference;

template <class... Arguments>
class FunctionReference<void(Arguments...)> {
 public:
  template <class Function>
  requires(!std::is_same_v<std::remove_cvref_t<Function>, FunctionReference>)
      FunctionReference(const Function& function)
      : function_(&function), call_([](const void* called, Arguments... arguments) {
          (*static_cast<const Function*>(called))(arguments...);
        }) {}
  void operator()(Arguments... arguments) const { call_(function_, arguments...); }

 private:
  const void* function_;
  void (*call_)(const void*, Arguments...);
};

/// The threads that work on one system. What they compute does not depend on how many there are:
/// tasks at work at the same time touch nothing in common. Copies work in the same threads; who
/// asks while they are at work, as a task may, does it all alone. The first exception of a task
/// ends the work, in so far as tasks that have not begun are left out, and is thrown again.
class Threads {
 public:
  explicit Threads(unsigned count = 1);
  unsigned count() const { return count_; }

  /// body(begin, end) on parts of [0, size) that together are the whole.
  void ranges(std::size_t size, FunctionReference<void(std::size_t, std::size_t)> body) const;

  /// body(thread, phase, task) for every task of every phase, a phase after all of the one before;
  /// `tasks` tells how many each phase has.
  void phases(std::span<const std::size_t> tasks,
              FunctionReference<void(unsigned, std::size_t, std::size_t)> body) const;

 private:
  class Team;

  unsigned count_;
  std::shared_ptr<Team> team_;
};

}  // namespace driftless
