#pragma once
/// @file A progress bar on standard error, and the wish to stop.

#include <chrono>
#include <cstdint>
#include <string>

#include "freepath/paths/renderer.h"

namespace freepath::program {

/// Forms in which progress is told.
enum class ProgressForm {
  kAutomatic,  ///< A bar where standard error is a terminal, else lines.
  kBar,        ///< A line that changes; nothing where standard error is no terminal.
  kLines,      ///< A line every ten seconds.
  kJson,       ///< The same, each an object of JSON: `progress` from 0 to 1, `samples`, ...
  kNone
};

/// Tells how far a rendering is, with its rate and the time left, on standard error.
class ProgressBar {
 public:
  /// @param pixels of the picture, for the rate
  /// @param time_limit [s] 0: none
  /// @param noise that is to be reached; 0: none is asked for
  ProgressBar(std::size_t pixels, double time_limit, ProgressForm form = ProgressForm::kBar,
              double noise = 0);
  void show(const RenderProgress& progress);
  /// Clears the bar.
  void finish() const;

 private:
  /// Figures of a moment.
  struct State {
    double done = 0;  ///< 0 to 1
    double seconds_left = 0;
    double samples_per_second = 0;
    double noise = 0;
  };
  State state_of(const RenderProgress& progress) const;

  double pixels_;
  double time_limit_;
  ProgressForm form_;
  double noise_;
  double next_line_ = 0;  // [s]
};

/// "1:02:03", "2:03" or "0:03" for seconds.
std::string clock_text(double seconds);

/// While one of these lives, the first Ctrl-C is taken as a wish to stop, as are SIGTERM, the loss
/// of the terminal (SIGHUP) and of time (SIGXCPU); a second Ctrl-C or SIGTERM ends the program as
/// usual.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  static bool requested();
};

/// Shows how many paths are done, now and then, and tells whether to go on.
class PathProgress {
 public:
  explicit PathProgress(const StopOnInterrupt& stop) : stop_(stop) {}
  /// @return false if the end is wished
  bool show(uint64_t done, uint64_t total);
  /// Clears the line.
  void finish() const { bar_.finish(); }

 private:
  const StopOnInterrupt& stop_;
  ProgressBar bar_{1, 0};
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double shown_ = 0;
};

}  // namespace freepath::program
