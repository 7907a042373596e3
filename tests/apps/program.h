#pragma once
/// @file Running the program as a user does: arguments in; exit status, output and files out.

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace freepath::testing {

/// How a run of the program ended, and what it said.
struct Outcome {
  int status = -1;         ///< Exit status, -1 if it ended otherwise.
  int signal = 0;          ///< The signal that ended it, 0 if none did.
  bool timed_out = false;  ///< It was still running after the time allowed.
  std::string output;      ///< Standard output.
  std::string messages;    ///< Standard error.
};

/// For a test's message.
std::ostream& operator<<(std::ostream& stream, const Outcome& outcome);

/// Words of a command line separated by blanks.
std::vector<std::string> words(const std::string& line);

/// Calls the program as a function, in a folder, its outputs kept apart: as good as starting it,
/// but sooner done, since a process takes a third of a second to load its libraries.
/// @param clock of the program; empty: the machine's
Outcome call_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                     const std::function<double()>& clock = {});

/// Time after which a process is ended that hangs: far more than any test takes on any machine.
inline constexpr std::chrono::minutes kAllowed(10);

/// Starts the program in a folder, its outputs kept apart, and waits for it; a run that takes
/// longer than allowed is ended.
Outcome start_program(const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder, std::chrono::seconds allowed = kAllowed);

/// Starts the program with a terminal for its standard error. `on_text` is called with all that it
/// has said there so far whenever it says something, and with the process.
Outcome start_in_terminal(const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder,
                          const std::function<void(const std::string&, int)>& on_text,
                          std::chrono::seconds allowed = kAllowed);

/// Samples of each pixel that the last status line of a render shows to be done; 0: none is shown.
double samples_shown(const std::string& text);

/// A folder of its own for each test, removed at its end.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  std::string path(const std::string& name) const { return folder_ / name; }
  /// Calls the program with a command line, in the folder.
  Outcome run(const std::string& line, const std::function<double()>& clock = {}) const {
    return call_program(words(line), folder_, clock);
  }
  /// Starts it as a process of its own.
  Outcome start(const std::string& line) const { return start_program(words(line), folder_); }
  /// Runs a line of a shell in the folder, in which `freepath` is the program; a program that a
  /// signal ends has 128 and its number for its status.
  Outcome shell(const std::string& line) const;
  /// Names of the files in the folder, sorted.
  std::vector<std::string> files() const;

  std::filesystem::path folder_;
};

}  // namespace freepath::testing
