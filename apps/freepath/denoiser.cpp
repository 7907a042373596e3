#include "apps/freepath/denoiser.h"

#include <dlfcn.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "freepath/base/error.h"

namespace freepath::program {
namespace {

constexpr int kCpuDevice = 1;  // whose images may be any memory
constexpr int kFloat3 = 3;
constexpr int kRgb = 3;

/// Three channels of an image, packed.
std::vector<float> packed(const Image& image, const std::array<const char*, kRgb>& names, float low,
                          float high) {
  std::array<int, kRgb> channels{};
  for (int c = 0; c < kRgb; ++c) channels[c] = find_channel(image, names[c]).value();
  std::vector<float> values;
  values.reserve(image.pixel_count() * kRgb);
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    for (const int channel : channels) {
      values.push_back(
          std::clamp(image.values[pixel * image.channels.size() + channel], low, high));
    }
  }
  return values;
}

/// Replaces channels, and appends what they were.
/// @param denoised three values of each pixel, of which the first ones are taken
void put_denoised(Image& image, const std::vector<const char*>& names,
                  const std::vector<float>& denoised) {
  std::vector<int> replaced;
  replaced.reserve(names.size());
  for (const char* name : names) replaced.push_back(find_channel(image, name).value());
  const std::size_t before = image.channels.size();
  std::vector<float> values;
  values.reserve(image.pixel_count() * (before + names.size()));
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const float* const old = image.values.data() + pixel * before;
    const std::size_t begin = values.size();
    values.insert(values.end(), old, old + before);
    for (std::size_t c = 0; c < names.size(); ++c) {
      values.push_back(old[replaced[c]]);
      values[begin + replaced[c]] = denoised[pixel * kRgb + c];
    }
  }
  // All at once, lest an image be left that is neither.
  std::vector<std::string> channels = image.channels;
  for (const char* name : names) channels.push_back(std::string("noisy.") + name);
  image.channels = std::move(channels);
  image.values = std::move(values);
}

constexpr std::array kLibraryNames{"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                   "libOpenImageDenoise.so.0", "libOpenImageDenoise.so"};

/// The libraries at a place: a library, a folder of libraries or above one, or a virtual
/// environment of Python's with the package pyoidn.
std::vector<std::string> libraries_at(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return {path};
  std::vector<std::string> found;
  for (const char* folder :
       {"", "/lib", "/lib64", "/lib/python3*/site-packages/pyoidn/oidn/lib", "/pyoidn/oidn/lib"}) {
    for (const char* name : kLibraryNames) {
      glob_t matches{};
      if (glob((path + folder + "/" + name).c_str(), 0, nullptr, &matches) == 0) {
        found.insert(found.end(), matches.gl_pathv, matches.gl_pathv + matches.gl_pathc);
      }
      globfree(&matches);
    }
  }
  for (std::string& name : found) name = std::filesystem::absolute(name, ignored).string();
  return found;
}

/// Those of the loader's search path, and of the virtual environment that is active.
std::vector<std::string> usual_libraries() {
  std::vector<std::string> libraries(kLibraryNames.begin(), kLibraryNames.end());
  const char* const environment = std::getenv("VIRTUAL_ENV");
  if (environment != nullptr && *environment != 0) {
    const std::vector<std::string> more = libraries_at(environment);
    libraries.insert(libraries.end(), more.begin(), more.end());
  }
  return libraries;
}

}  // namespace

/// Of the library's C interface, what is used of it.
struct Denoiser::Functions {
  using Handle = void*;
  Handle (*new_device)(int type);
  void (*commit_device)(Handle);
  void (*release_device)(Handle);
  int (*device_error)(Handle, const char** message);
  Handle (*new_filter)(Handle device, const char* type);
  void (*set_image)(Handle filter, const char* name, void* data, int format, std::size_t width,
                    std::size_t height, std::size_t offset, std::size_t pixel_stride,
                    std::size_t row_stride);
  void (*set_bool)(Handle filter, const char* name, bool value);
  void (*commit_filter)(Handle);
  void (*execute_filter)(Handle);
  void (*release_filter)(Handle);

