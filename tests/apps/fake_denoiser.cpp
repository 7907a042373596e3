// Stands in for Open Image Denoise: the same functions, of which the filter computes
// 2·color + albedo + normal, so that a test sees that all of them have arrived.

#include <cstddef>
#include <cstring>
#include <map>
#include <string>

namespace {

struct Filter {
  std::map<std::string, float*> images;
  std::size_t values = 0;
  bool is_hdr = false;
  bool is_committed = false;
};

int devices = 0;
const char* error_message = nullptr;

}  // namespace

// The library's names.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" {

void* oidnNewDevice(int /*type*/) { return &devices; }
void oidnCommitDevice(void* /*device*/) { ++devices; }
void oidnReleaseDevice(void* /*device*/) { --devices; }

int oidnGetDeviceError(void* /*device*/, const char** message) {
  *message = error_message;
  return error_message == nullptr ? 0 : 1;
}

void* oidnNewFilter(void* /*device*/, const char* type) {
  return std::strcmp(type, "RT") == 0 ? new Filter : nullptr;
}

void oidnSetSharedFilterImage(void* filter, const char* name, void* data, int format,
                              std::size_t width, std::size_t height, std::size_t /*offset*/,
                              std::size_t /*pixel_stride*/, std::size_t /*row_stride*/) {
  auto* const target = static_cast<Filter*>(filter);
  if (format != 3) error_message = "not three floats";
  target->images[name] = static_cast<float*>(data);
  target->values = width * height * 3;
}

void oidnSetFilterBool(void* filter, const char* name, bool value) {
  if (std::strcmp(name, "hdr") == 0) static_cast<Filter*>(filter)->is_hdr = value;
}

void oidnCommitFilter(void* filter) { static_cast<Filter*>(filter)->is_committed = true; }

void oidnExecuteFilter(void* filter) {
  Filter& f = *static_cast<Filter*>(filter);
  if (!f.is_hdr || !f.is_committed || f.images.size() != 4 || devices != 1) {
    error_message = "not set up";
    return;
  }
  for (std::size_t i = 0; i < f.values; ++i) {
    f.images["output"][i] =
        2 * f.images["color"][i] + f.images["albedo"][i] + f.images["normal"][i];
  }
}

void oidnReleaseFilter(void* filter) { delete static_cast<Filter*>(filter); }

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
