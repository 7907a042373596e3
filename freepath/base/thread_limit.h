#pragma once
/// @file How many threads the system grants.

#include <pthread.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace freepath {

/// How many of so many threads the system grants at present: containers, users and address spaces
/// have limits, at which TBB would end the process. The calling thread counts, and is there.
inline int granted_threads(int wanted) {
  // A thread's stack, as large as TBB's.
  constexpr std::size_t kStack = std::size_t{4} << 20U;
  std::mutex gate;
  std::unique_lock closed(gate);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStack);
  const auto wait = [](void* data) -> void* {
    const std::lock_guard open(*static_cast<std::mutex*>(data));
    return nullptr;
  };
  std::vector<pthread_t> threads;
  threads.reserve(wanted);
  for (pthread_t thread{}; static_cast<int>(threads.size()) + 1 < wanted;) {
    if (pthread_create(&thread, &attributes, wait, &gate) != 0) break;
    threads.push_back(thread);
  }
  pthread_attr_destroy(&attributes);
  closed.unlock();
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
  const int granted = static_cast<int>(threads.size()) + 1;
  if (granted >= wanted) return wanted;
  // The system counts a thread a little longer than it lives, and others may start some.
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return std::max(1, granted - 1 - granted / 8);
}

/// While one lives, no parallel work asks for more threads than the system grants.
class ThreadLimit {
 public:
  ThreadLimit() {
    const int usual = tbb::info::default_concurrency();
    const int granted = granted_threads(usual);
    if (granted < usual) limit_.emplace(tbb::global_control::max_allowed_parallelism, granted);
  }

 private:
  std::optional<tbb::global_control> limit_;
};

}  // namespace freepath
