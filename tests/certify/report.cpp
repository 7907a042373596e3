#include "tests/certify/report.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <map>

#include "freepath/base/version.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

/// The check that stands for a case in the table: the first, which is of radiance or transmittance.
std::string row(const CaseResult& result, double threshold) {
  const Check& first = result.checks.front();
  const double z = largest_z(result);
  const std::size_t counted =
      std::count_if(result.checks.begin(), result.checks.end(),
                    [](const Check& check) { return check.standing == Standing::kTested; });
  return fmt::format(
      "| {} | {} | {:.6g} ± {:.1g} | {:.6g} | {:.2f} of {}{} | {} | {:.3g} | {:.3g} |\n",
      certified_media()[result.test.medium].name, result.test.modes(), first.estimate,
      first.standard_error, first.exact, z, counted, z > threshold ? " **fails**" : "",
      result.paths, result.lookups, result.variance);
}

}  // namespace

Verdict judge(const std::vector<CaseResult>& results, double level) {
  Verdict verdict;
  for (const CaseResult& result : results) {
    for (const Check& check : result.checks) {
      if (check.standing == Standing::kTested) ++verdict.tested;
      if (check.principal) ++verdict.principal;
      if (check.principal && check.standing == Standing::kTested) ++verdict.principal_tested;
      if (check.standing == Standing::kRare) ++verdict.rare;
      if (check.standing == Standing::kHeavy) ++verdict.heavy;
    }
  }
  verdict.threshold = family_wise_threshold(level, std::max<std::size_t>(1, verdict.tested));
  for (const CaseResult& result : results) {
    if (!(largest_z(result) <= verdict.threshold)) verdict.failed.push_back(&result);
  }
  return verdict;
}

void write_report(const std::filesystem::path& path, const std::string& title,
                  const std::vector<CaseResult>& results, const Verdict& verdict) {
  std::map<std::pair<bool, std::string>, std::vector<const CaseResult*>> by_method;
  uint64_t paths = 0;
  for (const CaseResult& result : results) {
    by_method[{!result.test.free_paths, result.test.method}].push_back(&result);
    paths += result.statistics.rays;
  }
  fmt::ostream out = fmt::output_file(path.string());
  out.print("# {}\n\n", title);
  out.print(
      "Written by `scripts/certify`, freepath {}. {} cases, {} comparisons that count, {:.3g} "
      "paths. The family-wise level is {}, so a comparison passes up to |z| = {:.2f}; **{} cases "
      "fail**. {} comparisons are of events too rare for a mean to be normal, {} of weights spread "
      "too widely: they do not count ([testing](testing.md)). Of {} radiances and transmittances "
      "{} count.\n\n",
      version(), results.size(), verdict.tested, static_cast<double>(paths), kCertifyLevel,
      verdict.threshold, verdict.failed.size(), verdict.rare, verdict.heavy, verdict.principal,
      verdict.principal_tested);
  out.print(
      "Estimate and exact value are of the first channel: collected radiance of trackers, "
      "transmittance of estimators. z is the largest of the case's comparisons (radiance and "
      "escaping weight per channel, distribution of free paths), look-ups and variance are those "
      "of a path.\n");
  for (const auto& [key, cases] : by_method) {
    out.print("\n## {} `{}`\n\n", key.first ? "Transmittance" : "Tracker", key.second);
    out.print("| medium | modes | estimate | exact | z | paths | look-ups | variance |\n");
    out.print("|---|---|---|---|---|---|---|---|\n");
    for (const CaseResult* result : cases) out.print("{}", row(*result, verdict.threshold));
  }
}

}  // namespace freepath::testing
