#include "freepath/paths/picture_identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "freepath/io/content_digest.h"

namespace freepath {
namespace {

const std::string* find_fact(const PictureIdentity& identity, std::string_view name) {
  const auto found = std::find_if(identity.facts.begin(), identity.facts.end(),
                                  [&](const auto& fact) { return fact.first == name; });
  return found == identity.facts.end() ? nullptr : &found->second;
}

}  // namespace

std::string PictureIdentity::fact(std::string_view name) const {
  const std::string* const value = find_fact(*this, name);
  return value == nullptr ? std::string() : *value;
}

void PictureIdentity::add_methods(const RenderSettings& settings, std::string_view color) {
  facts.emplace_back("color", color);
  facts.emplace_back("tracker", settings.walk.tracker);
  facts.emplace_back("transmittance",
                     settings.walk.transmittance +
                         (settings.chooses_transmittance ? ", exact where media allow" : ""));
  facts.emplace_back("interpolation",
                     fmt::format("{}", static_cast<int>(settings.walk.interpolation)));
  facts.emplace_back("max-scatterings", std::to_string(settings.max_scatterings));
}

void PictureIdentity::add_contents(const std::vector<std::string>& files) {
  std::map<std::string, std::string> contents;
  for (const std::string& file : files) {
    ContentDigest digest;
    digest.add_file(file);
    const std::string name = "the content of " + std::filesystem::path(file).filename().string();
    std::string& entry = contents[name];
    entry += (entry.empty() ? "" : " ") + digest.hex();
  }
  facts.insert(facts.end(), contents.begin(), contents.end());
}

std::string difference(const PictureIdentity& first, const PictureIdentity& second, bool any_seed) {
  if (first.version != second.version) {
    return fmt::format("it is by freepath {} and not {}", second.version, first.version);
  }
  if (!any_seed && first.seed != second.seed) {
    return fmt::format("its seed is {} and not {}", second.seed, first.seed);
  }
  const auto value_in = [](const PictureIdentity& identity, const std::string& name) {
    const std::string* const value = find_fact(identity, name);
    return value == nullptr ? std::string("not given") : *value;
  };
  for (const PictureIdentity* one : {&first, &second}) {
    for (const auto& [name, value] : one->facts) {
      const std::string a = value_in(first, name);
      const std::string b = value_in(second, name);
      if (a != b) return fmt::format("{} is {} and not {}", name, b, a);
    }
  }
  return {};
}

}  // namespace freepath
