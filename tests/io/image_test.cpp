#include "freepath/io/image.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

#include "freepath/base/error.h"
#include "freepath/io/invalid_values.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed at its end.
class ImageTest : public ::testing::Test {
 protected:
  ImageTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) /
              ("freepath_image_" + std::string(test->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  ~ImageTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ / name; }

  std::size_t files_in_folder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

/// 3×2 pixels whose values tell where they are: 100 · row + 10 · column + channel.
Image numbered_image(std::vector<std::string> channels) {
  Image image{.width = 3, .height = 2, .channels = std::move(channels)};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      for (std::size_t channel = 0; channel < image.channels.size(); ++channel) {
        image.values.push_back(static_cast<float>(100 * row + 10 * column + channel) + 0.1F);
      }
    }
  }
  return image;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const std::function<void()>& action, const std::string& part) {
  const std::string message = message_of(action);
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST_F(ImageTest, ExrKeepsEveryChannelBitForBit) {
  const Image written = numbered_image({"R", "G", "B", "A", "variance.R", "depth.Z", "lookups"});
  write_exr(path("a.exr"), written);
  const Image read = read_image(path("a.exr"));
  ASSERT_EQ(read.width, 3);
  ASSERT_EQ(read.height, 2);
  ASSERT_EQ(read.channels.size(), written.channels.size());
  for (std::size_t channel = 0; channel < written.channels.size(); ++channel) {
    const auto found = find_channel(read, written.channels[channel]);
    ASSERT_TRUE(found) << written.channels[channel];
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 3; ++column) {
        EXPECT_EQ(read.pixel(column, row)[*found], written.pixel(column, row)[channel]);
      }
    }
  }
}

TEST_F(ImageTest, ExrKeepsMetadata) {
  Image image = numbered_image({"R", "G", "B"});
  image.metadata = {{"freepath:seed", int64_t{7}},
                    {"freepath:paths", int64_t{10'000'000'000}},
                    {"freepath:seconds", 0.1},
                    {"freepath:tracker", std::string("delta")}};
  write_exr(path("a.exr"), image);
  const Image read = read_image(path("a.exr"));
  const auto value = [&](const std::string& name) {
    for (const auto& [key, value] : read.metadata) {
      if (key == name) return value;
    }
    return MetadataValue("missing");
  };
  EXPECT_EQ(value("freepath:seed"), MetadataValue(int64_t{7}));
  EXPECT_EQ(value("freepath:paths"), MetadataValue("10000000000"));
  EXPECT_EQ(value("freepath:seconds"), MetadataValue(0.1));
  EXPECT_EQ(value("freepath:tracker"), MetadataValue("delta"));
}

TEST_F(ImageTest, HalfPrecisionStaysFinite) {
  Image image = numbered_image({"R", "G", "B"});
  image.values[0] = 1e6F;
  write_exr(path("a.exr"), image, {.precision = ExrPrecision::kHalf});
  const Image read = read_image(path("a.exr"));
  EXPECT_EQ(read.values[0], 65504.0F);
  EXPECT_NEAR(read.values[1], 1.1F, 1.1F / 2048);
}

TEST_F(ImageTest, PngAppliesExposureAndTheTransferFunction) {
  Image image = numbered_image({"R", "G", "B"});
  image.values.assign(image.values.size(), 0.125F);
  image.values[0] = -1;
  image.values[1] = 1e9F;
  image.values[2] = NAN;
  write_png(path("a.png"), image, {.exposure = 2});
  const Image read = read_image(path("a.png"));
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(read.values[0], 0);
  EXPECT_EQ(read.values[1], 1);
  EXPECT_EQ(read.values[2], 0);
  // Read back linear; a step of 8 bits is 0.0068 there.
  EXPECT_NEAR(read.values[3], 0.5F, 0.0034F);
}

TEST_F(ImageTest, TheTransferFunctionHasThePublishedValues) {
  EXPECT_NEAR(srgb_from_linear(0.5F), 0.735357F, 1e-5);  // IEC 61966-2-1
  EXPECT_NEAR(srgb_from_linear(1.0F), 1.0F, 1e-6);
  for (float value = 0; value <= 1; value += 1.0F / 64) {
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(value)), value, 1e-6);
  }
}

