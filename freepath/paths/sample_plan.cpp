#include "freepath/paths/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace freepath {
namespace {

/// The time of a sample that meets nothing, in look-ups.
constexpr double kLookupsOfSample = 10;
/// Neighbours at each side that the deviation of a square is averaged over.
constexpr int kReach = 2;
constexpr int kHalvings = 40;

/// Means over the squares around each; at the edges of those there are.
std::vector<double> smoothed(const std::vector<double>& values, int width, int height) {
  std::vector<double> result(values.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(0, y - kReach); v <= std::min(height - 1, y + kReach); ++v) {
        for (int u = std::max(0, x - kReach); u <= std::min(width - 1, x + kReach); ++u) {
          sum += values[static_cast<std::size_t>(v) * width + u];
          ++count;
        }
      }
      result[static_cast<std::size_t>(y) * width + x] = sum / count;
    }
  }
  return result;
}

/// The shares whose mean is 1, in proportion to what is wanted as far as their steps go.
std::vector<SampleShare> shares_in_proportion(const std::vector<double>& wanted) {
  const auto count = static_cast<double>(wanted.size());
  std::vector<SampleShare> shares(wanted.size());
  const double mean = std::accumulate(wanted.begin(), wanted.end(), 0.0) / count;
  if (!(mean > 0)) return shares;
  const auto mean_at = [&](double scale) {
    double sum = 0;
    for (const double value : wanted) sum += SampleShare::next_to(scale * value).value();
    return sum / count;
  };
  double low = SampleShare::kSmallest / mean;
  double high = SampleShare::kLargest / mean;
  // Few pixels may want all, and then can't have it.
  for (int i = 0; i < kHalvings && mean_at(high) < 1; ++i) high *= 2;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (mean_at(middle) > 1 ? high : low) = middle;
  }
  // Of those that are between two steps so many take the higher one that the mean is 1.
  const double below = mean_at(low);
  const double above = mean_at(high);
  const double part = above > below ? std::clamp((1 - below) / (above - below), 0.0, 1.0) : 0.0;
  double carried = 0.5;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    shares[i] = SampleShare::next_to(low * wanted[i]);
    const SampleShare more = SampleShare::next_to(high * wanted[i]);
    if (shares[i] == more) continue;
    carried += part;
    if (carried < 1) continue;
    carried -= 1;
    shares[i] = more;
  }
  return shares;
}

}  // namespace

PilotGrid PilotGrid::over(int width, int height) {
  PilotGrid grid{1, width, height};
  while (int64_t{grid.width} * grid.height > kMostSquares) {
    ++grid.edge;
    grid.width = (width + grid.edge - 1) / grid.edge;
    grid.height = (height + grid.edge - 1) / grid.edge;
  }
  return grid;
}

std::vector<SampleShare> shares_of_pilot(const Film& pilot) {
  const std::size_t count = pilot.pixel_count();
  std::vector<double> deviations(count);
  std::vector<double> lookups(count);
  for (std::size_t i = 0; i < count; ++i) {
    double variance = 0;
    for (int channel = 0; channel < kChannels; ++channel) variance += pilot.variance(i, channel);
    // Where a path's weight overflowed nothing is known; the film itself says so.
    deviations[i] = std::isfinite(variance) ? std::sqrt(variance) : 0;
    lookups[i] = pilot.mean_lookups(i);
  }
  deviations = smoothed(deviations, pilot.width(), pilot.height());
  lookups = smoothed(lookups, pilot.width(), pilot.height());
  std::vector<double> wanted(count);
  for (std::size_t i = 0; i < count; ++i) {
    wanted[i] = std::sqrt(deviations[i] / std::sqrt(kLookupsOfSample + lookups[i]));
  }
  return shares_in_proportion(wanted);
}

void give_shares(const std::vector<SampleShare>& shares, const PilotGrid& grid, Film& film) {
  const auto columns = static_cast<uint32_t>(film.window().full_width);
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    const uint32_t in_picture = film.window().in_picture(pixel);
    const std::size_t x = in_picture % columns / grid.edge;
    const std::size_t y = in_picture / columns / grid.edge;
    film.set_share(pixel, shares[y * grid.width + x]);
  }
}

}  // namespace freepath
