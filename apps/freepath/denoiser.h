#pragma once
/// @file Open Image Denoise, where it is installed: loaded when it is asked for.

#include <memory>
#include <vector>

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

  /// Denoises R, G, B, and A where it is asked for, and keeps what they were as noisy.{R,G,B,A}.
  /// Light from outside that is seen without a scattering stays as it is: it is taken out before,
  /// and added after, so that a sky or a sun behind the scene bleeds into nothing.
  /// @param guides of the same pixels, with albedo.{R,G,B} and normal.{X,Y,Z}, and with
  ///   background.{R,G,B} where R, G, B contain it
  /// @throws Error with the library's message
  void denoise(Image& image, const Image& guides, bool with_alpha) const;

 private:
  struct Functions;

  Denoiser();
  /// @param colour,albedo,normal three channels of pixels, packed
  std::vector<float> filter(int width, int height, std::vector<float> colour,
                            std::vector<float> albedo, std::vector<float> normal) const;

  void* library_ = nullptr;
  std::unique_ptr<Functions> functions_;
};

}  // namespace freepath::program
