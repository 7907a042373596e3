#pragma once
/// @file Reports: pages of text, tables, charts and pictures in one HTML file.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace freepath {

/// The bytes of a PNG file.
using PngBytes = std::vector<uint8_t>;

/// A heading of a section, with an anchor and a line in the page's list of contents.
struct PageHeading {
  std::string text;
};

/// Plain text.
struct PageText {
  std::string text;
};

/// Text in the type of programs, such as a command, with a button that copies it.
struct PageCode {
  std::string text;
};

/// A cell of a table: what is shown, and what the column is sorted by.
struct PageCell {
  std::string text;
  double number = 0;      ///< Key to sort by, where the column is of numbers.
  std::string note = {};  ///< Small, below the text: an interval, say; may be empty.
  enum class Tone { kPlain, kBest, kGood, kBad, kFaint } tone = Tone::kPlain;
};

struct PageColumn {
  std::string name;
  std::string meaning;     ///< Shown when the pointer rests on the name; may be empty.
  bool is_numeric = true;  ///< Aligned to the right and sorted by PageCell::number.
};

/// A table; a click on a column's name sorts it by that column.
struct PageTable {
  std::vector<PageColumn> columns;
  std::vector<std::vector<PageCell>> rows;  ///< Rows, each of as many cells as there are columns.
  std::string caption = {};
};

/// An SVG drawing (chart.h), with a link that saves it under a name.
struct PageFigure {
  std::string svg;
  std::string file_name;  ///< "convergence.svg"
  std::string caption = {};
  bool is_wide = false;  ///< The whole width of the page; others stand two by two.
};

/// Pictures of one size, laid over each other: two are chosen from lists, and a slider moves the
/// seam between them. The wheel and buttons zoom, dragging moves; pixels stay sharp.
struct PagePictures {
  struct Picture {
    std::string name;
    PngBytes png;
  };
  std::vector<Picture> pictures;
  int width = 0, height = 0;  ///< [pixels]
  std::string caption = {};
};

/// Small pictures side by side, each with its name, above one colour scale.
struct PageMaps {
  std::vector<PagePictures::Picture> maps;
  PngBytes scale;                 ///< The colours from left to right, one pixel high or more.
  std::string low, middle, high;  ///< Values at the scale's ends and middle.
  std::string caption = {};
};

using PageBlock =
    std::variant<PageHeading, PageText, PageCode, PageTable, PageFigure, PagePictures, PageMaps>;

/// What a report says, from top to bottom.
struct Page {
  std::string title;
  std::string subtitle;
  std::vector<PageBlock> blocks;
};

/// One HTML file that needs no other and no network: styles, scripts and pictures are inside. It
/// follows the reader's choice of light or dark, has a switch for it, prints in black on white with
/// all of its pictures, and can be read without scripts. Once its scripts ran, `<html>` has the
/// attribute data-ready="yes", and data-errors with the number of errors that they met. With
/// `?theme=light` or `?theme=dark` in its address it opens in that.
/// @throws Error where a row of a table has not as many cells as there are columns
std::string to_html(const Page& page);

}  // namespace freepath
