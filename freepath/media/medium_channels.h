#pragma once
/// @file The cross sections of a medium in the channels of a path.

#include <array>
#include <memory>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/media/medium.h"
#include "freepath/media/radiance_field.h"

namespace freepath {

/// Coefficients of one component in the channels of a path. A path of fewer channels uses the first
/// ones.
struct ComponentChannels {
  std::array<float, kMaxChannels> sigma_a{};   ///< [1/m per density]
  std::array<float, kMaxChannels> sigma_s{};   ///< [1/m per density]
  std::array<float, kMaxChannels> emission{};  ///< L_e, or what multiplies the field of it.
  std::array<RadianceField, kMaxChannels> radiance;
};

/// Coefficients of all components of a medium in the channels of a path.
struct MediumChannels {
  int count = 1;  ///< Channels: 1 to kMaxChannels.
  std::vector<ComponentChannels> components;

  /// Whether the extinction of every component is the same in all channels, but for rounding.
  bool has_grey_extinction() const;
  /// Whether all coefficients are the same in all channels.
  bool is_grey() const;
  bool emits() const;
  /// Whether emitted radiance varies from place to place.
  bool has_radiance_fields() const;
  /// The coefficients in one of the channels alone.
  MediumChannels only(int channel) const;
};

/// R, G and B of the components of a medium, or one of them.
/// @param channel the one to carry, or -1: one channel stands for all where they are equal
MediumChannels channels_of(const Medium& medium, int channel = -1);

}  // namespace freepath
