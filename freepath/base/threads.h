#pragma once
/// @file The threads that a piece of parallel work runs on.

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace freepath {

/// So many threads, even more than the machine has, for the parallel loops that `execute` runs.
class Threads {
 public:
  /// @param count 0: as many as the machine has
  explicit Threads(int count)
      : limit_(tbb::global_control::max_allowed_parallelism,
               std::max(count, tbb::info::default_concurrency())),
        arena_(count > 0 ? count : tbb::task_arena::automatic) {}

  int count() { return arena_.max_concurrency(); }

  template <class Work>
  auto execute(Work work) {
    return arena_.execute(work);
  }

 private:
  tbb::global_control limit_;  // Set before the arena asks for threads, which it else goes without.
  tbb::task_arena arena_;
};

}  // namespace freepath
