#pragma once
/// @file Pictures and films as Python holds them.

#include <memory>
#include <string>
#include <vector>

#include "freepath/io/atomic_image.h"
#include "freepath/io/image.h"
#include "freepath/paths/film_file.h"

namespace freepath::python {

/// A film, and what is to be told of it; films are never changed once made.
struct PythonFilm {
  std::string name;  ///< Of its file, for messages; empty where there is none.
  FilmHeader header;
  std::shared_ptr<const Film> film;
};

/// A picture, and the film that it was made from.
struct PythonPicture {
  Image image;
  PythonFilm film;
  bool interrupted = false;
};

/// The picture of a film, with what its file tells of it.
PythonPicture picture_of(PythonFilm film);

}  // namespace freepath::python