TEST_F(ImageTest, AnOldFileIsReplacedAndNothingElseIsLeft) {
  write_exr(path("a.exr"), numbered_image({"Y"}));
  write_exr(path("a.exr"), numbered_image({"R", "G", "B"}));
  EXPECT_EQ(read_image(path("a.exr")).channels.size(), 3);
  EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(ImageTest, WritingThroughALinkKeepsTheLink) {
  write_exr(path("a.exr"), numbered_image({"Y"}));
  fs::create_symlink("a.exr", path("link.exr"));
  write_exr(path("link.exr"), numbered_image({"R", "G", "B"}));
  EXPECT_TRUE(fs::is_symlink(path("link.exr")));
  EXPECT_EQ(read_image(path("a.exr")).channels.size(), 3);
}

TEST_F(ImageTest, TargetsThatCannotBeWrittenAreNamedBeforeRendering) {
  expect_message([&] { check_writable(path("no/a.exr")); }, "does not exist");
  expect_message([&] { check_writable(path("a.gif")); }, "use .exr, .png, .pfm or .qoi");
  expect_message([&] { check_writable(path("a")); }, "use .exr, .png, .pfm or .qoi");
  fs::create_directory(path("folder.exr"));
  expect_message([&] { check_writable(path("folder.exr")); }, "is a directory");
  write_exr(path("a.exr"), numbered_image({"Y"}));
  fs::permissions(path("a.exr"), fs::perms::owner_read);
  expect_message([&] { check_writable(path("a.exr")); }, "read-only");
  expect_message([&] { write_exr(path("a.exr"), numbered_image({"Y"})); }, path("a.exr"));
  EXPECT_EQ(message_of([&] { check_writable(path("new.PNG")); }), "no error");
  EXPECT_EQ(message_of([&] { check_writable("here.exr"); }), "no error");
}

TEST_F(ImageTest, FilesThatCannotBeReadAreNamed) {
  expect_message([&] { read_image(path("none.exr")); }, "none.exr: no such file");
  expect_message([&] { read_image(folder_); }, "is a directory; name an image");
  std::ofstream(path("text.exr")) << "not an image";
  expect_message([&] { read_image(path("text.exr")); }, "text.exr: can't read");
  std::ofstream(path("empty.hdr")).close();
  expect_message([&] { read_image(path("empty.hdr")); }, "empty.hdr: can't read");
}

TEST_F(ImageTest, ATruncatedFileIsAnError) {
  Image image{.width = 64, .height = 64, .channels = {"R", "G", "B"}};
  for (int i = 0; i < 64 * 64 * 3; ++i) image.values.push_back(std::sin(static_cast<float>(i)));
  write_exr(path("a.exr"), image);
  fs::resize_file(path("a.exr"), fs::file_size(path("a.exr")) / 2);
  expect_message([&] { read_image(path("a.exr")); }, "a.exr: can't read");
}

// A few bytes that would take 4.8 GB.
TEST_F(ImageTest, AHeaderAloneCostsNothing) {
  std::ofstream(path("a.hdr")) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 20000\n";
  expect_message([&] { read_image(path("a.hdr")); },
                 "a.hdr: it declares 20000x20000 pixels, but has only 53 bytes");
  // Small enough to be a file of one value: refused once nothing comes.
  std::ofstream(path("b.hdr")) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000 +X 2000\n";
  expect_message([&] { read_image(path("b.hdr")); }, "b.hdr: can't read");
}

/// Changes the bytes of a file behind the one place where a text stands.
void change_behind(const std::string& file, std::string_view text, std::string_view bytes) {
  std::ifstream input(file, std::ios::binary);
  std::string content(std::istreambuf_iterator<char>(input), {});
  const std::size_t at = content.find(text);
  ASSERT_NE(at, std::string::npos);
  content.replace(at + text.size(), bytes.size(), bytes);
  std::ofstream(file, std::ios::binary) << content;
}

// OpenEXR would take up to 2 GB for each.
TEST_F(ImageTest, AttributesOfAnExrHaveTheSizesOfTheirTypes) {
  using namespace std::string_view_literals;
  Image image = numbered_image({"R", "G", "B"});
  image.metadata = {{"note", std::string("text")}};
  const auto expect_damaged = [&](std::string_view text, std::string_view bytes,
                                  const std::string& message) {
    write_exr(path("a.exr"), image);
    change_behind(path("a.exr"), text, bytes);
    expect_message([&] { read_image(path("a.exr")); }, "a.exr: the attribute " + message);
  };
  expect_damaged("note\0string\0"sv, "true"sv,
                 "note in its header is said to take 1702195828 bytes, but ");
  expect_damaged("note\0string\0"sv, "\xFF\xFF\xFF\xFF"sv,
                 "note in its header is said to take 4294967295 bytes, but ");
  expect_damaged("dataWindow\0box2i\0"sv, "\x0F"sv, "dataWindow in its header is no box2i of 15 ");
  expect_damaged("channels\0chlist\0"sv, "6"sv, "channels in its header is no chlist of 54 ");
  // What has other types is taken for what it says: two texts, and a picture of 1000 x 1000.
  expect_damaged("note\0"sv, "stringvector\0\x04\0\0\0\xFF\xFF\xFF\x7F"sv,
                 "note in its header is no stringvector of 4 ");
  expect_damaged("note\0"sv, "preview\0\x08\0\0\0\xE8\x03\0\0\xE8\x03\0\0"sv,
                 "note in its header is no preview of 8 ");
}

// A chunk of rows is 2^20 values at most; each has to arrive in its place.
TEST_F(ImageTest, ManyRowsArriveInTheirPlaces) {
  Image image{.width = 3000, .height = 700, .channels = {"Y"}};
  image.values.resize(image.pixel_count());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const std::size_t row = i / 3000;
    image.values[i] = static_cast<float>(row * 1000 + i % 7);
  }
  write_exr(path("a.exr"), image);
  EXPECT_EQ(read_image(path("a.exr")).values, image.values);
}

