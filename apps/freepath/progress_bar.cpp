#include "apps/freepath/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "apps/freepath/console.h"
#include "freepath/base/json_text.h"

namespace freepath::program {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr double kSecondsBetweenLines = 10;

/// Signals that mean the end is near: what there is had better be saved.
constexpr std::array kEndings{SIGINT, SIGTERM, SIGHUP, SIGXCPU};

void on_ending(int signal) {
  interrupted = true;
  // Who asks twice, insists. A lost terminal and used-up time tell more than once by themselves.
  if (signal == SIGINT || signal == SIGTERM) std::signal(signal, SIG_DFL);
}

}  // namespace

ProgressBar::ProgressBar(std::size_t pixels, double time_limit, ProgressForm form, double noise)
    : pixels_(static_cast<double>(pixels)), time_limit_(time_limit), form_(form), noise_(noise) {
  if (form_ == ProgressForm::kAutomatic) {
    form_ = isatty(STDERR_FILENO) != 0 ? ProgressForm::kBar : ProgressForm::kLines;
  }
  if (form_ == ProgressForm::kLines) next_line_ = kSecondsBetweenLines;
}

ProgressBar::State ProgressBar::state_of(const RenderProgress& progress) const {
  State state;
  if (progress.samples_total > 0) state.done = progress.samples_done / progress.samples_total;
  if (time_limit_ > 0) state.done = std::max(state.done, progress.seconds / time_limit_);
  state.done = std::clamp(state.done, 0.0, 1.0);
  if (state.done > 0) state.seconds_left = progress.seconds * (1 - state.done) / state.done;
  state.samples_per_second = progress.samples_done * pixels_ / progress.seconds;
  if (noise_ > 0 && progress.samples_done > 0) {
    state.noise = noise_ * std::sqrt(progress.samples_total / progress.samples_done);
  }
  return state;
}

void ProgressBar::show(const RenderProgress& progress) {
  if (progress.seconds <= 0 || form_ == ProgressForm::kNone) return;
  if (form_ != ProgressForm::kBar && progress.seconds < next_line_) return;
  next_line_ = progress.seconds + kSecondsBetweenLines;
  const State state = state_of(progress);
  if (form_ == ProgressForm::kJson) {
    nlohmann::json json = {{"progress", state.done},
                           {"samples", progress.samples_done},
                           {"samples_total", progress.samples_total},
                           {"seconds", progress.seconds},
                           {"seconds_left", state.seconds_left},
                           {"samples_per_second", state.samples_per_second}};
    if (state.noise > 0) json["noise"] = state.noise;
    put_message(json_text(json) + '\n');
    return;
  }
  const std::string samples =
      progress.samples_total > 0
          ? fmt::format("{:.0f}/{:.0f}", progress.samples_done, progress.samples_total)
          : fmt::format("{:.0f}", progress.samples_done);
  const std::string noise = state.noise > 0 ? fmt::format("  noise {:.2g}", state.noise) : "";
  const std::string text =
      fmt::format("{:3.0f} %  {} samples  {:.2f} M samples/s{}  {} left", 100 * state.done, samples,
                  1e-6 * state.samples_per_second, noise, clock_text(state.seconds_left));
  if (form_ == ProgressForm::kLines) {
    tell("{}\n", text);
    return;
  }
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(state.done * kWidth);
  show_status(fmt::format("[{:=<{}}{: <{}}] {}", "", filled, "", kWidth - filled, text));
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
