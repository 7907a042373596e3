#pragma once
/// @file Comparisons as Python holds them.

#include <vector>

#include "freepath/study/comparison.h"

namespace freepath::python {

/// References of a comparison, which other processes may measure against.
struct PythonReferences {
  std::vector<Reference> references;
};

}  // namespace freepath::python
