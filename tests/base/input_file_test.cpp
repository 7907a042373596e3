// Files that are read, and what they may cost.

#include "freepath/base/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"

namespace freepath {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

class InputFileTest : public ::testing::Test {
 protected:
  InputFileTest()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ("freepath_input_file_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~InputFileTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(InputFileTest, ReadsAtAnyPlaceUpToTheEnd) {
  std::ofstream(folder_ / "a") << "0123456789";
  const InputFile file(folder_ / "a");
  EXPECT_EQ(file.size(), 10U);
  char bytes[4];
  EXPECT_EQ(file.read(3, std::as_writable_bytes(std::span(bytes))), 4U);
  EXPECT_EQ(std::string(bytes, 4), "3456");
  EXPECT_EQ(file.read(8, std::as_writable_bytes(std::span(bytes))), 2U);
  EXPECT_EQ(std::string(bytes, 2), "89");
  EXPECT_EQ(read_input_file(folder_ / "a"), "0123456789");
  EXPECT_EQ(message_of([&] { read_input_file(folder_ / "a", "a file", 9); }),
            (folder_ / "a").string() + ": it has 10 bytes, more than the 9 that are read");
}

// A pipe without a writer makes an open() for reading wait for one; a device may never end.
TEST_F(InputFileTest, RefusesWhatIsNoRegularFileAtOnce) {
  const auto message = [](const std::filesystem::path& path) {
    return message_of([&] { read_input_file(path, "an image"); });
  };
  const std::filesystem::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message(pipe),
            pipe.string() + ": is a pipe or a device, not a regular file; name an image");
  EXPECT_EQ(message("/dev/zero"),
            "/dev/zero: is a pipe or a device, not a regular file; name an image");
  EXPECT_EQ(message(folder_), folder_.string() + ": is a directory; name an image");
  EXPECT_EQ(message(folder_ / "none"),
            (folder_ / "none").string() + ": no such file; check the path");
}

TEST(MemoryBudget, AsksForWhatAFileCanDeliverAndTheMachineHas) {
  const auto declared = [](double decoded, uint64_t stored) {
    return message_of([&] { check_declared("a.hdr", "9x9 pixels", decoded, stored); });
  };
  EXPECT_EQ(declared(6e7, 57), "no error");
  EXPECT_EQ(
      declared(5e9, 57),
      "a.hdr: it declares 9x9 pixels, but has only 57 bytes: it is truncated or damaged; copy "
      "or export it again");
  EXPECT_EQ(declared(5e9, 100000), "no error");  // one value throughout, well packed
  const auto present = static_cast<double>(memory_present());
  EXPECT_GT(present, 1e8);
  EXPECT_EQ(message_of([&] { check_memory_present("a", "9 bricks", 0.7 * present); }), "no error");
  EXPECT_NE(
      message_of([&] { check_memory_present("a", "9 bricks", present); }).find("a: 9 bricks need "),
      std::string::npos);
}

}  // namespace
}  // namespace freepath
