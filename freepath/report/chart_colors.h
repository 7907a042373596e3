#pragma once
/// @file The colours of charts, for light and dark.

#include <array>
#include <string_view>

namespace freepath {

/// Colours of series, in order; from the ninth on they begin again. Each stands out from the paper
/// (contrast 3:1 and more, WCAG 2.1), and any two of them differ, in hue or lightness, for readers
/// who lack one kind of cones too (simulated as in Machado et al. 2009).
inline constexpr std::array<std::string_view, 8> kLightPalette = {
    "#2450c8", "#e4471a", "#00704c", "#d05c94", "#7b9432", "#4090e4", "#562f76", "#74542a"};
inline constexpr std::array<std::string_view, 8> kDarkPalette = {
    "#6a8cf7", "#ee6a2c", "#22d694", "#d070a0", "#f2da48", "#b8dcf0", "#b39be8", "#c69660"};

/// What is not a series.
struct ChartInks {
  std::string_view paper, ink, soft, grid, bar, best;
};
inline constexpr ChartInks kLightInks = {"#ffffff", "#1d2126", "#5b6470",
                                         "#e3e6ea", "#a9b7cc", "#2450c8"};
inline constexpr ChartInks kDarkInks = {"#15181c", "#e6e9ed", "#9ca5b1",
                                        "#2c3138", "#56647c", "#6a8cf7"};
inline constexpr ChartInks kPrintInks = {"#ffffff", "#000000", "#000000",
                                         "#d4d4d4", "#a9b7cc", "#2450c8"};

}  // namespace freepath
