#include <fmt/format.h>
#include <tbb/info.h>

#include <fstream>
#include <string>

#include "freepath/base/counted.h"
#include "freepath/study/comparison_report.h"

namespace freepath {

std::string machine_text(const RenderSettings& settings) {
  std::ifstream info("/proc/cpuinfo");
  std::string line;
  std::string processor = "unknown processor";
  while (std::getline(info, line)) {
    if (line.compare(0, 10, "model name") != 0) continue;
    processor = line.substr(std::min(line.find(':') + 2, line.size()));
    break;
  }
  const int threads = settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
  Simd simd = settings.walk.simd;
  if (simd == Simd::kBest) simd = available_simd().front();
  return fmt::format("{}, {}, {}", processor, counted(threads, "thread"), to_string(simd));
}

}  // namespace freepath
