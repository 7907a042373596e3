#pragma once
/// @file Films in files: all that a picture's samples have added up to, to be gone on with or
/// merged.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "freepath/io/atomic_file.h"
#include "freepath/paths/path_job.h"
#include "freepath/paths/picture_identity.h"
#include "freepath/sensors/film.h"

namespace freepath {

/// What a film's file says besides sums.
struct FilmHeader {
  PictureIdentity identity;
  /// The pixels that the film's picture is a tile of; its own window where it is no tile.
  PixelWindow region;
  uint32_t wanted_samples = 0;  ///< Samples of each pixel that the film is to have; 0: not known.
  PathCounts counts;
  double seconds = 0;
  /// Notes of its maker for later on, in any form.
  std::string notes;

  // What describe() says of the film, which those that read and write it do.
  PixelWindow window;
  LayerSet layers;
  WavelengthBuckets buckets;
  std::optional<RgbChromaticities> chromaticities;
  uint32_t first_sample = 0;
  Film::SampleCounts samples;
};

/// A film and what its file says of it.
struct FilmFile {
  FilmHeader header;
  Film film;
};

/// Sets in a header what the film itself says: window, layers, buckets, chromaticities, samples.
void describe(FilmHeader& header, const Film& film);

/// The extension of films' files.
inline constexpr const char* kFilmExtension = ".film";
/// Whether a name has the extension of film files.
bool is_film_file(const std::string& path);

/// Writes a film: a line that names the format, the header as JSON, the sums packed by Blosc, and a
/// checksum. The file appears under its name once it is whole.
/// @throws Error that names the file
void write_film(AtomicFile& file, FilmHeader header, const Film& film);

/// What write_film() writes, in memory.
std::string film_bytes(FilmHeader header, const Film& film);

/// @throws Error that names the file, if it is no film, of another version of the format, cut off
/// or
///   damaged
FilmHeader read_film_header(const std::string& path);
/// @throws Error as read_film_header
FilmFile read_film(const std::string& path);
/// A film of the bytes of its file.
/// @param name of the film, for messages
/// @throws Error as read_film_header
FilmFile film_of_bytes(std::string_view bytes, const std::string& name);

}  // namespace freepath
