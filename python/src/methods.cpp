// Trackers, estimators and phase functions: what there is.

#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "freepath/media/phase/parse_phase_function.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"
#include "freepath/transport/weight_growth.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"

namespace freepath::python {
namespace {

nb::dict option_dict(const MethodOption& option) {
  nb::dict entry;
  entry["name"] = option.name;
  entry["meaning"] = option.meaning;
  if (option.choices.empty()) {
    entry["default"] = option.default_value;
    entry["minimum"] = option.minimum;
    entry["maximum"] = option.maximum;
  } else {
    entry["default"] = option.choices[static_cast<std::size_t>(option.default_value)];
    entry["choices"] = std::vector<std::string_view>(option.choices.begin(), option.choices.end());
  }
  return entry;
}

nb::list method_list(std::span<const MethodInfo> infos) {
  nb::list list;
  for (const MethodInfo& info : infos) {
    nb::dict entry;
    entry["name"] = info.name;
    entry["summary"] = info.summary;
    entry["needs"] = info.needs;
    entry["unbiased"] = info.unbiased;
    entry["source"] = info.source;
    entry["paths"] = weights_in_paths(info);
    entry["chromatic"] = info.chromatic;
    entry["biased"] = info.biased;
    nb::list options;
    for (const MethodOption& option : info.options) options.append(option_dict(option));
    entry["options"] = options;
    list.append(entry);
  }
  return list;
}

using Cosines = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

nb::object evaluate_phase(const PhaseFunction& phase, const Cosines& cosines) {
  ArrayMemory<double> values(cosines.size());
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    const auto cosine = static_cast<float>(cosines.data()[i]);
    const float sine = std::sqrt(std::max(0.0F, 1 - cosine * cosine));
    values.data()[i] = double{phase.evaluate(Vec3f(0, 0, 1), Vec3f(sine, 0, cosine))};
  }
  return std::move(values).to_numpy({cosines.size()});
}

}  // namespace

void bind_methods(nb::module_& module) {
  module.def("trackers", [] { return method_list(tracker_choices()); });
  module.def("estimators", [] { return method_list(transmittance_infos()); });
  module.def("phase_functions", [] {
    const auto names = phase_function_names();
    return std::vector<std::string_view>(names.begin(), names.end());
  });
  module.def("simd", [] {
    std::vector<std::string_view> names;
    for (const Simd simd : available_simd()) names.push_back(to_string(simd));
    return names;
  });
  nb::class_<PhaseFunction>(module, "PhaseFunction")
      .def(
          "__init__",
          [](PhaseFunction* self, const std::string& text) {
            new (self) PhaseFunction(parse_phase_function(text));
          },
          nb::arg("text"))
      .def("mean_cosine", &PhaseFunction::mean_cosine)
      .def("evaluate", &evaluate_phase, nb::arg("cosines"));
}

}  // namespace freepath::python
