#pragma once
/// @file The cross sections of a medium in the channels of a path.

#include <array>
#include <memory>
#include <vector>

#include "freepath/base/channels.h"
#include "freepath/media/field.h"
#include "freepath/media/medium.h"

namespace freepath {

/// Emitted radiance as a function of a field's value, which is interpolated trilinearly: a black
/// body's of its temperature. Straight lines between the values of a table, held at both ends.
struct RadianceField {
  std::shared_ptr<const Field> field;  ///< Null: the same radiance everywhere.
  /// Radiance where the field is first + i · step; empty: the field is the radiance.
  std::shared_ptr<const std::vector<float>> table;
  float first = 0;
  float step = 1;
};

/// Of one component. A path of fewer channels uses the first ones.
struct ComponentChannels {
  std::array<float, kMaxChannels> sigma_a{};   ///< [1/m per density]
  std::array<float, kMaxChannels> sigma_s{};   ///< [1/m per density]
  std::array<float, kMaxChannels> emission{};  ///< L_e, or what multiplies the field of it.
  std::array<RadianceField, kMaxChannels> radiance;
};

/// Of all components of a medium.
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
  /// One of the channels alone.
  MediumChannels only(int channel) const;
};

/// R, G and B of the components of a medium, or one of them.
/// @param channel the one to carry, or -1: one channel stands for all where they are equal
MediumChannels channels_of(const Medium& medium, int channel = -1);

}  // namespace freepath
