#pragma once
/// @file Open Image Denoise, where it is installed: loaded when it is asked for.

#include <memory>

#include "freepath/io/image.h"

namespace freepath::program {

/// Takes the noise out of pictures.
class Denoiser {
 public:
  /// Loads the library, version 0, 1 or 2 of it: the one that the environment variable
  /// FREEPATH_OIDN names, itself or a folder; else the loader's, or the active virtual
  /// environment's.
  /// @throws Error that says how to get it, if there is none
  static std::shared_ptr<const Denoiser> load();
  ~Denoiser();
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  /// Denoises R, G, B and keeps what they were as noisy.{R,G,B}.
  /// @param guides of the same pixels, with albedo.{R,G,B} and normal.{X,Y,Z}
  /// @throws Error with the library's message
  void denoise(Image& image, const Image& guides) const;

 private:
  struct Functions;

  Denoiser();

  void* library_ = nullptr;
  std::unique_ptr<Functions> functions_;
};

}  // namespace freepath::program