  /// @return whether all were found
  bool find(void* library) {
    const auto get = [&](auto& function, const char* name) {
      function =
          reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
      return function != nullptr;
    };
    return get(new_device, "oidnNewDevice") && get(commit_device, "oidnCommitDevice") &&
           get(release_device, "oidnReleaseDevice") && get(device_error, "oidnGetDeviceError") &&
           get(new_filter, "oidnNewFilter") && get(set_image, "oidnSetSharedFilterImage") &&
           // Version 2 has another name for it.
           (get(set_bool, "oidnSetFilterBool") || get(set_bool, "oidnSetFilter1b")) &&
           get(commit_filter, "oidnCommitFilter") && get(execute_filter, "oidnExecuteFilter") &&
           get(release_filter, "oidnReleaseFilter");
  }
};

Denoiser::Denoiser() : functions_(std::make_unique<Functions>()) {}

Denoiser::~Denoiser() {
  if (library_ != nullptr) dlclose(library_);
}

std::shared_ptr<const Denoiser> Denoiser::load() {
  const std::shared_ptr<Denoiser> denoiser(new Denoiser);
  const char* const chosen = std::getenv("FREEPATH_OIDN");
  const bool is_chosen = chosen != nullptr && *chosen != 0;
  std::string reason = "no such library there";
  for (const std::string& name : is_chosen ? libraries_at(chosen) : usual_libraries()) {
    denoiser->library_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (denoiser->library_ == nullptr) {
      reason = dlerror();
      continue;
    }
    if (denoiser->functions_->find(denoiser->library_)) return denoiser;
    reason = name + " is no Open Image Denoise";
    dlclose(std::exchange(denoiser->library_, nullptr));
  }
  if (is_chosen) fail("--denoise: FREEPATH_OIDN is {}: {}", chosen, reason);
  fail(
      "--denoise needs Open Image Denoise, and no libOpenImageDenoise.so.2, .1 or .0 can be "
      "loaded; 'python3 -m venv oidn; oidn/bin/pip install --no-deps pyoidn' gets it, and "
      "FREEPATH_OIDN=oidn names that folder, or any other that it is in");
}

std::vector<float> Denoiser::filter(int width, int height, std::vector<float> colour,
                                    std::vector<float> albedo, std::vector<float> normal) const {
  std::vector<float> denoised(colour.size());
  const Functions& oidn = *functions_;
  void* const device = oidn.new_device(kCpuDevice);
  if (device == nullptr) fail("Open Image Denoise: there is no device");
  oidn.commit_device(device);
  void* const filter = oidn.new_filter(device, "RT");
  const auto set = [&](const char* name, std::vector<float>& values) {
    oidn.set_image(filter, name, values.data(), kFloat3, width, height, 0, 0, 0);
  };
  if (filter != nullptr) {
    set("color", colour);
    set("albedo", albedo);
    set("normal", normal);
    set("output", denoised);
    oidn.set_bool(filter, "hdr", true);
    oidn.commit_filter(filter);
    oidn.execute_filter(filter);
    oidn.release_filter(filter);
  }
  const char* message = nullptr;
  const bool failed = oidn.device_error(device, &message) != 0;
  const std::string reason = message == nullptr ? "unknown reason" : message;
  oidn.release_device(device);
  if (failed || filter == nullptr) fail("Open Image Denoise: {}", reason);
  return denoised;
}

void Denoiser::denoise(Image& image, const Image& guides, bool with_alpha) const {
  constexpr float kLargest = 1e30F;
  const bool has_background = find_channel(guides, "background.R").has_value();
  std::vector<float> colour = packed(image, {"R", "G", "B"}, -kLargest, kLargest);
  std::vector<float> background(colour.size());
  if (has_background) {
    background =
        packed(guides, {"background.R", "background.G", "background.B"}, -kLargest, kLargest);
  }
  for (std::size_t i = 0; i < colour.size(); ++i) {
    colour[i] = std::max(0.0F, colour[i] - background[i]);
  }
  const std::vector<float> albedo = packed(guides, {"albedo.R", "albedo.G", "albedo.B"}, 0, 1);
  const std::vector<float> normal = packed(guides, {"normal.X", "normal.Y", "normal.Z"}, -1, 1);
  std::vector<float> denoised = filter(image.width, image.height, colour, albedo, normal);
  for (std::size_t i = 0; i < denoised.size(); ++i) denoised[i] += background[i];
  std::vector<float> alpha;
  if (with_alpha) {
    alpha = filter(image.width, image.height, packed(image, {"A", "A", "A"}, 0, 1), albedo, normal);
    for (float& value : alpha) value = std::clamp(value, 0.0F, 1.0F);
  }
  put_denoised(image, {"R", "G", "B"}, denoised);
  if (with_alpha) put_denoised(image, {"A"}, alpha);
}

}  // namespace freepath::program
