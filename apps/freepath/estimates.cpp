#include "apps/freepath/estimates.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath::program {

void print_estimate(const std::string& name, const Estimate& estimate, uint64_t paths) {
  constexpr double kFixed = 1e-3;  // below, six decimals say too little
  if (estimate.upper) {
    print("{:<15}  < {:.2g}  (95 %; none of {})\n", name, *estimate.upper, counted(paths, "path"));
  } else if (estimate.mean != 0 && std::abs(estimate.mean) < kFixed) {
    print("{:<15}{:>10.4e}  +- {:.1e}\n", name, estimate.mean, estimate.error);
  } else {
    print("{:<15}{:>10.6f}  +- {:.6f}\n", name, estimate.mean, estimate.error);
  }
}

void put_estimate(nlohmann::ordered_json& json, const std::string& name, const Estimate& estimate) {
  json[name] = estimate.mean;
  json[name + "_error"] = estimate.error;
  if (!estimate.upper) return;
  json[name + "_error"] = nullptr;  // there is none
  json[name + "_upper"] = *estimate.upper;
}

uint64_t paths_for_error(double error, double pilot_error, std::string_view option) {
  constexpr double kMargin = 1.05;  // the pilot knows the variance to a percent or so
  constexpr double kMost = 1e15;
  const double paths = kMargin * std::pow(pilot_error / error, 2) * kPilotPaths;
  if (paths > kMost) fail("{}: {} takes {:.2g} paths: give a larger one", option, error, paths);
  return std::max<uint64_t>(kPilotPaths, static_cast<uint64_t>(paths));
}

double parse_error(const std::string& text, std::string_view option) {
  const std::vector<double> numbers = parse_numbers(text, option);
  if (numbers.size() != 1 || !(numbers[0] > 0 && numbers[0] < 1)) {
    fail("{}: '{}' is not one number between 0 and 1, the standard error to reach", option, text);
  }
  return numbers[0];
}

}  // namespace freepath::program
