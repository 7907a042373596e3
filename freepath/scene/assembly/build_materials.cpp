#include "freepath/scene/assembly/build_materials.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "freepath/scene/assembly/build_inputs.h"
#include "freepath/scene/assembly/entity_kinds.h"
#include "freepath/scene/pbrt/nearest_name.h"
#include "freepath/spectra/named_spectra.h"

namespace freepath {
namespace {

constexpr std::array<std::string_view, 3> kUnsupportedMaterials = {"hair", "measured",
                                                                   "subsurface"};

/// Mixes of mixes are looked through at each hit, and destroyed by recursion.
constexpr int kDeepestMix = 64;

/// Builds one material from its parameters.
class MaterialParameters {
 public:
  MaterialParameters(BuildContext& context, const ParameterList& list)
      : context_(context), list_(list) {}

  Material diffuse() const { return DiffuseMaterial{reflectance()}; }
  Material diffuse_transmission() const {
    const auto part = [&](std::string_view name) {
      return spectrum_input(context_, list_, name, 0.25, ColorMeaning::kReflectance);
    };
    return DiffuseTransmissionMaterial{part("reflectance"), part("transmittance"),
                                       not_negative("scale", 1)};
  }
  Material conductor() const {
    return ConductorMaterial{metal_index("eta", "k"), roughness("", remap())};
  }
  Material dielectric() const {
    return DielectricMaterial{index_input(context_, list_, "eta", 1.5), roughness("", remap())};
  }
  Material thin_dielectric() const {
    return ThinDielectricMaterial{index_input(context_, list_, "eta", 1.5)};
  }
  Material coated_diffuse() const { return CoatedDiffuseMaterial{coating(""), reflectance()}; }
  Material coated_conductor() const {
    return CoatedConductorMaterial{coating("interface."),
                                   metal_index("conductor.eta", "conductor.k"),
                                   roughness("conductor.", remap())};
  }

  /// Parameters of pbrt that change nothing here.
  void warn_of_unsupported() const;

 private:
  SpectrumInput reflectance() const {
    return spectrum_input(context_, list_, "reflectance", 0.5, ColorMeaning::kReflectance);
  }
  bool remap() const { return list_.get_bool("remaproughness", true); }
  Roughness roughness(const std::string& prefix, bool remap) const;
  ConductorIndex metal_index(std::string_view eta, std::string_view k) const;
  Coating coating(const std::string& prefix) const;
  int positive(std::string_view name, int otherwise) const;
  float not_negative(std::string_view name, double otherwise) const;

  BuildContext& context_;
  const ParameterList& list_;
};

/// Null: what is built otherwise.
constexpr EntityKind<Material (MaterialParameters::*)() const> kMaterials[] = {
    {"coatedconductor", &MaterialParameters::coated_conductor},
    {"coateddiffuse", &MaterialParameters::coated_diffuse},
    {"conductor", &MaterialParameters::conductor},
    {"dielectric", &MaterialParameters::dielectric},
    {"diffuse", &MaterialParameters::diffuse},
    {"diffusetransmission", &MaterialParameters::diffuse_transmission},
    {"interface", nullptr},
    {"mix", nullptr},
    {"thindielectric", &MaterialParameters::thin_dielectric}};

void MaterialParameters::warn_of_unsupported() const {
  for (const std::string_view name : {"displacement", "normalmap"}) {
    if (!list_.type_of(name)) continue;
    context_.diagnostics.warn(
        list_.location_of(name),
        fmt::format("materials' parameter {} is not supported; surfaces stay smooth",
                    in_quotes(name)));
  }
}

/// Along u and v; where one is not given it is the one for both.
Roughness MaterialParameters::roughness(const std::string& prefix, bool remap) const {
  const FloatInput both = float_input(context_, list_, prefix + "roughness", 0, kNotNegative);
  const auto along = [&](const std::string& name) {
    if (!list_.type_of(name)) return both;
    return float_input(context_, list_, name, 0, kNotNegative);
  };
  return {along(prefix + "uroughness"), along(prefix + "vroughness"), remap};
}

ConductorIndex MaterialParameters::metal_index(std::string_view eta, std::string_view k) const {
  const bool has_eta = list_.type_of(eta).has_value();
  const bool has_k = list_.type_of(k).has_value();
  if (!list_.type_of("reflectance")) {
    const auto input = [&](std::string_view name, std::string_view copper) {
      return spectrum_input(context_, list_, name, named_spectrum(copper),
                            ColorMeaning::kUnbounded);
    };
    return ComplexIndex{input(eta, "metal-Cu-eta"), input(k, "metal-Cu-k")};
  }
  if (has_eta || has_k) {
    const std::string_view given = has_eta ? eta : k;
    fail_at(list_.location_of(given), "parameters {} and 'reflectance' exclude each other",
            in_quotes(given));
  }
  return NormalReflectance{reflectance()};
}

Coating MaterialParameters::coating(const std::string& prefix) const {
  Coating coating;
  coating.eta = index_input(context_, list_, prefix + "eta", 1.5);
  coating.roughness = roughness(prefix, remap());
  coating.thickness = float_input(context_, list_, "thickness", 0.01, kNotNegative);
  coating.albedo = spectrum_input(context_, list_, "albedo", 0.0, ColorMeaning::kReflectance);
  coating.g = float_input(context_, list_, "g", 0, {-1, 1});
  coating.max_depth = positive("maxdepth", 10);
  coating.samples = positive("nsamples", 1);
  return coating;
}

int MaterialParameters::positive(std::string_view name, int otherwise) const {
  const int value = list_.get_integer(name, otherwise);
  if (value < 1) {
    fail_at(list_.location_of(name), "parameter {} is {}; it must be at least 1", in_quotes(name),
            value);
  }
  return value;
}

float MaterialParameters::not_negative(std::string_view name, double otherwise) const {
  const double value = list_.get_float(name, otherwise);
  if (value < 0) {
    fail_at(list_.location_of(name), "parameter {} is {}; it must be at least 0", in_quotes(name),
            value);
  }
  return static_cast<float>(value);
}

/// Builds materials, those that a mix names before it.
class MaterialBuilder {
 public:
  explicit MaterialBuilder(BuildContext& context);

