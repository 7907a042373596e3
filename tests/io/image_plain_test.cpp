// Image formats that are written here: byte for byte, and read back.

#include "freepath/io/image_plain.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "freepath/base/error.h"

namespace freepath::testing {
namespace {

using Bytes = std::vector<uint8_t>;

TEST(Pfm, HoldsRowsFromTheBottomInSinglePrecision) {
  Image image{2, 2, {"A", "R", "G", "B"}};
  for (int i = 0; i < 16; ++i) image.values.push_back(0.5F + static_cast<float>(i));
  const Bytes bytes = encode_pfm(image, "a.pfm");
  const std::string header = "PF\n2 2\n-1.0\n";
  ASSERT_EQ(bytes.size(), header.size() + 12 * 4);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + static_cast<long>(header.size())), header);
  std::array<float, 12> values{};
  std::memcpy(values.data(), bytes.data() + header.size(), sizeof(values));
  // R, G, B are channels 1 to 3; row 1 comes first.
  EXPECT_EQ(values, (std::array<float, 12>{9.5F, 10.5F, 11.5F, 13.5F, 14.5F, 15.5F, 1.5F, 2.5F,
                                           3.5F, 5.5F, 6.5F, 7.5F}));
  EXPECT_THROW(encode_pfm({1, 1, {"depth", "lookups"}, {1, 2}}, "a.pfm"), Error);
}

/// By the specification: what each operation stands for.
Bytes decode_qoi(const Bytes& bytes) {
  const auto number = [&](std::size_t at) {
    return uint32_t{bytes[at]} << 24 | uint32_t{bytes[at + 1]} << 16 |
           uint32_t{bytes[at + 2]} << 8 | bytes[at + 3];
  };
  const std::size_t size = std::size_t{number(4)} * number(8) * 3;
  std::array<std::array<uint8_t, 4>, 64> seen{};
  std::array<uint8_t, 4> pixel = {0, 0, 0, 255};
  Bytes pixels;
  std::size_t at = 14;
  while (pixels.size() < size) {
    const uint8_t tag = bytes.at(at++);
    int run = 1;
    if (tag == 0xFE) {
      for (int c = 0; c < 3; ++c) pixel[c] = bytes.at(at++);
    } else if (tag >> 6 == 0) {
      pixel = seen[tag];
    } else if (tag >> 6 == 1) {
      pixel[0] = static_cast<uint8_t>(pixel[0] + (tag >> 4 & 3) - 2);
      pixel[1] = static_cast<uint8_t>(pixel[1] + (tag >> 2 & 3) - 2);
      pixel[2] = static_cast<uint8_t>(pixel[2] + (tag & 3) - 2);
    } else if (tag >> 6 == 2) {
      const uint8_t more = bytes.at(at++);
      const int green = (tag & 63) - 32;
      pixel[0] = static_cast<uint8_t>(pixel[0] + green - 8 + (more >> 4));
      pixel[1] = static_cast<uint8_t>(pixel[1] + green);
      pixel[2] = static_cast<uint8_t>(pixel[2] + green - 8 + (more & 15));
    } else {
      run = (tag & 63) + 1;
    }
    for (int i = 0; i < run; ++i) pixels.insert(pixels.end(), pixel.begin(), pixel.begin() + 3);
    seen[(pixel[0] * 3 + pixel[1] * 5 + pixel[2] * 7 + pixel[3] * 11) % 64] = pixel;
  }
  EXPECT_EQ(Bytes(bytes.begin() + static_cast<long>(at), bytes.end()),
            (Bytes{0, 0, 0, 0, 0, 0, 0, 1}));
  return pixels;
}

// Each operation once: a run of black, from which it starts; all three values; small changes, also
// around 0; changes with that of green; a pixel that was there before; a run.
TEST(Qoi, HasTheBytesOfItsSpecification) {
  const Bytes pixels = {0,   0,   0,  0,   0,   0,  100, 50,  200, 101, 48, 199, 111, 63,
                        206, 100, 50, 200, 100, 50, 200, 255, 255, 255, 0,  0,   1};
  const Bytes bytes = encode_qoi(9, 1, pixels);
  const Bytes expected = {'q',
                          'o',
                          'i',
                          'f',
                          0,
                          0,
                          0,
                          9,
                          0,
                          0,
                          0,
                          1,
                          3,
                          0,
                          0xC1,  // run of 2
                          0xFE,
                          100,
                          50,
                          200,                         // R, G, B
                          0x40 | 3 << 4 | 0 << 2 | 1,  // +1 -2 -1
                          0x80 | (15 + 32),
                          (10 - 15 + 8) << 4 | (7 - 15 + 8),
                          (100 * 3 + 50 * 5 + 200 * 7 + 255 * 11) % 64,  // seen before
                          0xC0,                                          // run of 1
                          0xFE,
                          255,
                          255,
                          255,
                          0x80 | (1 + 32),
                          8 << 4 | 9,  // +1 +1, and +2 is no small change
                          0,
                          0,
                          0,
                          0,
                          0,
                          0,
                          0,
                          1};
  EXPECT_EQ(decode_qoi(bytes), pixels);
  EXPECT_EQ(bytes, expected);
}

TEST(Qoi, KeepsEveryPixel) {
  Bytes pixels;
  uint32_t state = 1;
  const auto next = [&] { return (state = state * 1664525U + 1013904223U) >> 16; };
  uint8_t last[3] = {};
  for (int i = 0; i < 64 * 64; ++i) {
    // Runs, longer than one operation holds, small and large steps, and noise.
    const uint32_t kind = i < 300 ? 0 : next() % 4;
    for (uint8_t& value : last) {
      if (kind == 1) value = static_cast<uint8_t>(value + next() % 5 - 2);
      if (kind == 2) value = static_cast<uint8_t>(value + next() % 31 - 15);
      if (kind == 3 && next() % 8 == 0) value = static_cast<uint8_t>(next());
    }
    pixels.insert(pixels.end(), last, last + 3);
  }
  const Bytes bytes = encode_qoi(64, 64, pixels);
  EXPECT_EQ(decode_qoi(bytes), pixels);
  EXPECT_LT(bytes.size(), pixels.size());
}

TEST(PlainImages, AreWrittenByTheirExtension) {
  const std::string folder = ::testing::TempDir();
  Image image{2, 1, {"R", "G", "B"}, {0.5F, 2, 0, 1, 0, 0.25F}};
  for (const std::string name : {"plain.PFM", "plain.qoi"}) {
    EXPECT_TRUE(is_plain_image(name));
    write_plain_image(folder + name, image, {.exposure = -1});
    std::ifstream file(folder + name, std::ios::binary);
    const Bytes found{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(found, name == "plain.PFM"
                         ? encode_pfm(image, "")
                         : encode_qoi(2, 1, srgb_pixels(image, {.exposure = -1}, "")));
    std::remove((folder + name).c_str());
  }
  EXPECT_FALSE(is_plain_image("a.exr"));
  EXPECT_FALSE(is_plain_image("qoi"));
}

TEST(SrgbPixels, AreEncodedAndClipped) {
  const Image image{2, 1, {"R", "G", "B"}, {-1, 1e9F, NAN, 0.125F, 0.125F, 0.25F}};
  // 0.5 is 187.5 of 255 in the transfer function [IEC61966].
  EXPECT_EQ(srgb_pixels(image, {.exposure = 2}, "a"), (Bytes{0, 255, 0, 188, 188, 255}));
  EXPECT_THROW(srgb_pixels(image, {.exposure = std::nan("")}, "a"), Error);
}

}  // namespace
}  // namespace freepath::testing
