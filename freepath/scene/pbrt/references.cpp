// References by name, checked when all is read, since what they name may come later.

#include <cstddef>
#include <vector>

#include "freepath/scene/pbrt/nearest_name.h"
#include "freepath/scene/pbrt/scene_parser.h"

namespace freepath {
namespace {

using Names = std::map<std::string, int, std::less<>>;

int resolve(const Names& names, const std::string& name, const SourceLocation& location,
            std::string_view what) {
  const auto found = names.find(name);
  if (found != names.end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& entry : names) known.emplace_back(entry.first);
  fail_at(location, "there is no {} {}{}", what, in_quotes(name), did_you_mean(name, known));
}

}  // namespace

void SceneParser::resolve_references() {
  for (const NameUse& reference : material_references_) {
    resolve(material_names_, reference.name, reference.location, "material");
  }
  for (const NameUse& reference : medium_references_) {
    resolve(medium_names_, reference.name, reference.location, "medium");
  }
  for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
    if (shape_materials_[i].empty()) continue;
    scene_.shapes[i].material =
        resolve(material_names_, shape_materials_[i], scene_.shapes[i].location, "material");
  }
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    PbrtInstance& instance = scene_.instances[i];
    instance.object = resolve(object_names_, instance_objects_[i], instance.location, "object");
  }
  const auto resolve_all = [this](const auto& entities) {
    for (const PbrtEntity& entity : entities) resolve_textures(entity.parameters.own());
  };
  resolve_all(scene_.materials);
  resolve_all(scene_.textures);
  resolve_all(scene_.media);
  resolve_all(scene_.lights);
  resolve_all(scene_.area_lights);
  resolve_all(scene_.shapes);
  resolve_textures(attribute_parameters_);
  refuse_texture_cycles();
}

void SceneParser::resolve_textures(const SharedParameters& parameters) const {
  for (const auto& parameter : parameters) {
    if (parameter->type != ParameterType::kTexture) continue;
    for (const std::string& name : std::get<std::vector<std::string>>(parameter->values)) {
      if (float_texture_names_.contains(name) || spectrum_texture_names_.contains(name)) continue;
      Names all = float_texture_names_;
      all.insert(spectrum_texture_names_.begin(), spectrum_texture_names_.end());
      resolve(all, name, parameter->location, "texture");
    }
  }
}

// Where textures of both kinds have a name, the implementation that asks decides which is meant.
std::optional<int> SceneParser::only_texture_of_name(const std::string& name) const {
  const auto as_float = float_texture_names_.find(name);
  const auto as_spectrum = spectrum_texture_names_.find(name);
  const bool is_float = as_float != float_texture_names_.end();
  if (is_float == (as_spectrum != spectrum_texture_names_.end())) return std::nullopt;
  return is_float ? as_float->second : as_spectrum->second;
}

void SceneParser::refuse_texture_cycles() const {
  // Edges from a texture to those it is made of, and how many are made of each one.
  std::vector<std::vector<std::size_t>> used(scene_.textures.size());
  std::vector<std::size_t> users(scene_.textures.size(), 0);
  for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
    for (const auto& parameter : scene_.textures[i].parameters.all()) {
      if (parameter->type != ParameterType::kTexture) continue;
      for (const std::string& name : std::get<std::vector<std::string>>(parameter->values)) {
        const std::optional<int> only = only_texture_of_name(name);
        if (!only) continue;
        used[i].push_back(static_cast<std::size_t>(*only));
        ++users[used[i].back()];
      }
    }
  }
  // Textures without users are taken away until none is left; those of a cycle stay.
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < users.size(); ++i) {
    if (users[i] == 0) free.push_back(i);
  }
  std::size_t taken = 0;
  for (; taken < free.size(); ++taken) {
    for (const std::size_t i : used[free[taken]]) {
      if (--users[i] == 0) free.push_back(i);
    }
  }
  if (taken == users.size()) return;
  std::size_t i = 0;
  while (users[i] == 0) ++i;
  fail_at(scene_.textures[i].location, "texture {} is made of itself",
          in_quotes(scene_.textures[i].name));
}

}  // namespace freepath
