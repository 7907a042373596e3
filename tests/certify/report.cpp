#include "tests/certify/report.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "freepath/base/version.h"
#include "tests/certify/pinned.h"
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

/// What cases come to together.
MethodVerdict pool(const std::vector<const CaseResult*>& results) {
  MethodVerdict verdict;
  verdict.cases = results.size();
  std::vector<double> errors;
  double sum = 0;
  for (const CaseResult* result : results) {
    for (const Check& check : result->checks) {
      if (!check.principal) continue;
      ++verdict.principal;
      if (check.standing != Standing::kTested) continue;
      ++verdict.principal_tested;
      if (check.standard_error > 0 && check.exact > 0) errors.push_back(check.relative_error());
    }
    if (!result->signed_z) continue;
    ++verdict.pooled;
    sum += *result->signed_z;
  }
  if (verdict.pooled > 0) verdict.pooled_z = sum / std::sqrt(static_cast<double>(verdict.pooled));
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    verdict.median_error = *middle;
  }
  return verdict;
}

using Method = std::pair<bool, std::string>;  // first the trackers

std::vector<MethodVerdict> pool_methods(const std::vector<CaseResult>& results) {
  std::map<Method, std::vector<const CaseResult*>> by_method;
  for (const CaseResult& result : results) {
    by_method[{!result.test.free_paths, result.test.method_name()}].push_back(&result);
  }
  std::vector<MethodVerdict> verdicts;
  for (const auto& [method, cases] : by_method) {
    verdicts.push_back(pool(cases));
    verdicts.back().free_paths = !method.first;
    verdicts.back().method = method.second;
  }
  return verdicts;
}

std::string name_of(const MethodVerdict& method) {
  return fmt::format("{} `{}`", method.free_paths ? "tracker" : "transmittance", method.method);
}

}  // namespace

bool Verdict::passes(const MethodVerdict& method) const {
  return std::abs(method.pooled_z) <= threshold;
}

std::vector<std::string> shortfalls(const Verdict& verdict) {
  std::vector<std::string> lines;
  for (const Floor& floor : floors()) {
    const auto method = std::find_if(
        verdict.methods.begin(), verdict.methods.end(), [&](const MethodVerdict& found) {
          return found.method == floor.method && found.free_paths == floor.free_paths;
        });
    if (method == verdict.methods.end()) {
      lines.push_back(fmt::format("no case certifies '{}'", floor.method));
    } else if (method->principal_tested < floor.count || method->counted() < floor.share) {
      lines.push_back(fmt::format(
          "{}: {} comparisons count, a share of {:.3f}; {} have to, or {:.3f}", name_of(*method),
          method->principal_tested, method->counted(), floor.count, floor.share));
    }
  }
  if (!(verdict.together.median_error <= kLargestMedianError)) {
    lines.push_back(fmt::format("the median relative standard error is {:.3g}, at most {:.3g}",
                                verdict.together.median_error, kLargestMedianError));
  }
  return lines;
}

Verdict judge(const std::vector<CaseResult>& results) {
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
  verdict.methods = pool_methods(results);
  std::vector<const CaseResult*> all;
  all.reserve(results.size());
  for (const CaseResult& result : results) all.push_back(&result);
  verdict.together = pool(all);
  verdict.together.method = "all";
  const std::size_t tests = verdict.tested + verdict.methods.size() + 1;
  verdict.threshold = family_wise_threshold(kCertifyLevel, tests);
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
  out.print(
      "\n## Methods\n\nThe pooled z is $\\sum z/\\sqrt n$ over the cases whose errors are clear of "
      "rounding, with signs: it shows a bias that is too small for each of them. The error is the "
      "median relative standard error.\n\n| method | cases | comparisons that count | error | "
      "pooled "
      "z | of cases |\n|---|---|---|---|---|---|\n");
  std::vector<MethodVerdict> rows = verdict.methods;
  rows.push_back(verdict.together);
  for (const MethodVerdict& method : rows) {
    out.print("| {} | {} | {} of {} | {:.2g} % | {:.2f}{} | {} |\n",
              method.method == "all" ? "all" : name_of(method), method.cases,
              method.principal_tested, method.principal, 100 * method.median_error, method.pooled_z,
              verdict.passes(method) ? "" : " **fails**", method.pooled);
  }
  for (const auto& [key, cases] : by_method) {
    out.print("\n## {} `{}`\n\n", key.first ? "Transmittance" : "Tracker", key.second);
    out.print("| medium | modes | estimate | exact | z | paths | look-ups | variance |\n");
    out.print("|---|---|---|---|---|---|---|---|\n");
    for (const CaseResult* result : cases) out.print("{}", row(*result, verdict.threshold));
  }
}

}  // namespace freepath::testing
