// Pictures: how they came about, and their pixels.

#include "python/src/pictures.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <charconv>
#include <cstdint>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "freepath/io/atomic_file.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/counts.h"
#include "python/src/interruptible.h"

namespace freepath::python {
namespace {

nb::dict statistics_of(const PythonPicture& picture) {
  const FilmHeader& header = picture.film.header;
  const PathCounts& counts = header.counts;
  uint32_t max_scatterings = 0;
  const std::string limit = header.identity.fact("max-scatterings");
  std::from_chars(limit.data(), limit.data() + limit.size(), max_scatterings);
  nb::dict stats;
  stats["samples"] = header.samples.fewest;
  stats["most_samples"] = header.samples.most;
  stats["pixels_without_samples"] = header.samples.pixels_without + header.samples.pixels_between;
  stats["paths"] = counts.paths;
  stats["overflows"] = counts.overflows;
  stats["cut_paths"] = counts.cut_paths;
  stats["cut_share"] = counts.cut_share();
  stats["seconds"] = header.seconds;
  stats["interrupted"] = picture.interrupted;
  stats["max_scatterings"] = max_scatterings;
  stats["seed"] = header.identity.seed;
  stats["tracker"] = header.identity.fact("tracker");
  stats["estimator"] = header.identity.fact("transmittance");
  stats["color"] = header.identity.fact("color");
  stats["free_paths"] = counts_to_python(counts.free_paths);
  stats["shadow_rays"] = counts_to_python(counts.shadow_rays);
  return stats;
}

PictureLook look_of(double exposure, const std::string& view) {
  if (view == "standard") return {exposure, ViewTransform::kStandard};
  if (view == "neutral") return {exposure, ViewTransform::kNeutral};
  fail("view '{}' is unknown; there are: standard, neutral", view);
}

/// The picture's own memory: read-only, and kept by the array.
nb::object pixels_of(const nb::handle& self) {
  const Image& image = nb::cast<const PythonPicture&>(self).image;
  return nb::cast(nb::ndarray<nb::numpy, const float>(
      image.values.data(),
      {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width),
       image.channels.size()},
      self));
}

using Pixels = nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

/// A PNG file of linear R, G, B.
nb::bytes png_of_pixels(const Pixels& pixels) {
  Image image{.width = static_cast<int>(pixels.shape(1)),
              .height = static_cast<int>(pixels.shape(0)),
              .channels = {"R", "G", "B"}};
  image.values.assign(pixels.data(), pixels.data() + pixels.size());
  const std::vector<uint8_t> bytes = encode_png(image, look_of(0, "neutral"), "the picture");
  return nb::bytes(bytes.data(), bytes.size());
}

}  // namespace

PythonPicture picture_of(PythonFilm film) {
  PythonPicture picture{film.film->to_image(), std::move(film)};
  const PictureIdentity& identity = picture.film.header.identity;
  picture.image.metadata = {{"Software", fmt::format("freepath {}", version())},
                            {"freepath:version", std::string(version())},
                            {"freepath:seed", static_cast<int64_t>(identity.seed)},
                            {"freepath:samples", int64_t{picture.film.header.samples.fewest}},
                            {"freepath:tracker", identity.fact("tracker")},
                            {"freepath:transmittance", identity.fact("transmittance")}};
  return picture;
}

void bind_pictures(nb::module_& module) {
  nb::class_<PythonPicture>(module, "Picture")
      .def_prop_ro("pixels", [](const nb::handle& self) { return pixels_of(self); })
      .def_prop_ro("channels", [](const PythonPicture& self) { return self.image.channels; })
      .def_prop_ro("statistics", &statistics_of)
      .def_ro("film", &PythonPicture::film)
      .def(
          "save",
          [](const PythonPicture& self, const std::string& path, double exposure,
             const std::string& view) {
            const PictureLook look = look_of(exposure, view);
            run_interruptibly([&](const std::atomic<bool>& /*stop*/) {
              AtomicFile file(path);
              write_image(file, self.image, look);
            });
          },
          nb::arg("path"), nb::arg("exposure"), nb::arg("view"))
      .def(
          "png",
          [](const PythonPicture& self, double exposure, const std::string& view) {
            const std::vector<uint8_t> bytes =
                encode_png(self.image, look_of(exposure, view), "the picture");
            return nb::bytes(bytes.data(), bytes.size());
          },
          nb::arg("exposure"), nb::arg("view"));
  module.def("png_of_pixels", &png_of_pixels, nb::arg("pixels"));
  module.def("png_of_pixels", &png_of_pixels, nb::arg("pixels"));
}

}  // namespace freepath::python
