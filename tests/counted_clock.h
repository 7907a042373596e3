#pragma once
/// @file Time that is counted, so that no test depends on how busy or fast the machine is.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

namespace freepath::testing {

/// What passes of a counted clock whenever it is asked, where nothing else is said [s].
inline constexpr double kCountedTick = 1e-3;

/// A clock for RenderSettings::clock that goes on by a tick whenever it is asked, from any thread:
/// the renderer asks before every flight of its paths.
inline std::function<double()> counted_clock(double tick = kCountedTick) {
  const auto asked = std::make_shared<std::atomic<uint64_t>>(0);
  return [asked, tick] { return tick * static_cast<double>((*asked)++); };
}

}  // namespace freepath::testing
