#pragma once
/// @file The layers of a picture: what is recorded of it besides its colour.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace freepath {

/// A layer, of one channel or three. R, G, B and A are no layers: they are always there.
enum class Layer : uint8_t {
  kAlbedo,         ///< Mean albedo at the first event, 0 of paths without one.
  kDepth,          ///< Distance to the first event [world].
  kLookups,        ///< Mean number of look-ups of a path.
  kVariance,       ///< Variance of the mean of R, G, B.
  kSamples,        ///< Number of samples.
  kNormal,         ///< Mean shading normal of the first surface, or direction to the camera.
  kPosition,       ///< Mean position of the first event [world].
  kTransmittance,  ///< Transmittance of media, along the camera ray to the first surface or out.
  kEmission,       ///< Light of media and surfaces seen without a scattering.
  kBackground,     ///< Light from outside seen without a scattering.
  kDirect,         ///< Light after one scattering.
  kIndirect,       ///< Light after two or more.
  kHalves,         ///< A.{R,G,B} and B.{R,G,B}: means of even and of odd samples.
};
inline constexpr int kLayers = static_cast<int>(Layer::kHalves) + 1;

/// What a layer is called, and its channels.
struct LayerInfo {
  Layer layer;
  std::string_view name;
  std::string_view channels;  ///< Their names, separated by blanks.
};

/// All layers, in the order of a picture's channels.
const std::array<LayerInfo, kLayers>& layer_infos();

/// A choice of layers.
class LayerSet {
 public:
  constexpr LayerSet() = default;
  constexpr LayerSet(std::initializer_list<Layer> layers) {
    for (const Layer layer : layers) bits_ |= bit(layer);
  }
  static constexpr LayerSet all() {
    LayerSet set;
    set.bits_ = (1U << kLayers) - 1;
    return set;
  }
  /// What costs neither time nor memory that would be noticed.
  static constexpr LayerSet standard() {
    return {Layer::kAlbedo, Layer::kDepth, Layer::kLookups, Layer::kVariance, Layer::kSamples};
  }

  constexpr bool has(Layer layer) const { return (bits_ & bit(layer)) != 0; }
  /// Whether it has any of these.
  constexpr bool has_any(LayerSet layers) const { return (bits_ & layers.bits_) != 0; }
  /// This set and another together.
  constexpr LayerSet with(LayerSet layers) const {
    layers.bits_ |= bits_;
    return layers;
  }
  /// What is in this set and in another.
  constexpr LayerSet common(LayerSet layers) const {
    layers.bits_ &= bits_;
    return layers;
  }
  constexpr bool operator==(const LayerSet&) const = default;

 private:
  static constexpr uint32_t bit(Layer layer) { return 1U << static_cast<uint32_t>(layer); }

  uint32_t bits_ = 0;
};

/// Layers that split the light; each of them needs the sums of the others.
inline constexpr LayerSet kLightLayers = {Layer::kEmission, Layer::kBackground, Layer::kDirect,
                                          Layer::kIndirect};
/// Layers for which paths have more to record than PathSample.
inline constexpr LayerSet kPathLayers =
    kLightLayers.with({Layer::kNormal, Layer::kPosition, Layer::kTransmittance});

/// Channels of a picture with these layers, behind R, G, B and A.
std::vector<std::string> channels_of(LayerSet layers);

/// "all", "none", "default", or names separated by commas, which may have these among them.
/// @throws Error for a name that is none, with all that there are
LayerSet parse_layers(std::string_view text);
/// The names of layers, separated by commas, or "none": what parse_layers() takes.
std::string to_string(LayerSet layers);

}  // namespace freepath
