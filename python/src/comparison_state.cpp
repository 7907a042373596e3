// Comparisons and references as bytes and back, to be sent to other processes of the same version.

#include <nanobind/nanobind.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "python/src/bindings.h"
#include "python/src/comparisons.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

/// Appends values to bytes.
class Writer {
 public:
  std::string take() { return std::move(bytes_); }

  template <class T>
  void raw(const T* values, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  template <class List>
  void resize(const List& list) {
    const std::size_t count = list.size();
    raw(&count, 1);
  }

 private:
  std::string bytes_;
};

/// Takes them off again.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  bool is_empty() const { return rest_.empty(); }

  template <class T>
  void raw(T* values, std::size_t count) {
    if (count > rest_.size() / sizeof(T)) fail("what was sent of a comparison is damaged");
    std::memcpy(values, rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
  }
  template <class List>
  void resize(List& list) {
    std::size_t count = 0;
    raw(&count, 1);
    // Each of its values takes a byte at least.
    if (count > rest_.size()) fail("what was sent of a comparison is damaged");
    list.resize(count);
  }

 private:
  std::string_view rest_;
};

template <class T>
concept Flat = std::is_trivially_copyable_v<T>;
template <class T>
concept FlatList = !Flat<T> && Flat<typename T::value_type>;

template <class Archive, Flat T>
void visit(Archive& archive, T& value) {
  archive.raw(&value, 1);
}
template <class Archive, FlatList List>
void visit(Archive& archive, List& list) {
  archive.resize(list);
  archive.raw(list.data(), list.size());
}
template <class Archive, class... Parts>
void visit_all(Archive& archive, Parts&... parts) {
  (visit(archive, parts), ...);
}
template <class Archive, class T>
void visit_each(Archive& archive, T& list) {
  archive.resize(list);
  for (auto& value : list) visit(archive, value);
}

// Written and read alike, so that the order of the parts stands here once. Const where written.
template <class T, class U>
concept Is = std::is_same_v<std::remove_const_t<T>, U>;

template <class Archive, Is<PixelEstimates> T>
void visit(Archive& archive, T& v) {
  visit_all(archive, v.width, v.height, v.chromaticities, v.mean, v.variance, v.samples,
            v.knows_samples, v.lookups);
}
template <class Archive, Is<Reference> T>
void visit(Archive& archive, T& v) {
  visit_all(archive, v.estimates, v.variance_known, v.origin);
}
template <class Archive, Is<ComparisonRun> T>
void visit(Archive& archive, T& v) {
  visit_all(archive, v.seconds, v.cpu_seconds, v.samples, v.camera_samples, v.overflows,
            v.free_paths, v.shadow_rays, v.error, v.variance, v.flip, v.convergence);
}
template <class Archive, Is<BiasTest> T>
void visit(Archive& archive, T& v) {
  visit_all(archive, v.z, v.block_z, v.blocks_across, v.blocks_down, v.is_heavy_tailed);
}
template <class Archive, Is<ConfigurationResult> T>
void visit(Archive& archive, T& v) {
  visit_all(archive, v.configuration.tracker, v.configuration.transmittance,
            v.configuration.interpolation, v.name, v.is_biased, v.first, v.together, v.flip, v.bias,
            v.verdict, v.efficiency);
  visit_each(archive, v.runs);
}
template <class Archive, Is<Comparison> T>
void visit(Archive& archive, T& v) {
  visit_all(archive, v.baseline, v.reference_of, v.level, v.threshold, v.tests, v.seconds);
  visit_each(archive, v.references);
  visit_each(archive, v.configurations);
}
template <class Archive, Is<PythonReferences> T>
void visit(Archive& archive, T& v) {
  visit_each(archive, v.references);
}

template <class T>
nb::bytes bytes_of(const T& value) {
  Writer writer;
  const std::string its_version(version());
  visit(writer, its_version);
  visit(writer, value);
  const std::string bytes = writer.take();
  return nb::bytes(bytes.data(), bytes.size());
}

template <class T>
T value_of(const nb::bytes& bytes) {
  Reader reader({bytes.c_str(), bytes.size()});
  std::string its_version;
  visit(reader, its_version);
  if (its_version != version()) {
    fail("a worker has freepath {} and not {}; give workers the same", its_version, version());
  }
  T value;
  visit(reader, value);
  if (!reader.is_empty()) fail("what was sent of a comparison is damaged");
  return value;
}

}  // namespace

void bind_comparison_states(nb::module_& module) {
  module.def("comparison_bytes", &bytes_of<Comparison>, nb::arg("comparison"));
  module.def("comparison_of_bytes", &value_of<Comparison>, nb::arg("data"));
  module.def("references_bytes", &bytes_of<PythonReferences>, nb::arg("references"));
  module.def("references_of_bytes", &value_of<PythonReferences>, nb::arg("data"));
}

}  // namespace freepath::python
