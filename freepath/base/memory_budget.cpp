#include "freepath/base/memory_budget.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr double kUsable = 0.8;  // of the memory present: the rest is for what is made of an input

uint64_t least_present() {
  auto present =
      static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  // A container's limit: "max", or a number, in either version of control groups.
  for (const char* const name :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream file(name);
    uint64_t limit = 0;
    if (file >> limit && limit > 0) present = std::min(present, limit);
  }
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    present = std::min<uint64_t>(present, space.rlim_cur);
  }
  return present;
}

}  // namespace

uint64_t memory_present() {
  static const uint64_t kPresent = least_present();
  return kPresent;
}

void check_memory_present(std::string_view name, std::string_view what, double needed) {
  constexpr double kGigabyte = 1e9;
  const auto present = static_cast<double>(memory_present());
  if (needed <= kUsable * present) return;
  fail("{}: {} need {:.3g} GB of memory, and {:.3g} GB are present; make it smaller", name, what,
       needed / kGigabyte, present / kGigabyte);
}

void check_declared(std::string_view name, std::string_view what, double decoded, uint64_t stored) {
  constexpr double kLargestExpansion = 1 << 16;
  constexpr double kFreeOfDoubt = 1 << 26;
  if (decoded <= std::max(kFreeOfDoubt, kLargestExpansion * static_cast<double>(stored))) return;
  fail(
      "{}: it declares {}, but has only {} bytes: it is truncated or damaged; copy or export it "
      "again",
      name, what, stored);
}

}  // namespace freepath
