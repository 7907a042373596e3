#include "freepath/paths/film_merge.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// A part, of which the header alone need be in memory.
struct Part {
  std::string file;
  FilmHeader header;
  const Film* film = nullptr;  // in memory; null: in the file
};

/// "samples 0 to 15 of pixel (3, 4)"
std::string samples_text(uint32_t first, uint32_t end, int x, int y) {
  const std::string samples = end == first + 1 ? fmt::format("sample {}", first)
                                               : fmt::format("samples {} to {}", first, end - 1);
  return fmt::format("{} of pixel ({}, {})", samples, x, y);
}

void check_same_picture(const Part& first, const Part& part, bool average) {
  const FilmHeader& a = first.header;
  const FilmHeader& b = part.header;
  std::string reason;
  const auto compare = [&](bool is_same, std::string_view what) {
    if (reason.empty() && !is_same) reason = fmt::format("its {} are others", what);
  };
  compare(
      a.window.full_width == b.window.full_width && a.window.full_height == b.window.full_height,
      "width and height");
  if (reason.empty()) reason = difference(a.identity, b.identity, average);
  compare(a.layers == b.layers, "layers");
  compare(a.buckets == b.buckets, "buckets of wavelengths");
  compare(a.chromaticities.has_value() == b.chromaticities.has_value() &&
              (!a.chromaticities || are_same(*a.chromaticities, *b.chromaticities)),
          "chromaticities");
  if (!reason.empty()) {
    fail("{}: is no part of the same picture as {}: {}", part.file, first.file, reason);
  }
}

void check_no_overlap(const Part& a, const Part& b) {
  const PixelWindow& v = a.header.window;
  const PixelWindow& w = b.header.window;
  const int x = std::max(v.x, w.x);
  const int y = std::max(v.y, w.y);
  if (x >= std::min(v.x + v.width, w.x + w.width)) return;
  if (y >= std::min(v.y + v.height, w.y + w.height)) return;
  const auto end_of = [](const Part& part) {
    return part.header.first_sample + part.header.samples.most;
  };
  const uint32_t first = std::max(a.header.first_sample, b.header.first_sample);
  const uint32_t end = std::min(end_of(a), end_of(b));
  if (first >= end) return;
  fail("{} and {} overlap: both have {}; merge one of them alone", a.file, b.file,
       samples_text(first, end, x, y));
}

/// The smallest rectangle around two.
PixelWindow around(const PixelWindow& a, const PixelWindow& b) {
  PixelWindow window = a;
  window.x = std::min(a.x, b.x);
  window.y = std::min(a.y, b.y);
  window.width = std::max(a.x + a.width, b.x + b.width) - window.x;
  window.height = std::max(a.y + a.height, b.y + b.height) - window.y;
  return window;
}

/// Adds the parts of one seed to a film, and checks that nothing is missing.
class SeedMerger {
 public:
  /// @param parts in the order of their first samples
  SeedMerger(Film& film, const std::vector<Part>& parts, bool partial)
      : film_(film),
        parts_(parts),
        partial_(partial),
        ends_(film.pixel_count()),
        shares_(film.pixel_count()) {}

  void run() {
    for (const Part& part : parts_) add(part);
    if (!partial_) check_complete();
  }

 private:
  void add(const Part& part) {
    std::optional<FilmFile> loaded;
    if (part.film == nullptr) loaded.emplace(read_film(part.file));
    const Film& other = loaded ? loaded->film : *part.film;
    const PixelWindow& window = other.window();
    for (std::size_t i = 0; i < other.pixel_count(); ++i) {
      if (other.rounds(i) == 0) continue;
      const int x = window.x + static_cast<int>(i % window.width);
      const int y = window.y + static_cast<int>(i / window.width);
      const std::size_t pixel =
          static_cast<std::size_t>(y - film_.window().y) * film_.width() + (x - film_.window().x);
      if (other.first_sample() > ends_[pixel] && !partial_) {
        missing(ends_[pixel], other.first_sample(), x, y);
      }
      film_.merge_pixel(pixel, other, i);
      if (ends_[pixel] == 0) shares_[pixel] = other.share(i);
      if (other.share(i) != shares_[pixel]) {
        fail(
            "{}: is no part of the same picture: pixel ({}, {}) takes another share of the samples",
            part.file, x, y);
      }
      ends_[pixel] = other.first_sample() + other.rounds(i);
    }
  }

