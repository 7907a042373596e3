#pragma once
/// @file Scatterings in media, in arrays that lanes read and write.

#include <array>
#include <cstddef>
#include <cstdint>

namespace freepath {

/// Numbers that a scattering draws, in this order; streams of one path have more behind them.
enum ScatteringNumber : uint32_t {
  kRouletteNumber = 0,
  kLightNumber = 1,   ///< Three.
  kPhaseNumber = 4,   ///< Two.
  kShadowNumber = 6,  ///< Whether to cast a shadow ray.
  kScatteringNumbers = 7,
};
/// Blocks of four random words that these take.
inline constexpr uint32_t kScatteringBlocks = 2;

/// Scatterings in slots [0, count). What has no value yet is finite, so that lanes may read it.
struct ScatteringStream {
  /// As many as the nearest cache holds with their paths; a multiple of the lanes of any target.
  static constexpr std::size_t kCapacity = 128;
  template <class T>
  using Row = std::array<T, kCapacity>;

  std::size_t count = 0;
  // Where their random numbers stand.
  alignas(64) Row<uint32_t> pixel{}, sample{}, stream{};
  std::array<Row<float>, kScatteringNumbers> numbers{};
  Row<float> g{};                         ///< Mean cosine of the phase function.
  std::array<Row<float>, 3> direction{};  ///< Of travel, before [world].
  std::array<Row<float>, 3> to_light{};   ///< Towards the light that was drawn [world].
  Row<float> light_value{};               ///< Phase function towards it [1/sr].
  std::array<Row<float>, 3> next{};       ///< Direction of travel, after [world].
  Row<float> next_pdf{};                  ///< Of that [1/sr].
};

/// Scatterings as compiled for one target; the same bits on all of them.
struct ScatteringKernels {
  /// Draws the numbers of scatterings: uniform in (0,1), as RandomStream draws them.
  void (*draw_numbers)(ScatteringStream& scatterings, uint64_t seed) = nullptr;
  /// Evaluates the phase function of Henyey and Greenstein towards the lights, and draws next
  /// directions from it, by the numbers that were drawn.
  void (*scatter)(ScatteringStream& scatterings) = nullptr;
};

}  // namespace freepath
