#pragma once
/// @file A progress bar on standard error, and the wish to stop.

#include <chrono>
#include <cstdint>
#include <string>

#include "freepath/paths/renderer.h"

namespace freepath::program {

/// Draws how far a rendering is, with its rate and the time left, where standard error is a
/// terminal; prints nothing otherwise.
class ProgressBar {
 public:
  /// @param pixels of the picture, for the rate
  /// @param time_limit [s] 0: none
  ProgressBar(std::size_t pixels, double time_limit);
  void show(const RenderProgress& progress) const;
  /// Clears the line.
  void finish() const;

 private:
  double pixels_;
  double time_limit_;
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
