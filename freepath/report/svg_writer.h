#pragma once
/// @file Writing SVG: elements, text and the frame that all charts share.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freepath/report/axis_ticks.h"

namespace freepath {

/// A rectangle [units of the drawing, y downwards].
struct SvgBox {
  double left = 0, top = 0, right = 0, bottom = 0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

/// A coordinate, to a hundredth, without needless digits.
std::string coordinate(double value);

/// How wide a text is about, on the wide side: fonts differ, and this knows none of them.
/// @param size of the font
double text_width(std::string_view text, double size);
double text_width(const TickLabel& label, double size);

/// A text broken between words into lines that are not wider, as far as its words allow.
std::vector<std::string> wrapped(const std::string& text, double size, double width);

/// A text, cut off with an ellipsis where it is wider.
std::string shortened(const std::string& text, double size, double width);

enum class TextAnchor { kStart, kMiddle, kEnd };

/// Sizes of type.
inline constexpr double kTitleSize = 16;
inline constexpr double kLabelSize = 13;
inline constexpr double kTickSize = 12;

/// Puts an SVG file together. Colours are set on groups, by a class whose value the style sheet
/// gives for light, dark and print; the elements below use `currentColor`. The light colour stands
/// in an attribute as well, for programs that know no style sheets.
///
/// Nothing has an id, and all charts share one style sheet, so that any number of them can stand in
/// one HTML page. `data-theme="light"` or `"dark"` on the page's root decides over the reader's
/// preference.
class SvgWriter {
 public:
  /// @param summary what is said to those who do not see the drawing
  SvgWriter(double width, double height, std::string_view title, std::string_view summary);

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    text_ += fmt::format(format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  /// Everything until end_group() is in the colour of a series, counted from 0.
  void begin_series(int number);
  /// ... in one of the colours "ink", "soft", "grid", "bar" and "best".
  void begin_ink(std::string_view name);
  /// What is drawn until end_group() is cut off at a box's sides.
  void begin_clip(const SvgBox& box);
  void end_clip();
  void end_group() { add("</g>"); }

  void line(double x0, double y0, double x1, double y1, std::string_view attributes = {});
  /// @param markup escaped already
  void text(double x, double y, TextAnchor anchor, double size, std::string_view markup,
            std::string_view attributes = {});
  void label(double x, double y, TextAnchor anchor, const TickLabel& label);
  /// The title's lines, from the top left corner.
  void title(const std::vector<std::string>& lines);

  /// The whole file.
  std::string finished() &&;

 private:
  std::string text_;
};

}  // namespace freepath
