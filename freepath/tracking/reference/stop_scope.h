#pragma once
/// @file A wish to stop that reaches into walks.

#include <functional>

namespace freepath {

/// Lets the walks of this thread ask whether they are still wanted, as long as it lives: those
/// whose single flights may take very long. Walks that have been told to stop return at once, and
/// what they return means nothing.
///
/// It is no parameter of walks, so that kernels for lanes, whose flights are short, know nothing of
/// it.
class StopScope {
 public:
  /// @param stop asked now and then; once it is true the walks end. Empty: never.
  explicit StopScope(const std::function<bool()>& stop) : stop_(stop), outer_(innermost) {
    innermost = this;
  }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  ~StopScope() { innermost = outer_; }

  /// Whether walks were told to stop.
  bool stopped() const { return stopped_; }

  /// Whether the walk at work was told to stop before; asks nobody.
  static bool has_stopped() { return innermost != nullptr && innermost->stopped_; }
  /// Whether the walk at work has to stop.
  static bool ask() {
    if (innermost == nullptr || !innermost->stop_) return false;
    innermost->stopped_ = innermost->stopped_ || innermost->stop_();
    return innermost->stopped_;
  }

 private:
  const std::function<bool()>& stop_;
  StopScope* const outer_;
  bool stopped_ = false;

  inline static thread_local StopScope* innermost = nullptr;
};

}  // namespace freepath
