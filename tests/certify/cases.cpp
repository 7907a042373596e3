#include "tests/certify/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/random.h"

namespace freepath::testing {
namespace {

/// Values at which numbers are certified besides their standard.
const std::map<std::string_view, std::vector<std::string>>& certified_values() {
  static const std::map<std::string_view, std::vector<std::string>> kValues = {
      {"rate-scale", {"3", "0.7"}}, {"control", {"0.5", "1.3"}}, {"roulette", {"0"}},
      {"coverage", {"0.9"}},        {"order-zero", {"0.5"}},     {"orders", {"4"}},
      {"points-scale", {"2"}}};
  return kValues;
}

/// The values of an option that are not its standard.
std::vector<std::string> values_of(const MethodOption& option) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < option.choices.size(); ++i) {
    if (static_cast<float>(i) != option.default_value) values.emplace_back(option.choices[i]);
  }
  if (!option.choices.empty()) return values;
  const auto found = certified_values().find(option.name);
  if (found == certified_values().end()) {
    throw std::logic_error("tests/certify/cases.cpp does not say which values of the option '" +
                           std::string(option.name) + "' to certify");
  }
  return found->second;
}

/// Properties of a case as numbers, to enumerate and to pair them.
constexpr int kProperties = 8;
using Levels = std::array<int, kProperties>;

using Pair = std::array<int, 4>;  // property, its level, another property, its level
/// What follows from a property, and stands for it in some pairs: a spelling's method, and a
/// medium's kind.
constexpr int kMethod = kProperties;
constexpr int kKind = kProperties + 1;

class CaseSpace {
 public:
  explicit CaseSpace(bool free_paths)
      : free_paths_(free_paths), variants_(certified_variants(free_paths)) {
    counts_ = {static_cast<int>(variants_.size()),
               static_cast<int>(certified_media().size()),
               3,
               2,
               2,
               free_paths ? 2 : 1,
               free_paths ? 2 : 1,
               2};
    for (const std::string& variant : variants_) {
      const std::string name = variant.substr(0, variant.find(':'));
      if (method_names_.empty() || method_names_.back() != name) method_names_.push_back(name);
      method_of_.push_back(static_cast<int>(method_names_.size()) - 1);
    }
    for (const CertifiedMedium& medium : certified_media()) {
      const std::string kind = kind_of(medium);
      const auto found = std::find(kinds_.begin(), kinds_.end(), kind);
      kind_of_.push_back(static_cast<int>(found - kinds_.begin()));
      if (found == kinds_.end()) kinds_.push_back(kind);
    }
    possible_.resize(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2] * counts_[3]);
    Levels levels{};
    do possible_[index(levels)] = !reason_against(make(levels));
    while (advance(levels, kDecisive));
  }

  const Levels& counts() const { return counts_; }
  bool possible(const Levels& levels) const { return possible_[index(levels)]; }

  CertifiedCase make(const Levels& levels) const {
    CertifiedCase test;
    test.method = variants_[levels[0]];
    test.free_paths = free_paths_;
    test.medium = levels[1];
    test.interpolation = static_cast<Interpolation>(levels[2]);
    test.tight = levels[3] == 0;
    test.one_lane = levels[4] == 1;
    test.absorption = levels[5] == 0 ? Absorption::kWeighted : Absorption::kAnalog;
    test.emission = levels[6] == 0 ? EmissionTally::kCollision : EmissionTally::kAnalog;
    test.history = levels[7] == 1;
    return test;
  }

  /// Calls f with every pair of values of a case.
  template <class Function>
  void for_each_pair(const Levels& levels, Function f) const {
    f(Pair{kMethod, method_of_[levels[0]], 1, levels[1]});
    f(Pair{0, levels[0], kKind, kind_of_[levels[1]]});
    for (int i = 0; i < kProperties; ++i) {
      for (int j = std::max(i + 1, i == 0 ? 2 : 0); j < kProperties; ++j) {
        f(Pair{i, levels[i], j, levels[j]});
      }
    }
  }

  /// Whether a case has one of the values of a pair.
  bool has(const Levels& levels, int property, int value) const {
    if (property == kMethod) return method_of_[levels[0]] == value;
    if (property == kKind) return kind_of_[levels[1]] == value;
    return levels[property] == value;
  }

  /// Calls f with every possible case.
  template <class Function>
  void for_each(Function f) const {
    Levels levels{};
    do {
      if (possible(levels)) f(levels);
    } while (advance(levels, kProperties));
  }

 private:
  /// The first properties, method, medium, interpolation and bounds, decide what is possible.
  static constexpr int kDecisive = 4;

  /// The next levels of the first `properties`; false after the last.
  bool advance(Levels& levels, int properties) const {
    int property = properties - 1;
    while (property >= 0 && ++levels[property] == counts_[property]) levels[property--] = 0;
    return property >= 0;
  }
  std::size_t index(const Levels& levels) const {
    std::size_t index = 0;
    for (int i = 0; i < kDecisive; ++i) index = index * counts_[i] + levels[i];
    return index;
  }

  bool free_paths_;
  std::vector<std::string> variants_;
  std::vector<std::string> method_names_;
  std::vector<int> method_of_;  // of variants
  std::vector<std::string> kinds_;
  std::vector<int> kind_of_;  // of media
  Levels counts_{};
  std::vector<bool> possible_;
};

}  // namespace

