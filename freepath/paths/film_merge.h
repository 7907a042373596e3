#pragma once
/// @file Films of parts of a picture made one.

#include <span>
#include <string>
#include <vector>

#include "freepath/paths/film_file.h"

namespace freepath {

/// What may be merged.
struct MergeOptions {
  /// Averages pictures of different seeds, each pixel weighted by its samples; else all parts are
  /// of one seed.
  bool average = false;
  /// Takes what there is where parts are missing: pixels without samples are 0.
  bool partial = false;
};

/// The film of a part, in memory.
struct FilmPart {
  std::string name;  ///< Name for messages.
  const FilmHeader* header = nullptr;
  const Film* film = nullptr;
};

/// Merges the films of parts of a picture: of ranges of samples, of tiles or crops, or of both. The
/// result has the bits of the film of one process that rendered all of it.
///
/// Parts that are tiles make up the region that they are tiles of, others the smallest rectangle
/// around them; each of its pixels has the same samples then, without a gap from the first one on.
/// Two films are in memory at a time: the merged one and that of one part.
/// @param files names of films, in any order
/// @throws Error that names the files: for parts of different pictures, and that overlap; where
///   samples are missing; as read_film
FilmFile merge_films(const std::vector<std::string>& files, const MergeOptions& options = {});
/// Merges films in memory.
FilmFile merge_films(std::span<const FilmPart> films, const MergeOptions& options = {});

}  // namespace freepath