/// No memory beyond what is taken now and some more, while this lives.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;  // the first number of the file
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * sysconf(_SC_PAGESIZE) + bytes, before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
};

// For one row of so many OpenImageIO would take a gigabyte, as for 256 of them. (OpenEXR takes
// memory for each thread, so that a limit would depend on the machine.)
TEST_F(ImageTest, AWideImageTakesItsOwnMemoryAlone) {
  constexpr int kWidth = 1 << 19;
  std::string pixels;
  for (int i = 0; i < kWidth; ++i) pixels += {char(-128), char(i % 100 + 20), 64, char(-127)};
  std::ofstream(path("a.hdr"), std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X " << kWidth << "\n"
      << pixels;
  const std::vector<float> values = read_image(path("a.hdr")).values;  // which starts all threads
  ASSERT_EQ(values.size(), 3U * kWidth);
  EXPECT_NEAR(values[3 * 57], 1, 0.01);
  EXPECT_NEAR(values[3 * 57 + 1], 77.0 / 128, 0.01);
  const MemoryLimit limit(std::size_t{256} << 20);
  EXPECT_EQ(read_image(path("a.hdr")).values, values);
}

// OpenEXR takes memory for rows that are packed together before anyone can ask how many there are.
TEST_F(ImageTest, AnExrCostsNoMoreThanItDelivers) {
  write_exr(path("a.exr"), numbered_image({"R", "G", "B", "A"}));
  std::ifstream file(path("a.exr"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  const std::string head("dataWindow\0box2i\0\x10\0\0\0", 21);
  const std::size_t window = whole.find(head) + head.size();
  ASSERT_LT(window, whole.size());
  const auto message_for = [&](int32_t x_max, int32_t y_max) {
    std::string changed = whole;
    const int32_t box[] = {0, 0, x_max, y_max};
    std::memcpy(changed.data() + window, box, sizeof(box));
    std::ofstream(path("b.exr"), std::ios::binary) << changed;
    const MemoryLimit limit(std::size_t{256} << 20);
    return message_of([&] { read_image(path("b.exr")); });
  };
  EXPECT_NE(message_for(6'894'083, 4096).find("6894084x4097 pixels"), std::string::npos);
  EXPECT_NE(message_for(1'500'000, 0).find("packed in parts"), std::string::npos);
  EXPECT_EQ(message_of([&] { read_image(path("a.exr")); }), "no error");
}

// However few bytes are missing: what is written last is, too.
TEST_F(ImageTest, AnExrThatDoesNotFitTheDiskIsAnError) {
  // The last row is packed alone, and so short that it waits for the stream's end.
  Image image{.width = 60, .height = 33, .channels = {"R", "G", "B"}};
  for (int i = 0; i < 60 * 33 * 3; ++i) image.values.push_back(std::sin(static_cast<float>(i)));
  write_exr(path("a.exr"), image);
  const std::size_t size = fs::file_size(path("a.exr"));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const std::size_t missing : {std::size_t{1}, std::size_t{3000}, size - 600}) {
    const rlimit small{size - missing, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = message_of([&] { write_exr(path("b.exr"), image); });
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(message.find("b.exr"), std::string::npos) << missing << ": " << message;
    EXPECT_FALSE(fs::exists(path("b.exr")));
  }
  std::signal(SIGXFSZ, handler);
}

TEST_F(ImageTest, InvalidPixelsBecomeZeroOrAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Image image = numbered_image({"R", "G", "B", "depth"});
  image.pixel(1, 0)[1] = nan;
  image.pixel(2, 1)[0] = -std::numeric_limits<float>::infinity();
  image.pixel(2, 1)[2] = nan;
  image.pixel(0, 0)[3] = nan;  // no colour
  Image mended = image;
  EXPECT_EQ(
      mend_invalid_pixels(mended, "a.exr", InvalidPolicy::kZero),
      "a.exr: 2 pixels with values that are NaN or infinite were taken as 0; the first: pixel "
      "(1, 0) is NaN");
  EXPECT_EQ(mended.pixel(1, 0)[1], 0);
  EXPECT_EQ(mended.pixel(2, 1)[0], 0);
  EXPECT_EQ(mended.pixel(2, 1)[2], 0);
  EXPECT_EQ(mended.pixel(2, 1)[1], image.pixel(2, 1)[1]);
  EXPECT_TRUE(std::isnan(mended.pixel(0, 0)[3]));
  expect_message([&] { mend_invalid_pixels(image, "a.exr", InvalidPolicy::kError); },
                 "a.exr: pixel (1, 0) is NaN; repair the image, or have such values taken as 0");
  EXPECT_EQ(mend_invalid_pixels(mended, "a.exr", InvalidPolicy::kError), "");
}

TEST_F(ImageTest, ColourIsFoundByNameAndNeverGuessed) {
  EXPECT_EQ(colour_channels(numbered_image({"A", "B", "G", "R"}), "x"),
            (std::array<int, 3>{3, 2, 1}));
  EXPECT_EQ(colour_channels(numbered_image({"Y", "A"}), "x"), (std::array<int, 3>{0, 0, 0}));
  expect_message(
      [] {
        colour_channels(numbered_image({"u", "v"}), "x.exr");
      },
      "x.exr: no channels R, G, B (or Y) among u, v");
}

TEST_F(ImageTest, AnInconsistentImageIsRefused) {
  Image image = numbered_image({"R", "G", "B"});
  image.values.pop_back();
  expect_message([&] { write_exr(path("a.exr"), image); }, "do not agree");
}

}  // namespace
}  // namespace freepath
