#pragma once
/// @file How far work of several steps is, told to a function of Python's.

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "python/src/interruptible.h"

namespace freepath::python {

/// Keeps what the working thread tells until the one that waits asks.
class StepDesk {
 public:
  /// @param callback called with the name of the step and the fraction of all work that is done;
  ///   False wishes the work to end; None is never called
  explicit StepDesk(nanobind::object callback) : callback_(std::move(callback)) {}

  void put(std::string_view step, double fraction) {
    const std::lock_guard lock(gate_);
    step_ = step;
    fraction_ = fraction;
  }

  /// What run_interruptibly() asks; the desk has to outlive it.
  Poll poll() {
    if (callback_.is_none()) return {};
    return [this] {
      const auto [step, fraction] = latest();
      if (step.empty()) return true;  // nothing is told yet
      return !callback_(step, fraction).is(nanobind::bool_(false));
    };
  }

 private:
  std::pair<std::string, double> latest() {
    const std::lock_guard lock(gate_);
    return {step_, fraction_};
  }

  nanobind::object callback_;
  std::mutex gate_;
  std::string step_;
  double fraction_ = 0;
};

}  // namespace freepath::python