  void build_all();

 private:
  struct Built {
    std::shared_ptr<const Material> material;  ///< Null for an interface.
    int height = 0;                            ///< Mixes within each other, itself included.
  };

  const Built& built(std::size_t index, int depth);
  Built build(const PbrtMaterial& material, int depth);
  Built mix(const PbrtMaterial& material, int depth);
  const Built& part_of_mix(const ParameterList& list, const std::string& name, int depth);

  BuildContext& context_;
  std::map<std::string, std::size_t, std::less<>> names_;
  std::vector<std::optional<Built>> built_;
  std::vector<bool> begun_;
};

MaterialBuilder::MaterialBuilder(BuildContext& context)
    : context_(context), built_(context.pbrt.materials.size()), begun_(built_.size()) {
  for (std::size_t i = 0; i < built_.size(); ++i) {
    const std::string& name = context.pbrt.materials[i].name;
    if (!name.empty()) names_.emplace(name, i);
  }
}

void MaterialBuilder::build_all() {
  context_.materials.assign(built_.size(), std::nullopt);
  for (std::size_t i = 0; i < built_.size(); ++i) {
    const std::shared_ptr<const Material> material = built(i, 0).material;
    if (!material) continue;
    context_.materials[i] = static_cast<uint32_t>(context_.scene.materials.size());
    context_.scene.materials.push_back(*material);
  }
}

/// @param depth mixes that this one is being built for
const MaterialBuilder::Built& MaterialBuilder::built(std::size_t index, int depth) {
  if (built_[index]) return *built_[index];
  const PbrtMaterial& material = context_.pbrt.materials[index];
  if (begun_[index]) {
    fail_at(material.location, "material {} is a mix of itself", in_quotes(material.name));
  }
  begun_[index] = true;
  built_[index] = build(material, depth);
  material.parameters.report_unused(context_.diagnostics);
  return *built_[index];
}

MaterialBuilder::Built MaterialBuilder::build(const PbrtMaterial& material, int depth) {
  const std::string& type = material.type;
  const MaterialParameters parameters(context_, material.parameters);
  if (type.empty() || type == "none" || type == "interface") return {};
  const auto make = maker_of(material, "material", kMaterials, kUnsupportedMaterials);
  if (make == nullptr) return mix(material, depth);
  parameters.warn_of_unsupported();
  return {std::make_shared<const Material>((parameters.*make)())};
}

MaterialBuilder::Built MaterialBuilder::mix(const PbrtMaterial& material, int depth) {
  const ParameterList& list = material.parameters;
  const std::span<const std::string> names = list.get_strings("materials");
  if (names.size() != 2) {
    fail_at(list.location_of("materials"),
            "a mix needs the names of two materials in a parameter \"string materials\", has {}",
            names.size());
  }
  int height = kDeepestMix + 1;
  MixMaterial made;
  if (depth < kDeepestMix) {
    const Built& first = part_of_mix(list, names[0], depth + 1);
    const Built& second = part_of_mix(list, names[1], depth + 1);
    height = 1 + std::max(first.height, second.height);
    made = {first.material, second.material, float_input(context_, list, "amount", 0.5)};
  }
  if (height > kDeepestMix) {
    fail_at(material.location, "this mix is part of a nest of more than {} mixes", kDeepestMix);
  }
  if (!made.first && !made.second) return {nullptr, height};
  return {std::make_shared<const Material>(std::move(made)), height};
}

const MaterialBuilder::Built& MaterialBuilder::part_of_mix(const ParameterList& list,
                                                           const std::string& name, int depth) {
  const SourceLocation& location = list.location_of("materials");
  const auto found = names_.find(name);
  if (found == names_.end()) {
    std::vector<std::string_view> known;
    for (const auto& entry : names_) known.emplace_back(entry.first);
    fail_at(location, "there is no material {}{}", in_quotes(name), did_you_mean(name, known));
  }
  return built(found->second, depth);
}

}  // namespace

void build_materials(BuildContext& context) { MaterialBuilder(context).build_all(); }

}  // namespace freepath
