#pragma once
/// @file Renderings in parts, and what is to be the same about them.

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <string>

#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {

/// A folder with a volume, ball.vdb, that lines of the program render.
class FilmsTest : public ProgramTest {
 protected:
  FilmsTest() { write_cube(path("ball.vdb")); }

  /// Runs a line that has to go well.
  void expect_done(const std::string& line) const {
    const Outcome outcome = run(line);
    ASSERT_EQ(outcome.status, 0) << line << '\n' << outcome;
  }

  /// Checks that a line is refused, with these words.
  void expect_refused(const std::string& line, const std::string& text) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 1) << line << '\n' << outcome;
    EXPECT_NE(outcome.messages.find(text), std::string::npos) << line << '\n' << outcome;
  }

  void expect_same_pixels(const std::string& a, const std::string& b) const {
    const Image first = read_image(path(a));
    const Image second = read_image(path(b));
    ASSERT_EQ(first.channels, second.channels);
    ASSERT_EQ(first.values.size(), second.values.size());
    for (std::size_t i = 0; i < first.values.size(); ++i) {
      ASSERT_EQ(std::bit_cast<uint32_t>(first.values[i]), std::bit_cast<uint32_t>(second.values[i]))
          << a << " and " << b << ": " << first.channels[i % first.channels.size()];
    }
  }
};

/// How often to try what is random: a few times, or as often as FREEPATH_TRIALS says.
inline int trials(int usual) {
  const char* const text = std::getenv("FREEPATH_TRIALS");
  return text == nullptr ? usual : std::atoi(text);
}

}  // namespace freepath::testing
