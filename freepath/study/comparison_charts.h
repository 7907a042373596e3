#pragma once
/// @file The charts of a comparison.

#include <string>
#include <vector>

#include "freepath/study/comparison.h"

namespace freepath {

/// A drawing and the name of its file.
struct NamedFigure {
  std::string file_name;
  std::string caption;
  std::string svg;
  bool is_wide = false;
};

/// Efficiency, convergence, errors, look-ups, time.
std::vector<NamedFigure> figures_of(const Comparison& comparison);

}  // namespace freepath
