// Films: to and from files and bytes, and merged.

#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/atomic_file.h"
#include "freepath/paths/film_merge.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/pictures.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

using Facts = std::vector<std::pair<std::string, std::string>>;

PythonFilm film_of(FilmFile file, std::string name) {
  return {std::move(name), std::move(file.header),
          std::make_shared<const Film>(std::move(file.film))};
}

/// The same film with more that it depends on.
PythonFilm with_facts(const PythonFilm& film, const Facts& facts) {
  PythonFilm result = film;
  auto& all = result.header.identity.facts;
  all.insert(all.end(), facts.begin(), facts.end());
  return result;
}

PythonFilm open_film(const std::string& path) {
  return result_interruptibly(
      [&](const std::atomic<bool>& /*stop*/) { return film_of(read_film(path), path); });
}

void save_film(const PythonFilm& film, const std::string& path) {
  if (!is_film_file(path)) {
    fail("'{}' has not the extension of a film, {}", path, kFilmExtension);
  }
  run_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    AtomicFile file(path);
    write_film(file, film.header, *film.film);
  });
}

nb::bytes bytes_of(const PythonFilm& film) {
  const std::string bytes = result_interruptibly(
      [&](const std::atomic<bool>& /*stop*/) { return film_bytes(film.header, *film.film); });
  return nb::bytes(bytes.data(), bytes.size());
}

PythonFilm film_from_bytes(const nb::bytes& bytes) {
  const std::string_view memory(bytes.c_str(), bytes.size());
  return result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    return film_of(film_of_bytes(memory, "bytes of a film"), {});
  });
}

PythonFilm merge(const std::vector<const PythonFilm*>& films, bool average, bool partial) {
  std::vector<FilmPart> parts;
  for (const PythonFilm* film : films) {
    std::string name = film->name;
    if (name.empty()) name = fmt::format("films[{}]", parts.size());
    parts.push_back({std::move(name), &film->header, film->film.get()});
  }
  return result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    return film_of(merge_films(parts, {.average = average, .partial = partial}), {});
  });
}

/// Digests of what is in files, as facts.
Facts file_facts(const std::vector<std::string>& files) {
  return result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    PictureIdentity identity;
    identity.add_contents(files);
    return identity.facts;
  });
}

}  // namespace

void bind_films(nb::module_& module) {
  nb::class_<PythonFilm>(module, "Film")
      .def_prop_ro("seed", [](const PythonFilm& self) { return self.header.identity.seed; })
      .def_prop_ro("version", [](const PythonFilm& self) { return self.header.identity.version; })
      .def_prop_ro("facts", [](const PythonFilm& self) { return self.header.identity.facts; })
      .def_prop_ro("first_sample", [](const PythonFilm& self) { return self.header.first_sample; })
      .def_prop_ro("most_samples", [](const PythonFilm& self) { return self.header.samples.most; })
      .def_prop_ro("window",
                   [](const PythonFilm& self) {
                     const PixelWindow& w = self.header.window;
                     return std::array<int, 4>{w.x, w.y, w.x + w.width, w.y + w.height};
                   })
      .def("with_facts", &with_facts, nb::arg("facts"))
      .def("save", &save_film, nb::arg("path"))
      .def("to_bytes", &bytes_of)
      .def("picture", [](const PythonFilm& self) {
        return result_interruptibly(
            [&](const std::atomic<bool>& /*stop*/) { return picture_of(self); });
      });
  module.def("file_facts", &file_facts, nb::arg("files"));
  module.def("open_film", &open_film, nb::arg("path"));
  module.def("film_from_bytes", &film_from_bytes, nb::arg("bytes"));
  module.def("merge", &merge, nb::arg("films"), nb::arg("average"), nb::arg("partial"));
}

}  // namespace freepath::python
