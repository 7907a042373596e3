#include "apps/freepath/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>

#include "apps/freepath/console.h"

namespace freepath::program {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// Signals that mean the end is near: what there is had better be saved.
constexpr std::array kEndings{SIGINT, SIGTERM, SIGHUP, SIGXCPU};

void on_ending(int signal) {
  interrupted = true;
  // Who asks twice, insists. A lost terminal and used-up time tell more than once by themselves.
  if (signal == SIGINT || signal == SIGTERM) std::signal(signal, SIG_DFL);
}

}  // namespace

ProgressBar::ProgressBar(std::size_t pixels, double time_limit)
    : pixels_(static_cast<double>(pixels)), time_limit_(time_limit) {}

void ProgressBar::show(const RenderProgress& progress) const {
  if (progress.seconds <= 0) return;
  double done = progress.samples_total > 0 ? progress.samples_done / progress.samples_total : 0;
  if (time_limit_ > 0) done = std::max(done, progress.seconds / time_limit_);
  done = std::clamp(done, 0.0, 1.0);
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(done * kWidth);
  const double left = done > 0 ? progress.seconds * (1 - done) / done : 0;
  const std::string samples =
      progress.samples_total > 0
          ? fmt::format("{:.0f}/{:.0f}", progress.samples_done, progress.samples_total)
          : fmt::format("{:.0f}", progress.samples_done);
  show_status(fmt::format("[{:=<{}}{: <{}}] {:3.0f} %  {} samples  {:.2f} M samples/s  {} left", "",
                          filled, "", kWidth - filled, 100 * done, samples,
                          1e-6 * progress.samples_done * pixels_ / progress.seconds,
                          clock_text(left)));
}

void ProgressBar::finish() const { clear_status(); }

std::string clock_text(double seconds) {
  const auto whole = static_cast<int64_t>(std::llround(seconds));
  const int64_t hours = whole / 3600;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

StopOnInterrupt::StopOnInterrupt() {
  interrupted = false;
  for (const int signal : kEndings) {
    // Under nohup, a lost terminal means nothing.
    if (std::signal(signal, on_ending) == SIG_IGN && signal == SIGHUP) {
      std::signal(signal, SIG_IGN);
    }
  }
}

StopOnInterrupt::~StopOnInterrupt() {
  for (const int signal : kEndings) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

bool StopOnInterrupt::requested() { return interrupted; }

bool PathProgress::show(uint64_t done, uint64_t total) {
  constexpr double kSecondsBetweenReports = 0.1;
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (seconds - shown_ >= kSecondsBetweenReports) {
    shown_ = seconds;
    bar_.show({static_cast<double>(done), static_cast<double>(total), seconds});
  }
  return !stop_.requested();
}

}  // namespace freepath::program
