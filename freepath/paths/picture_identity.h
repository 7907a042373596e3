#pragma once
/// @file What a picture depends on, besides the numbers of its samples.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freepath/paths/renderer.h"

namespace freepath {

/// What a picture depends on, bit by bit, besides its samples' numbers: films can be merged where
/// it is the same.
struct PictureIdentity {
  std::string version;  ///< Version of freepath.
  uint64_t seed = 0;
  /// Names and values: options that were given, contents of files (ContentDigest), the methods.
  std::vector<std::pair<std::string, std::string>> facts;

  bool operator==(const PictureIdentity&) const = default;
  /// The value of a fact; empty where it isn't told.
  std::string fact(std::string_view name) const;
  /// Adds what the settings say of methods: color, tracker, transmittance, interpolation and
  /// max-scatterings.
  /// @param color "rgb" or "spectral"
  void add_methods(const RenderSettings& settings, std::string_view color);
  /// Adds a digest of the content of each file; of names the folders don't count.
  /// @throws Error for a file that can't be read
  void add_contents(const std::vector<std::string>& files);
};

/// Says in what the second of two pictures differs from the first: "seed is 2 and not 1"; empty
/// where it doesn't.
/// @param any_seed whether their seeds may differ
std::string difference(const PictureIdentity& first, const PictureIdentity& second,
                       bool any_seed = false);

}  // namespace freepath
