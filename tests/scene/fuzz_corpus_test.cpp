// The fuzzer's seeds, for compilers that have no libFuzzer: tests/fuzz/pbrt_fuzz.cpp is part of
// this program too.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size);

namespace freepath::testing {
namespace {

TEST(FuzzCorpus, EndsWholeOrCutAnywhereInASceneOrAnError) {
  int seeds = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FREEPATH_FUZZ_CORPUS)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    ASSERT_FALSE(bytes.empty()) << entry.path();
    const auto* const data = reinterpret_cast<const uint8_t*>(bytes.data());
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
      ASSERT_EQ(LLVMFuzzerTestOneInput(data, size), 0);
    }
    ++seeds;
  }
  EXPECT_GT(seeds, 5);
}

}  // namespace
}  // namespace freepath::testing
