#include "freepath/paths/film_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "freepath/base/error.h"
#include "freepath/paths/film_merge.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class FilmFileTest : public ::testing::Test {
 protected:
  FilmFileTest()
      : folder_(fs::temp_directory_path() /
                (std::string("freepath_film_file_") +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name() + random_word())) {
    fs::create_directories(folder_);
  }
  ~FilmFileTest() override { fs::remove_all(folder_); }

  /// Writes a film of two samples of 3x2 pixels.
  std::string write(const std::string& name, const PictureIdentity& identity,
                    uint32_t first_sample) const {
    Film film(PixelWindow::whole(3, 2), LayerSet::all(), {}, first_sample);
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
      for (uint32_t i = 0; i < 2; ++i) {
        const auto value = static_cast<float>(1 + pixel + first_sample + i);
        film.add(pixel, {.radiance = {value, 2 * value, 0}, .lookups = 3});
      }
    }
    FilmHeader header;
    header.identity = identity;
    header.region = film.window();
    header.counts.paths = 12;
    header.counts.free_paths.lookups = 36;
    header.seconds = 1.5;
    header.notes = "notes";
    std::string path = (folder_ / name).string();
    AtomicFile file(path);
    write_film(file, header, film);
    return path;
  }

  fs::path folder_;
};

TEST_F(FilmFileTest, HoldsWhatWasWritten) {
  const PictureIdentity identity{"1.2", 7, {{"--g", "0.5"}, {"tracker", "delta"}}};
  const FilmFile read = read_film(write("a.film", identity, 4));
  EXPECT_EQ(read.header.identity, identity);
  EXPECT_EQ(read.header.first_sample, 4U);
  EXPECT_EQ(read.header.samples.most, 2U);
  EXPECT_EQ(read.header.counts.paths, 12U);
  EXPECT_EQ(read.header.counts.free_paths.lookups, 36U);
  EXPECT_EQ(read.header.seconds, 1.5);
  EXPECT_EQ(read.header.notes, "notes");
  EXPECT_EQ(read.film.mean(2, 1), 2 * (1 + 2 + 4 + 0.5));
}

TEST_F(FilmFileTest, PartsOfAnotherVersionAreRefusedByName) {
  const std::string a = write("a.film", {"1.2", 7, {}}, 0);
  const std::string b = write("b.film", {"1.3", 7, {}}, 2);
  try {
    merge_films({a, b});
    FAIL() << "merged";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(b + ": is no part of the same picture as " + a), std::string::npos)
        << message;
    EXPECT_NE(message.find("it is by freepath 1.3 and not 1.2"), std::string::npos) << message;
  }
  const FilmFile merged = merge_films({write("c.film", {"1.2", 7, {}}, 2), a});
  EXPECT_EQ(merged.film.samples(0), 4U);
  EXPECT_EQ(merged.header.counts.paths, 24U);
  EXPECT_EQ(merged.header.seconds, 3);
}

}  // namespace
}  // namespace freepath::testing
