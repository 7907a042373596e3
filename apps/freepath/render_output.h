#pragma once
/// @file What a rendering leaves behind: pictures with metadata, statistics, a summary.

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/freepath/film_options.h"
#include "freepath/io/atomic_file.h"
#include "freepath/paths/film_file.h"
#include "freepath/paths/renderer.h"

namespace freepath::program {

/// Seconds since it was made or asked last.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A volume of the picture.
struct VolumeReport {
  std::string file;
  std::vector<std::string> grids;  ///< One, or those of R, G and B.
};

/// What there is to tell besides the result.
struct RenderReport {
  double seconds_load = 0, seconds_build = 0, seconds_render = 0;
  std::vector<VolumeReport> volumes;
  RenderSettings settings;
  int threads = 0;           ///< 0: all
  std::optional<int> frame;  ///< Where the picture belongs to a sequence.
  /// Of the picture's files, besides what the result tells.
  std::vector<std::pair<std::string, MetadataValue>> metadata;
};

/// What is made of a film.
struct OutputPlan {
  PictureLook look;  ///< Of a .png or .qoi.
  const FilmPlan& film;
  TevDisplay* display = nullptr;  ///< Shows the picture as it is written; may be null.
  /// What a film's file says besides what the result does; null: none is written.
  const FilmHeader* header = nullptr;
};

/// "picture.partial.exr" for "picture.exr": what a part of a picture is called that was to be
/// whole.
std::string partial_name(const std::string& file);

/// Whether less was rendered than was asked for.
/// @param is_film whether it is about a film, which part of the rounds may leave without samples
bool is_partial(const RenderResult& result, bool is_film);

/// What is known of a picture before it is rendered, for the headers of its files.
std::vector<std::pair<std::string, MetadataValue>> fixed_metadata(const RenderReport& report);

/// Checks that a picture, or a film, could be written.
/// @throws Error as check_writable
void check_output(const std::string& file);

/// The files of a picture, open from before it is rendered, so that what hinders them is told then.
class PictureFilesAside {
 public:
  /// @param pictures .exr with layers and metadata, .film, or .png
  /// @param statistics JSON; may be empty: none
  /// @throws Error as AtomicFile
  PictureFilesAside(const std::vector<std::string>& pictures, const std::string& statistics);

  /// Writes each, whatever becomes of the others, and shows the picture then. Where the result is
  /// partial, they have partial names.
  /// @return the names of the pictures
  /// @throws Error that names all that failed, once the others are written. A picture that none of
  ///   the files holds with all its layers is then kept in the folder of temporary files, if that
  ///   can be, and the message says where.
  std::vector<std::string> write(const OutputPlan& plan, const RenderResult& result,
                                 const RenderReport& report);

 private:
  std::vector<AtomicFile> pictures_;
  std::optional<AtomicFile> statistics_;
};

/// Checks, before the time is spent, that statistics could be written, and over neither a picture
/// nor a volume.
/// @param file may be empty: no statistics
/// @throws Error that names the file and what to do
void check_statistics_file(const std::string& file, const std::vector<std::string>& pictures,
                           const std::vector<std::string>& volumes);

/// Tells on standard error what makes a picture less than it should be.
void print_warnings(const RenderResult& result, const RenderReport& report);

/// Tells on standard error of pixels without a sample in pictures of part of the rounds.
void warn_of_pixels_between(const RenderResult& result);

/// Fails, once all is written, where paths were lost.
/// @throws Error that says how many, and which pixels' variance is infinite
void require_no_overflows(const RenderResult& result);

/// "64", or "0 to 1" where pixels differ: samples per pixel.
std::string samples_text(const RenderResult& result);

/// Tells on standard error what was done.
/// @throws Error as require_no_overflows
void print_summary(const std::vector<std::string>& files, const RenderResult& result,
                   const RenderReport& report);

}  // namespace freepath::program