WalkSettings CertifiedCase::settings() const {
  WalkSettings settings;
  (free_paths ? settings.tracker : settings.transmittance) = method;
  // What an estimator carries depends on the tracker beside it; this one takes all channels.
  if (!free_paths) settings.tracker = "spectral";
  settings.interpolation = interpolation;
  settings.absorption = absorption;
  settings.emission = emission;
  settings.simd = one_lane ? Simd::kOneLane : Simd::kBest;
  settings.seed = 0xCBF29CE484222325U;  // FNV-1a
  for (const char letter : name()) {
    settings.seed = (settings.seed ^ static_cast<unsigned char>(letter)) * 0x100000001B3U;
  }
  return settings;
}

std::string CertifiedCase::modes() const {
  constexpr const char* kNames[] = {"nearest", "trilinear", "stochastic"};
  std::string modes = kNames[static_cast<int>(interpolation)];
  modes += tight ? ", tight" : ", loose";
  modes += one_lane ? ", one lane" : ", lanes";
  if (history) modes += ", history";
  if (!free_paths) return modes;
  modes += absorption == Absorption::kWeighted ? ", weighted absorption" : ", analog absorption";
  modes += emission == EmissionTally::kCollision ? ", collision emission" : ", analog emission";
  return modes;
}

std::string CertifiedCase::name() const {
  return method + " | " + certified_media()[medium].name + " | " + modes();
}

float history_weight(int channel) {
  constexpr float kWeights[] = {0.5F, 2, -1, 4, 0.25F, -2, 1, -0.5F};
  return kWeights[channel % std::size(kWeights)];
}

float history_density(int channel) {
  constexpr float kDensities[] = {1.5F, 0.5F, 1, 2, 0.25F, 1, 0.75F, 3};
  return kDensities[channel % std::size(kDensities)];
}

const char* kind_of(const CertifiedMedium& medium) {
  if (medium.channels.count != kChannels) return "wavelengths";
  if (medium.channels.components.size() > 1) return "overlapping";
  return medium.channels.has_grey_extinction() ? "grey" : "coloured";
}

std::vector<std::string> certified_variants(bool free_paths) {
  std::vector<std::string> variants;
  for (const MethodInfo& info : free_paths ? tracker_infos() : transmittance_infos()) {
    if (info.biased) continue;
    const std::string name(info.name);
    variants.push_back(name);
    std::string all;
    for (const MethodOption& option : info.options) {
      const std::vector<std::string> values = values_of(option);
      for (const std::string& value : values) {
        variants.push_back(fmt::format("{}:{}={}", name, option.name, value));
      }
      all += fmt::format("{}{}={}", all.empty() ? ":" : ",", option.name, values.back());
    }
    if (info.options.size() > 1) variants.push_back(name + all);
  }
  return variants;
}

std::optional<std::string> reason_against(const CertifiedCase& test) {
  try {
    const WalkSettings settings = test.settings();
    const MediumChannels& channels = certified_media()[test.medium].channels;
    const bool shared = shares_paths(channels, settings);
    const Walker walker(test.walked_medium(), shared ? channels : channels.only(0), settings);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

std::vector<CertifiedCase> all_cases(bool free_paths) {
  const CaseSpace space(free_paths);
  std::vector<CertifiedCase> cases;
  space.for_each([&](const Levels& levels) { cases.push_back(space.make(levels)); });
  return cases;
}

std::vector<CertifiedCase> pairwise_cases(bool free_paths) {
  constexpr int kCandidates = 40;
  const CaseSpace space(free_paths);
  std::set<Pair> open;
  space.for_each([&](const Levels& levels) {
    space.for_each_pair(levels, [&](const Pair& pair) { open.insert(pair); });
  });
  RandomStream random(1, 0, 0, 0);
  std::vector<CertifiedCase> cases;
  while (!open.empty()) {
    // Of some random cases that cover the first open pair, the one that covers most others.
    const Pair wanted = *open.begin();
    Levels best{};
    int most = 0;
    for (int candidate = 0; candidate < kCandidates || most == 0; ++candidate) {
      Levels levels{};
      for (int i = 0; i < kProperties; ++i) {
        levels[i] = static_cast<int>(random.bits() % static_cast<uint32_t>(space.counts()[i]));
      }
      for (const int i : {0, 2}) {
        if (wanted[i] < kProperties) levels[wanted[i]] = wanted[i + 1];
      }
      if (!space.has(levels, wanted[0], wanted[1]) || !space.has(levels, wanted[2], wanted[3]) ||
          !space.possible(levels)) {
        continue;
      }
      int covered = 0;
      space.for_each_pair(levels,
                          [&](const Pair& pair) { covered += open.count(pair) != 0 ? 1 : 0; });
      if (covered > most) {
        most = covered;
        best = levels;
      }
    }
    space.for_each_pair(best, [&](const Pair& pair) { open.erase(pair); });
    cases.push_back(space.make(best));
  }
  return cases;
}

}  // namespace freepath::testing
