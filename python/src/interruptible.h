#pragma once
/// @file Work that Ctrl-C ends, and that calls back into Python meanwhile.

#include <atomic>
#include <functional>
#include <optional>
#include <utility>

namespace freepath::python {

/// Asked now and then, with the GIL, by the thread that waits; false wishes the work to end.
using Poll = std::function<bool()>;

/// Runs work on a thread of its own without the GIL, while the calling thread, which has to hold
/// the GIL, waits and answers signals: Python handles them on its main thread alone.
/// @param work ends soon once the flag that it is given is set
/// @throws what `work` throws; what a handler of signals (KeyboardInterrupt) or `poll` throws, once
///   the work has ended
void run_interruptibly(const std::function<void(const std::atomic<bool>& stop)>& work,
                       const Poll& poll = {});

/// The same of work that returns something.
template <class Work>
auto result_interruptibly(const Work& work, const Poll& poll = {}) {
  std::optional<decltype(work(std::declval<const std::atomic<bool>&>()))> result;
  run_interruptibly([&](const std::atomic<bool>& stop) { result.emplace(work(stop)); }, poll);
  return std::move(*result);
}

}  // namespace freepath::python
