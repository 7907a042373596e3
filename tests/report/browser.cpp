#include "tests/report/browser.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "freepath/io/image_codec.h"

namespace freepath::testing {

namespace {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

}  // namespace

uint32_t Screenshot::at(int column, int row) const {
  const uint8_t* pixel = &pixels[3 * (static_cast<std::size_t>(row) * width + column)];
  return static_cast<uint32_t>(pixel[0] << 16 | pixel[1] << 8 | pixel[2]);
}

std::size_t Screenshot::count_near(const std::string& colour, int tolerance) const {
  const int wanted = std::stoi(colour.substr(1), nullptr, 16);
  const int channels[] = {wanted >> 16, wanted >> 8 & 0xFF, wanted & 0xFF};
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    bool is_near = true;
    for (int k = 0; k < 3; ++k) is_near &= std::abs(pixels[i + k] - channels[k]) <= tolerance;
    if (is_near) ++count;
  }
  return count;
}

std::size_t Screenshot::colour_count() const {
  std::set<uint32_t> colours;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) colours.insert(at(column, row));
  }
  return colours.size();
}

std::optional<std::string> Browser::find() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (fs::is_regular_file(fs::path(folder) / name)) return name;
    }
  }
  return std::nullopt;
}

Browser::Browser(std::string program, fs::path folder)
    : program_(std::move(program)), folder_(std::move(folder)) {}

void Browser::run(const std::string& address, const std::string& options,
                  const fs::path& output) const {
  const std::string command = fmt::format(
      "timeout 300 {} --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage "
      "--hide-scrollbars --no-first-run --virtual-time-budget=4000 --user-data-dir={} {} {} "
      ">{} 2>{}",
      program_, quoted(folder_ / "profile"), options, quoted("file://" + address), quoted(output),
      quoted(folder_ / "messages"));
  const int status = std::system(command.c_str());
  if (status != 0) {
    throw std::runtime_error(
        fmt::format("{}\nended with {}: {}", command, status, read_bytes(folder_ / "messages")));
  }
}

std::string Browser::document(const std::string& address, const std::string& options) const {
  run(address, "--dump-dom --window-size=1280,1000 " + options, folder_ / "document");
  return read_bytes(folder_ / "document");
}

Screenshot Browser::screenshot(const std::string& address, int width, int height,
                               const std::string& options) const {
  const fs::path file = folder_ / "screenshot.png";
  fs::remove(file);
  run(address,
      fmt::format("--screenshot={} --window-size={},{} {}", quoted(file), width, height, options),
      folder_ / "output");
  Image image;
  bool srgb = false;
  int alpha = -1;
  const std::string reason =
      image_codec().read(file.string(), fs::file_size(file), image, srgb, alpha);
  if (!reason.empty()) throw std::runtime_error("there is no screenshot: " + reason);
  Screenshot result{image.width, image.height};
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float* const pixel = image.values.data() + i * image.channels.size();
    for (int c = 0; c < 3; ++c) {
      result.pixels.push_back(static_cast<uint8_t>(std::lround(255.0F * pixel[c])));
    }
  }
  return result;
}

std::string Browser::print(const std::string& address) const {
  const fs::path file = folder_ / "printed.pdf";
  fs::remove(file);
  run(address, "--no-pdf-header-footer --print-to-pdf=" + quoted(file), folder_ / "output");
  return read_bytes(file);
}

}  // namespace freepath::testing
