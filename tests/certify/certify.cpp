/// @file Runs the certifying suite and writes its report: the pairwise set, or every case there is.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tests/certify/report.h"

namespace freepath::testing {
namespace {

struct Options {
  bool full = false;
  std::string method;
  std::string output;
  double relative_error = CertifyBudget{}.relative_error;
  double most_paths = static_cast<double>(CertifyBudget{}.most_paths);
};

std::vector<CertifiedCase> choose_cases(const Options& options) {
  std::vector<CertifiedCase> cases;
  for (const bool free_paths : {true, false}) {
    for (CertifiedCase& test : options.full ? all_cases(free_paths) : pairwise_cases(free_paths)) {
      if (test.method.find(options.method) != std::string::npos) cases.push_back(std::move(test));
    }
  }
  return cases;
}

int run(const Options& options) {
  const std::vector<CertifiedCase> cases = choose_cases(options);
  CertifyBudget budget;
  budget.relative_error = options.relative_error;
  budget.most_paths = static_cast<uint64_t>(options.most_paths);
  std::vector<CaseResult> results(cases.size());
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    try {
      results[i] = measure(cases[i], budget);
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}: {}", cases[i].name(), error.what()));
    }
    const std::size_t now = ++done;
    if (now % 100 == 0) fmt::print(stderr, "{} of {} cases\n", now, cases.size());
  });
  const Verdict verdict = judge(results);
  for (const CaseResult* failed : verdict.failed) {
    fmt::print(stderr, "fails: {}\n", failed->test.name());
    for (const Check& check : failed->checks) {
      fmt::print(stderr, "  {}: {:.6g} +- {:.2g}, exact {:.6g}, z = {:.2f}\n", check.quantity,
                 check.estimate, check.standard_error, check.exact, check.z);
    }
  }
  fmt::print("{} of {} radiances and transmittances count\n", verdict.principal_tested,
             verdict.principal);
  fmt::print(
      "{} cases, {} comparisons, {} rare, {} heavy; |z| up to {:.2f} passes; {} cases fail\n",
      cases.size(), verdict.tested, verdict.rare, verdict.heavy, verdict.threshold,
      verdict.failed.size());
  if (!options.output.empty()) {
    write_report(options.output,
                 options.full ? "Certification: every case" : "Certification: all pairs", results,
                 verdict);
  }
  bool passes = verdict.failed.empty();
  std::vector<MethodVerdict> pooled = verdict.methods;
  pooled.push_back(verdict.together);
  for (const MethodVerdict& method : pooled) {
    const bool good = verdict.passes(method);
    fmt::print("{:<24} {:4} cases, {:4} of {:4} count, median error {:.2g} %, pooled z {:5.2f}{}\n",
               method.method, method.cases, method.principal_tested, method.principal,
               100 * method.median_error, method.pooled_z, good ? "" : " FAILS");
    passes = passes && good;
  }
  if (!options.full && options.method.empty()) {
    for (const std::string& line : shortfalls(verdict)) {
      fmt::print(stderr, "fails: {}\n", line);
      passes = false;
    }
  }
  return passes ? 0 : 1;
}

}  // namespace
}  // namespace freepath::testing

int main(int argc, char** argv) {
  using freepath::testing::Options;
  CLI::App program("Certifies every tracker and transmittance estimator against quadrature");
  Options options;
  program.add_flag("--full", options.full, "Every case, instead of a set that covers all pairs");
  program.add_option("--method", options.method, "Only methods whose spelling contains this");
  program.add_option("-o,--output", options.output, "Report to write (Markdown)");
  program.add_option("--relative-error", options.relative_error, "Wanted of the radiance")
      ->capture_default_str();
  program.add_option("--most-paths", options.most_paths, "Of a case")->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    return freepath::testing::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "certify: {}\n", error.what());
    return 2;
  }
}
