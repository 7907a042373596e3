#pragma once
/// @file The blocks of a page as HTML.

#include <string>

#include "freepath/report/page.h"

namespace freepath {

/// Text is escaped; SVG drawings are taken as they are.
/// @{
std::string block_html(const PageText& block);
std::string block_html(const PageCode& block);
std::string block_html(const PageFigure& block);
std::string block_html(const PagePictures& block);
std::string block_html(const PageMaps& block);
/// @throws Error where a row has not as many cells as there are columns
std::string block_html(const PageTable& block);
/// @}

}  // namespace freepath
