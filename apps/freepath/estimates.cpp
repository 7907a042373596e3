#include "apps/freepath/estimates.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/freepath/console.h"
#include "freepath/base/counted.h"

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

}  // namespace freepath::program
