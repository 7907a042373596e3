#include "tests/apps/program.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <ostream>
#include <sstream>
#include <thread>

#include "apps/freepath/run.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Starts the program; returns its process.
pid_t start(const std::vector<std::string>& arguments, const fs::path& folder, int output,
            int messages) {
  std::vector<char*> pointers;
  std::string program = FREEPATH_PROGRAM;
  pointers.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const std::string path = folder;
  const pid_t process = fork();
  if (process != 0) return process;
  const int input = open("/dev/null", O_RDONLY);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(messages, STDERR_FILENO);
  if (chdir(path.c_str()) == 0) execv(program.c_str(), pointers.data());
  _exit(127);
}

void set_end(Outcome& outcome, int wait_status) {
  if (WIFEXITED(wait_status)) outcome.status = WEXITSTATUS(wait_status);
  if (WIFSIGNALED(wait_status)) outcome.signal = WTERMSIG(wait_status);
}

/// Waits for a process; between two looks at it, `meanwhile` is called.
void wait_for(pid_t process, Clock::time_point start, std::chrono::seconds allowed,
              Outcome& outcome, const std::function<void()>& meanwhile) {
  int wait_status = 0;
  while (waitpid(process, &wait_status, WNOHANG) == 0) {
    if (Clock::now() - start > allowed && !outcome.timed_out) {
      outcome.timed_out = true;
      kill(process, SIGKILL);
    }
    meanwhile();
  }
  set_end(outcome, wait_status);
}

/// A file for what the program says, outside the folder that it works in.
fs::path capture_file(const char* name) {
  return fs::path(::testing::TempDir()) / ("freepath_" + std::to_string(getpid()) + "." + name);
}

/// While one lives, what is written to a standard stream goes to a file, and then into a text.
class Capture {
 public:
  Capture(int stream, const fs::path& file, std::string& text)
      : stream_(stream), file_(file), text_(text) {
    flush();
    before_ = dup(stream_);
    const int capture = open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
    dup2(capture, stream_);
    close(capture);
  }
  ~Capture() {
    flush();
    dup2(before_, stream_);
    close(before_);
    text_ = read_text(file_);
    fs::remove(file_);
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

 private:
  static void flush() {
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
  }

  int stream_;
  int before_ = -1;
  fs::path file_;
  std::string& text_;
};

}  // namespace

std::ostream& operator<<(std::ostream& stream, const Outcome& outcome) {
  return stream << "status " << outcome.status << ", signal " << outcome.signal
                << (outcome.timed_out ? ", timed out" : "") << "\noutput: " << outcome.output
                << "\nmessages: " << outcome.messages;
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

Outcome call_program(const std::vector<std::string>& arguments, const fs::path& folder,
                     const std::function<double()>& clock) {
  std::vector<const char*> pointers{FREEPATH_PROGRAM};
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  Outcome outcome;
  {
    const Capture output(STDOUT_FILENO, capture_file("output"), outcome.output);
    const Capture messages(STDERR_FILENO, capture_file("messages"), outcome.messages);
    outcome.status = program::run(static_cast<int>(pointers.size()), pointers.data(), clock);
  }
  fs::current_path(before);
  return outcome;
}

Outcome start_program(const std::vector<std::string>& arguments, const fs::path& folder,
                      std::chrono::seconds allowed) {
  const fs::path output_file = capture_file("output");
  const fs::path messages_file = capture_file("messages");
  const int output = open(output_file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const int messages = open(messages_file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  Outcome outcome;
  const Clock::time_point begin = Clock::now();
  wait_for(start(arguments, folder, output, messages), begin, allowed, outcome,
           [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
  close(output);
  close(messages);
  outcome.output = read_text(output_file);
  outcome.messages = read_text(messages_file);
  fs::remove(output_file);
  fs::remove(messages_file);
  return outcome;
}

Outcome start_in_terminal(const std::vector<std::string>& arguments, const fs::path& folder,
                          const std::function<void(const std::string&, int)>& on_text,
                          std::chrono::seconds allowed) {
  Outcome outcome;
  int terminal = -1;
  int program_side = -1;
  if (openpty(&terminal, &program_side, nullptr, nullptr, nullptr) != 0) return outcome;
  fcntl(terminal, F_SETFD, FD_CLOEXEC);
  fcntl(program_side, F_SETFD, FD_CLOEXEC);
  const int output = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const Clock::time_point begin = Clock::now();
  const pid_t process = start(arguments, folder, output, program_side);
  close(program_side);
  close(output);
  const auto read_some = [&](int milliseconds) {
    pollfd ready{terminal, POLLIN, 0};
    char text[4096];
    if (poll(&ready, 1, milliseconds) <= 0) return false;
    const ssize_t count = read(terminal, text, sizeof(text));
    if (count <= 0) return false;  // the program has closed its side
    outcome.messages.append(text, static_cast<std::size_t>(count));
    return true;
  };
  wait_for(process, begin, allowed, outcome, [&] {
    if (read_some(5)) on_text(outcome.messages, process);
  });
  while (read_some(0)) continue;
  close(terminal);
  return outcome;
}

double samples_shown(const std::string& text) {
  const std::size_t end = text.rfind(" samples  ");  // "12/64 samples  1.20 M samples/s"
  if (end == std::string::npos || end == 0) return 0;
  const std::size_t begin = text.rfind(' ', end - 1);
  return std::atof(text.c_str() + (begin == std::string::npos ? 0 : begin + 1));
}

ProgramTest::ProgramTest() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ = fs::path(::testing::TempDir()) /
            ("freepath_program_" + std::string(test->name()) + std::to_string(getpid()));
  fs::create_directories(folder_);
  // Where the tester's environment has a denoiser, the program would find it.
  for (const char* name : {"FREEPATH_OIDN", "VIRTUAL_ENV"}) unsetenv(name);
}

ProgramTest::~ProgramTest() { fs::remove_all(folder_); }

Outcome ProgramTest::shell(const std::string& line) const {
  const fs::path output = capture_file("output");
  const fs::path messages = capture_file("messages");
  const fs::path script = capture_file("script");
  std::ofstream(script) << "freepath() { \"" FREEPATH_PROGRAM "\" \"$@\"; }\ncd "
                        << folder_.string() << "\n{ " << line << "\n} >" << output.string() << " 2>"
                        << messages.string() << '\n';
  Outcome outcome;
  set_end(outcome, std::system(("bash " + script.string()).c_str()));
  outcome.output = read_text(output);
  outcome.messages = read_text(messages);
  for (const fs::path& file : {output, messages, script}) fs::remove(file);
  return outcome;
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace freepath::testing
