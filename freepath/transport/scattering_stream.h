#pragma once
/// @file Scatterings in media, in arrays that lanes read and write.

#include <array>
#include <cstddef>
#include <cstdint>

namespace freepath {

/// Numbers that a scattering draws, in this order; streams of one path have more behind them.
enum ScatteringNumber : uint32_t {
  kRouletteNumber = 0,
  kPhaseNumber = 1,   ///< Two.
  kShadowNumber = 3,  ///< Whether to cast a shadow ray.
  kLightNumber = 4,   ///< Three; only where draws of lights differ.
  kScatteringNumbers = 7,
};
/// Blocks of four random words that these take, with those of the light and without.
inline constexpr uint32_t kScatteringBlocks = 2;
inline constexpr uint32_t kBlocksWithoutLight = 1;

/// Scatterings in slots [0, count), of the rays of one walk. What has no value yet is finite, so
/// that lanes may read it.
struct ScatteringStream {
  /// Scatterings, as many as the nearest cache holds with their paths; a multiple of the lanes of
  /// any target.
  static constexpr std::size_t kCapacity = 64;
  template <class T>
  using Row = std::array<T, kCapacity>;

  std::size_t count = 0;
  /// Slot of the ray and its flight in the streams of the walk.
  alignas(64) Row<uint32_t> ray{};
  // Where their random numbers stand.
  Row<uint32_t> pixel{}, sample{}, stream{};
  std::array<Row<float>, kScatteringNumbers> numbers{};
  Row<float> magnitude{};  ///< Largest magnitude of the path's throughput.
  /// Probability with which the path goes on, [0, 1], by Russian roulette: if the number that is
  /// drawn for it is below. Its throughput is to be divided by that. Of branches 1: they play by
  /// lobe_survival.
  Row<float> survival{};
  Row<float> g{};                         ///< Mean cosine of the phase function.
  std::array<Row<float>, 3> position{};   ///< [world, relative to the scene's origin]
  std::array<Row<float>, 3> direction{};  ///< Direction of travel before [world].
  // Of the light that was drawn, where one was.
  std::array<Row<float>, 3> to_light{};  ///< Direction towards it [world].
  Row<float> light_pdf{};                ///< LightSample::pdf.
  Row<float> light_found{};  ///< 1 where paths find it by chance too, else 0: multiple importance.
  /// What it would bring unshadowed if the phase function were 1 and no path found it, before
  /// roulette of the path; see ShadowRoulette::least. Huge where its shadow ray does not play.
  Row<float> brightness{};
  Row<uint32_t> is_given{};  ///< Not 0 where light_value is given: the function is not of `g`.
  Row<float> light_value{};  ///< Phase function towards it [1/sr].
  /// Weight of its radiance where a shadow ray is cast, over the probability of that; else 0.
  Row<float> shadow_weight{};
  std::array<Row<float>, 3> next{};  ///< Direction of travel, after [world].
  Row<float> next_pdf{};             ///< Density of that direction [1/sr].
  // Of branches: LobeBranch.
  /// Largest magnitude of what is left of the throughput for a sun, before roulette of the path.
  Row<float> lobe_scale{};
  /// Below what a branch plays Russian roulette; 0 for others, by which branches are told.
  Row<float> lobe_roulette{};
  Row<float> lobe_survival{};  ///< With what probability a branch goes on, (0, 1].
  Row<float> lobe_chance{};    ///< With what probability a path that goes on splits.

  /// Scatterings, one in each bit.
  using Set = uint64_t;
  static_assert(kCapacity == 64);
  Set cast = 0;  ///< Those whose shadow ray is cast; a path that roulette ends casts none.
};

}  // namespace freepath