  void check_complete() const {
    const uint32_t end = *std::max_element(ends_.begin(), ends_.end());
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (ends_[i] < end) {
        missing(ends_[i], end, film_.window().x + static_cast<int>(i % film_.width()),
                film_.window().y + static_cast<int>(i / film_.width()));
      }
    }
  }

  [[noreturn]] void missing(uint32_t first, uint32_t end, int x, int y) const {
    fail(
        "no part has {}, though others go further; add the part that is missing, or take what "
        "there is by --partial",
        samples_text(first, end, x, y));
  }

  Film& film_;
  const std::vector<Part>& parts_;
  bool partial_;
  std::vector<uint32_t> ends_;  // of the rounds of samples that a pixel has
  std::vector<SampleShare> shares_;
};

/// What is told of a merged film: that of its parts, summed.
FilmHeader merged_header(const std::vector<Part>& parts, const PixelWindow& region) {
  FilmHeader header = parts[0].header;
  header.region = region;
  header.counts = {};
  header.seconds = 0;
  for (const Part& part : parts) {
    header.counts.merge(part.header.counts);
    header.seconds += part.header.seconds;
  }
  return header;
}

/// Names the seeds in place of the one: such a film is part of no picture.
void name_seeds(FilmHeader& header, const std::map<uint64_t, std::vector<Part>>& seeds) {
  std::string names;
  for (const auto& [seed, parts] : seeds) {
    names += (names.empty() ? "" : ", ") + std::to_string(seed);
  }
  header.identity.facts.emplace_back("seeds averaged", names);
}

/// @param count of parts
/// @param part_of makes the part of a number
template <class Function>
FilmFile merge(std::size_t count, Function part_of, const MergeOptions& options) {
  if (count == 0) fail("no film is given to merge");
  std::vector<Part> parts;
  std::map<uint64_t, std::vector<Part>> seeds;
  PixelWindow region;
  for (std::size_t i = 0; i < count; ++i) {
    const Part part = part_of(i);
    if (!parts.empty()) check_same_picture(parts[0], part, options.average);
    std::vector<Part>& others = seeds[part.header.identity.seed];
    for (const Part& other : others) check_no_overlap(other, part);
    others.push_back(part);
    region = parts.empty() ? part.header.region : around(region, part.header.region);
    parts.push_back(part);
  }
  const FilmHeader& any = parts[0].header;
  FilmFile merged{merged_header(parts, region), Film(region, any.layers, any.buckets)};
  merged.film.set_chromaticities(any.chromaticities);
  for (auto& [seed, of_seed] : seeds) {
    std::stable_sort(of_seed.begin(), of_seed.end(), [](const Part& a, const Part& b) {
      return a.header.first_sample < b.header.first_sample;
    });
    SeedMerger(merged.film, of_seed, options.partial).run();
  }
  if (seeds.size() > 1) name_seeds(merged.header, seeds);
  describe(merged.header, merged.film);
  return merged;
}

}  // namespace

FilmFile merge_films(const std::vector<std::string>& files, const MergeOptions& options) {
  const auto part_of = [&](std::size_t i) { return Part{files[i], read_film_header(files[i])}; };
  return merge(files.size(), part_of, options);
}

FilmFile merge_films(std::span<const FilmPart> films, const MergeOptions& options) {
  const auto part_of = [&](std::size_t i) {
    return Part{films[i].name, *films[i].header, films[i].film};
  };
  return merge(films.size(), part_of, options);
}

}  // namespace freepath
