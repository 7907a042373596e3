#pragma once
/// @file When a rendering has to end.

#include <atomic>
#include <limits>

namespace freepath {

/// Decides when to end a pass over all pixels. All times are seconds since the rendering began.
///
/// A pass is made whole where that costs little: past its time it goes on while it is expected to
/// be complete soon. The first pass gets more of that than others, since a pixel without any
/// sample shows nothing.
class Deadline {
 public:
  /// @param time_limit [s] 0: none
  explicit Deadline(double time_limit);

  /// A pass begins. Not while another thread asks.
  void begin_pass(double now, bool first);
  /// The caller wishes to stop: a first pass has a second left, others none.
  void request_stop(double now);
  bool stop_is_wished() const { return wish_ < kNever; }

  /// Whether the pass at work has to end; any thread may ask.
  /// @param done part of it that is done, 0 to 1
  bool is_over(double now, double done) const;

  /// When a first pass ends at the latest, complete or not, under a time limit [s].
  static double first_pass_limit(double time_limit) { return 2 * time_limit + 1; }
  /// When later passes end at the latest: they are planned to end in time, and plans are wrong by
  /// some percent.
  static double later_pass_limit(double time_limit) { return 1.05 * time_limit + 0.25; }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr double kFirstPassAfterWish = 1;  // [s]

  double limit_;  // kNever: none
  double pass_began_ = 0;
  bool first_pass_ = true;
  std::atomic<double> wish_ = kNever;  // when it was uttered
};

}  // namespace freepath
