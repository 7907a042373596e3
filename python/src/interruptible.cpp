#include "python/src/interruptible.h"

#include <nanobind/nanobind.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

#include "freepath/base/error.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

/// How long a signal or a call back waits at most.
constexpr std::chrono::milliseconds kPatience{40};

std::thread start(const std::function<void()>& work) {
  try {
    return std::thread(work);
  } catch (const std::system_error& error) {
    fail("no thread can be started: {}", error.what());
  }
}

/// Whether the work may go on. Holds the GIL.
bool ask(const Poll& poll) {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  return !poll || poll();
}

}  // namespace

void run_interruptibly(const std::function<void(const std::atomic<bool>& stop)>& work,
                       const Poll& poll) {
  std::atomic<bool> stop = false;
  std::exception_ptr failure;
  std::exception_ptr interruption;
  std::mutex gate;
  std::condition_variable ended;
  bool is_done = false;
  {
    const nb::gil_scoped_release released;
    std::thread worker = start([&] {
      try {
        work(stop);
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(gate);
      is_done = true;
      ended.notify_one();
    });
    std::unique_lock lock(gate);
    while (!ended.wait_for(lock, kPatience, [&] { return is_done; })) {
      if (stop) continue;
      lock.unlock();
      {
        const nb::gil_scoped_acquire acquired;
        try {
          if (!ask(poll)) stop = true;
        } catch (...) {
          interruption = std::current_exception();
          stop = true;
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (interruption) std::rethrow_exception(interruption);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace freepath::python
