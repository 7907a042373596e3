#include "freepath/lights/pixel_draws.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

namespace freepath {

PixelDraws::PixelDraws(std::vector<double> importance, std::vector<double> solid_angles)
    : width_(importance.size() / solid_angles.size()), solid_angles_(std::move(solid_angles)) {
  const bool is_black =
      std::all_of(importance.begin(), importance.end(), [](double value) { return value == 0; });
  if (is_black) std::fill(importance.begin(), importance.end(), 1.0);
  std::vector<double> row_power;
  columns_.reserve(importance.size());
  for (std::size_t row = 0; row < solid_angles_.size(); ++row) {
    const std::span<const double> pixels(importance.data() + row * width_, width_);
    const double sum = std::accumulate(pixels.begin(), pixels.end(), 0.0);
    row_power.push_back(sum * solid_angles_[row]);
    if (sum > 0) {
      const std::vector<AliasEntry> table = make_alias_table(pixels);
      columns_.insert(columns_.end(), table.begin(), table.end());
    } else {
      columns_.insert(columns_.end(), width_, AliasEntry{1, 0});  // a row that is never chosen
    }
  }
  rows_ = make_alias_table(row_power);
  const double power = std::accumulate(row_power.begin(), row_power.end(), 0.0);
  pdf_.reserve(importance.size());
  for (const double value : importance) pdf_.push_back(static_cast<float>(value / power));
}

PixelDraws PixelDraws::above_mean() const {
  std::vector<double> excess;
  excess.reserve(pdf_.size());
  for (const float pdf : pdf_) {
    excess.push_back(std::max(double{pdf} - double{kUniformSpherePdf}, 0.0));
  }
  return {std::move(excess), solid_angles_};
}

double PixelDraws::gain_above_mean() const {
  // Directions count by their share of the sphere, brightnesses in units of the mean; so the
  // density of drawing one is its excess over that of all.
  const auto mean_of = [&](const auto& value) {
    double sum = 0;
    for (std::size_t row = 0; row < solid_angles_.size(); ++row) {
      const double share = solid_angles_[row] * kUniformSpherePdf;
      for (std::size_t i = row * width_; i < (row + 1) * width_; ++i) {
        sum += share * value(double{pdf_[i]} / kUniformSpherePdf);
      }
    }
    return sum;
  };
  const auto excess = [](double brightness) { return std::max(brightness - 1, 0.0); };
  const double all = mean_of(excess);
  if (all == 0) return 0;
  const auto density = [&](double brightness) { return excess(brightness) / all; };
  // Part that either way brings of a direction, by the balance heuristic.
  const auto part = [&](double brightness) { return brightness / (1 + density(brightness)); };
  const double by_chance = mean_of(part);
  const double squared_by_chance =
      mean_of([&](double brightness) { return part(brightness) * part(brightness); });
  const double drawn =
      mean_of([&](double brightness) { return density(brightness) * part(brightness); });
  const double squared_drawn = mean_of(
      [&](double brightness) { return density(brightness) * part(brightness) * part(brightness); });
  // Variance of two draws, each lit with a chance of 1/2.
  const double variance_drawn = squared_drawn - drawn * drawn / 2;
  const double without = mean_of([](double brightness) { return brightness * brightness; }) - 1;
  return without / (squared_by_chance - by_chance * by_chance + variance_drawn);
}

}  // namespace freepath
