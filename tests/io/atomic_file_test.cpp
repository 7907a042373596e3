#include "freepath/io/atomic_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "freepath/base/error.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;
using testing_volumes::TemporaryFolder;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> files_in(const fs::path& folder) {
  return {fs::directory_iterator(folder), fs::directory_iterator()};
}

std::string message_for(const fs::path& path) {
  try {
    const AtomicFile file(path.string());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_refused(const fs::path& path, const std::string& reason) {
  const std::string message = message_for(path);
  EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0U) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message;
}

class AtomicFileTest : public ::testing::TestWithParam<AtomicKind> {
 protected:
  AtomicFile open(const fs::path& path) const { return AtomicFile(path.string(), GetParam()); }
  TemporaryFolder folder_;
};

TEST_P(AtomicFileTest, AppearsWholeOrNotAtAll) {
  const fs::path target = folder_ / "a.txt";
  {
    AtomicFile file = open(target);
    file.write("first");
    EXPECT_FALSE(fs::exists(target));
    file.write("one");  // begins anew
    file.replace_target();
    EXPECT_EQ(text_of(target), "one");
  }
  {
    AtomicFile file = open(target);
    std::ofstream(file.name()) << "two";  // as libraries do it
    EXPECT_EQ(text_of(target), "one");
  }
  EXPECT_EQ(text_of(target), "one");
  {
    AtomicFile file = open(target);
    std::ofstream(file.name()) << "two";
    AtomicFile moved = std::move(file);
    moved.replace_target();
  }
  EXPECT_EQ(text_of(target), "two");
  EXPECT_EQ(files_in(folder_.path()).size(), 1U);
  const mode_t mask = umask(0);
  umask(mask);
  struct stat status {};
  ASSERT_EQ(stat(target.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0666U & ~mask);
}

TEST_P(AtomicFileTest, NamesMayBeAsLongAsTheFileSystemHasThem) {
  for (const int length : {249, 255}) {
    const fs::path target = folder_ / std::string(length, 'a');
    AtomicFile file = open(target);
    file.write("text");
    file.replace_target();
    EXPECT_EQ(text_of(target), "text");
  }
  expect_refused(folder_ / std::string(256, 'a'), "name too long");
}

TEST_P(AtomicFileTest, LinksStandForTheirTargets) {
  fs::create_directory(folder_ / "far");
  fs::create_symlink("far/a.txt", folder_ / "link");  // to what is not there yet
  for (const char* text : {"one", "two"}) {
    AtomicFile file = open(folder_ / "link");
    file.write(text);
    file.replace_target();
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(text_of(folder_ / "far" / "a.txt"), text);
  }
  fs::create_symlink("loop", folder_ / "loop");
  expect_refused(folder_ / "loop", "leads to itself");
}

TEST_P(AtomicFileTest, AFullDiskIsAnErrorAndLeavesTheOldFile) {
  const fs::path target = folder_ / "a.txt";
  std::ofstream(target) << "old";
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 4;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  AtomicFile file = open(target);
  EXPECT_THROW(file.write("much more"), Error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(text_of(target), "old");
}

TEST_P(AtomicFileTest, WhatTakesItsPlaceMeanwhileStaysAndIsTold) {
  const fs::path target = folder_ / "a.txt";
  AtomicFile file = open(target);
  file.write("text");
  fs::create_directories(target / "inner");
  EXPECT_THROW(file.replace_target(), Error);
  EXPECT_TRUE(fs::exists(target / "inner"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, AtomicFileTest,
                         ::testing::Values(AtomicKind::kNameless, AtomicKind::kNamed));

TEST(AtomicFile, HasNoNameOrOneThatIsNewAndShort) {
  const TemporaryFolder folder;
  const fs::path victim = folder / "victim";
  std::ofstream(victim) << "precious";
  {
    const AtomicFile file((folder / "a.txt").string());
    EXPECT_EQ(files_in(folder.path()).size(), 1U);  // where the file system has O_TMPFILE
  }
  AtomicFile file((folder / std::string(255, 'a')).string(), AtomicKind::kNamed);
  fs::path name;
  for (const fs::path& found : files_in(folder.path())) {
    if (found != victim) name = found;
  }
  EXPECT_LT(name.filename().string().size(), 64U);
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(name)));
  // Somebody else puts a link in its place: neither is it written through nor does it get the name.
  fs::remove(name);
  fs::create_symlink("victim", name);
  std::ofstream(file.name()) << "text";
  EXPECT_EQ(text_of(victim), "precious");
  EXPECT_THROW(file.replace_target(), Error);
  EXPECT_EQ(text_of(victim), "precious");
  EXPECT_FALSE(fs::exists(folder / std::string(255, 'a')));
}

TEST(AtomicFile, PlacesWhereNoneCanStandAreRefusedAtOnce) {
  const TemporaryFolder folder;
  expect_refused(folder.path(), "is a directory");
  expect_refused(folder / "none" / "a.txt", "does not exist; create it");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_refused(folder / "pipe", "not a file");
  expect_refused("/dev/full", "not a file");
  expect_refused("/dev/stdout", "not a file");
  std::ofstream(folder / "kept") << "text";
  fs::permissions(folder / "kept", fs::perms::owner_read);
  expect_refused(folder / "kept", "read-only");
  std::ofstream(folder / "file") << "text";
  EXPECT_NE(message_for(folder / "file" / "a.txt"), "");
}

}  // namespace
}  // namespace freepath
