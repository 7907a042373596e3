// The places of jobs that are open at once.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "freepath/paths/open_jobs.h"

namespace freepath {
namespace {

TEST(OpenJobs, HaveCleanPlacesOfTheirOwn) {
  constexpr std::size_t kPathsPerSample = 3;
  const Film film(PixelWindow::whole(4, 4), LayerSet::standard(), WavelengthBuckets{.count = 3});
  OpenJobs jobs;
  jobs.begin(film, kPathsPerSample);
  std::mt19937 random(1);
  std::vector<uint32_t> open;
  for (int step = 0; step < 2000; ++step) {
    if (open.size() < 6 && random() % 3 != 0) {
      const PathJob job{0, 1 + random() % 40, 0, 1 + uint32_t(random() % 5)};
      const uint32_t number = jobs.open(job, film);
      ASSERT_EQ(std::count(open.begin(), open.end(), number), 0);
      const OpenJobs::Job& opened = jobs[number];
      ASSERT_EQ(opened.paths, job.pixels * job.samples * kPathsPerSample);
      for (const uint32_t other : open) {
        const OpenJobs::Job& beside = jobs[other];
        ASSERT_TRUE(opened.first + opened.paths <= beside.first ||
                    beside.first + beside.paths <= opened.first);
      }
      for (std::size_t i = opened.first; i < opened.first + opened.paths; ++i) {
        ASSERT_EQ(jobs.results[i].radiance, Rgb(0));
        ASSERT_TRUE(is_black(jobs.spectra[i]));
        jobs.results[i].radiance = Rgb(1);
        jobs.spectra[i] = SampledSpectrum(1);
      }
      open.push_back(number);
    } else if (!open.empty()) {
      const std::size_t which = random() % open.size();
      jobs.close(open[which]);
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(which));
    }
    ASSERT_EQ(jobs.is_empty(), open.empty());
  }
  // What is closed makes room: no more than the largest jobs that are open at once.
  EXPECT_LE(jobs.results.size(), std::size_t{6 * 2} * 40 * 5 * kPathsPerSample);
}

TEST(OpenJobs, HaveRoomForTwoAndThenForSoManyPaths) {
  const Film film(4, 4);
  OpenJobs jobs;
  jobs.begin(film, 1);
  EXPECT_TRUE(jobs.has_room());
  jobs.open({0, 1U << 18, 0, 1}, film);
  EXPECT_TRUE(jobs.has_room());
  const uint32_t second = jobs.open({0, 1, 0, 1}, film);
  EXPECT_FALSE(jobs.has_room());
  jobs.close(second);
  EXPECT_TRUE(jobs.has_room());
}

}  // namespace
}  // namespace freepath
