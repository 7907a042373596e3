#pragma once
/// @file A browser without a window, for tests of pages.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace freepath::testing {

/// What a browser shows: three bytes for each pixel, row 0 is the top.
struct Screenshot {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels = {};

  /// 0xRRGGBB
  uint32_t at(int column, int row) const;
  /// Number of pixels whose channels are this close to a colour "#rrggbb".
  std::size_t count_near(const std::string& colour, int tolerance = 3) const;
  /// Number of different colours.
  std::size_t colour_count() const;
};

/// Runs Chromium once for each question, in a folder for its own files.
class Browser {
 public:
  /// The program's name in the path; nothing where there is none.
  static std::optional<std::string> find();

  /// @param folder exists, and may be written to
  Browser(std::string program, std::filesystem::path folder);

  /// The document once scripts and timers are done.
  /// @param address of a file: its path, with a query where one is wanted
  std::string document(const std::string& address, const std::string& options = "") const;
  Screenshot screenshot(const std::string& address, int width, int height,
                        const std::string& options = "") const;
  /// The bytes of a PDF file.
  std::string print(const std::string& address) const;

 private:
  void run(const std::string& address, const std::string& options,
           const std::filesystem::path& output) const;

  std::string program_;
  std::filesystem::path folder_;
};

}  // namespace freepath::testing
