#include "apps/freepath/console.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>

namespace freepath::program {
namespace {

constexpr std::size_t kLargestBuffer = 1 << 16;
constexpr int kUnexpected = 3;               // exit status
constexpr int kEndedByPipe = 128 + SIGPIPE;  // as shells say it

struct Console {
  std::mutex mutex;
  std::string results;  ///< Not yet written.
  int lost = 0;         ///< The error by which results were lost.
  bool has_status = false;
  bool is_partial = false;
};

Console& console() {
  static Console console;
  return console;
}

/// Writes all of a text.
/// @return 0, or the error's number
int write_all(int stream, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t count = write(stream, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      pollfd ready{stream, POLLOUT, 0};
      if (poll(&ready, 1, -1) < 0 && errno != EINTR) return errno;
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

void flush(Console& console) {
  if (console.lost == 0) console.lost = write_all(STDOUT_FILENO, console.results);
  console.results.clear();
}

void remove_status(Console& console) {
  if (!console.has_status) return;
  console.has_status = false;
  write_all(STDERR_FILENO, "\r\x1b[K");
}

/// Opens a stream that is closed, in a way that makes using it an error.
void occupy(int stream) {
  if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) return;
  // The lowest free number is this one, since those below are taken.
  (void)open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

/// Turns what the libraries can't go on with into a line and a status instead of an abort.
[[noreturn]] void end_by_exception() {
  int status = kUnexpected;
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    tell("freepath: internal error: terminated\n");
  } catch (const std::exception& error) {
    status = tell_unexpected(error);
  } catch (...) {
    tell("freepath: internal error: unknown reason\n");
  }
  _exit(status);
}

}  // namespace

void prepare_console() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) occupy(stream);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(end_by_exception);
  console().lost = 0;
  console().is_partial = false;
}

void note_partial_result() {
  const std::lock_guard lock(console().mutex);
  console().is_partial = true;
}

int tell_unexpected(const std::exception& error) {
  const std::string reason = error.what();
  const auto* const system = dynamic_cast<const std::system_error*>(&error);
  const bool no_threads = reason.find("pthread_create") != std::string::npos ||
                          (system != nullptr && system->code().value() == EAGAIN);
  if (no_threads) {
    tell("freepath: error: the system grants no more threads ({}); give fewer --threads\n", reason);
    return 1;
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    tell("freepath: error: out of memory\n");
    return 1;
  }
  tell("freepath: internal error: {}\n", reason);
  return kUnexpected;
}

int finish_console(int status) {
  int lost = 0;
  {
    const std::lock_guard lock(console().mutex);
    flush(console());
    remove_status(console());
    lost = console().lost;
    if (status == 0 && console().is_partial) status = kPartialStatus;
  }
  if (lost == 0) return status;
  if (lost != EPIPE) {
    tell("freepath: error: can't write to standard output: {}\n",
         std::generic_category().message(lost));
  }
  if (status != 0) return status;
  return lost == EPIPE ? kEndedByPipe : 1;
}

void put_output(std::string_view text) {
  const std::lock_guard lock(console().mutex);
  console().results += text;
  if (console().results.size() > kLargestBuffer || isatty(STDOUT_FILENO) != 0) {
    remove_status(console());
    flush(console());
  }
}

void put_message(std::string_view text) {
  const std::lock_guard lock(console().mutex);
  remove_status(console());
  write_all(STDERR_FILENO, text);
}

void show_status(std::string_view text) {
  if (isatty(STDERR_FILENO) == 0) return;
  const std::lock_guard lock(console().mutex);
  // A terminal that is halted (Ctrl-S) must not halt the work.
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  if (poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0) return;
  write_all(STDERR_FILENO, fmt::format("\r{}\x1b[K", printable(text)));
  console().has_status = true;
}

void clear_status() {
  const std::lock_guard lock(console().mutex);
  remove_status(console());
}

}  // namespace freepath::program
