#pragma once
/// @file The laboratory's findings as numbers for other programs.

#include <string>
#include <string_view>

#include "freepath/study/lab.h"

namespace freepath {

/// One JSON object; what is not a finite number is null.
std::string lab_json(const LabResult& result);

/// A line a number: setting, tracker, channel, quantity, at (x, a weight, an option's value, ...),
/// value, standard_error, exact. What there is not is empty.
std::string lab_csv(const LabResult& result);

/// "agrees", "differs", ...
std::string_view to_string(LabVerdict verdict);
std::string_view to_string(LabStanding standing);

}  // namespace freepath
