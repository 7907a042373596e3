// The laboratory: trackers in one dimension, against exact free paths.

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freepath/study/lab.h"
#include "freepath/study/lab_numbers.h"
#include "freepath/study/lab_report.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/step_desk.h"
#include "python/src/walk_options.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

LabResult lab(const std::vector<std::string>& settings, const std::vector<std::string>& trackers,
              uint64_t paths, const WalkOptions& walk, int threads, nb::object callback) {
  const WalkSettings walk_with = walk_settings(walk);
  const LabOptions options{.settings = settings,
                           .trackers = trackers,
                           .paths = paths,
                           .seed = walk_with.seed,
                           .threads = threads,
                           .absorption = walk_with.absorption};
  StepDesk desk(std::move(callback));
  return result_interruptibly(
      [&](const std::atomic<bool>& stop) {
        return run_lab(options, [&](double share, std::string_view doing) {
          desk.put(doing, share);
          return !stop;
        });
      },
      desk.poll());
}

std::vector<std::pair<std::string_view, std::string_view>> setting_list() {
  std::vector<std::pair<std::string_view, std::string_view>> list;
  for (const LabSettingInfo& info : lab_setting_infos()) list.emplace_back(info.name, info.summary);
  return list;
}

}  // namespace

void bind_laboratory(nb::module_& module) {
  nb::class_<LabResult>(module, "LabResult")
      .def("json", &lab_json)
      .def("csv", &lab_csv)
      .def(
          "files",
          [](const LabResult& self, const std::string& command) {
            std::vector<std::pair<std::string, std::string>> files;
            for (LabFile& file : lab_files(self, command)) {
              files.emplace_back(std::move(file.name), std::move(file.content));
            }
            return files;
          },
          nb::arg("command"));
  module.def("lab", &lab, nb::arg("settings"), nb::arg("trackers"), nb::arg("paths"),
             nb::arg("options"), nb::arg("threads"), nb::arg("callback").none());
  module.def("lab_settings", &setting_list);
}

}  // namespace freepath::python
