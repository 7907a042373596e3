#include "freepath/scene/assembly/build_textures.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "freepath/scene/assembly/build_inputs.h"
#include "freepath/scene/assembly/build_texture_mappings.h"
#include "freepath/scene/assembly/entity_kinds.h"

namespace freepath {
namespace {

/// Those of both kinds, and of one alone.
constexpr std::array<std::string_view, 8> kTextures = {
    "bilerp", "checkerboard", "constant", "directionmix", "dots", "imagemap", "mix", "scale"};
constexpr std::array<std::string_view, 3> kFloatTextures = {"fbm", "windy", "wrinkled"};
constexpr std::array<std::string_view, 1> kSpectrumTextures = {"marble"};
constexpr std::array<std::string_view, 1> kUnsupportedTextures = {"ptex"};

constexpr int kMostOctaves = 64;

/// Textures within textures are evaluated by recursion.
constexpr int kDeepestTexture = 64;

/// Which kind of texture a parameter of a texture takes.
PbrtTextureKind kind_of(const PbrtTexture& owner, std::string_view parameter) {
  return parameter == "scale" || parameter == "amount" ? PbrtTextureKind::kFloat : owner.kind;
}

template <class Names>
bool is_among(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// @throws Error if there is no texture of that type and kind
void check_type(const PbrtTexture& texture) {
  const bool is_float = texture.kind == PbrtTextureKind::kFloat;
  if (is_among(kTextures, texture.type)) return;
  const bool of_floats = is_among(kFloatTextures, texture.type);
  const bool of_spectra = is_among(kSpectrumTextures, texture.type);
  if (is_float ? of_floats : of_spectra) return;
  if (of_floats || of_spectra) {
    fail_at(texture.location, "the texture {} is always of kind {}", in_quotes(texture.type),
            of_floats ? "float" : "spectrum");
  }
  std::vector<std::string_view> known(kTextures.begin(), kTextures.end());
  known.insert(known.end(), kFloatTextures.begin(), kFloatTextures.end());
  known.insert(known.end(), kSpectrumTextures.begin(), kSpectrumTextures.end());
  std::ranges::sort(known);
  fail_unknown_type(texture, "texture", known, kUnsupportedTextures);
}

int octaves_of(const ParameterList& list) {
  const int octaves = list.get_integer("octaves", 8);
  if (octaves < 0 || octaves > kMostOctaves) {
    fail_at(list.location_of("octaves"), "parameter 'octaves' is {}; it must be from 0 to {}",
            octaves, kMostOctaves);
  }
  return octaves;
}

/// Builds textures after those that they are made of.
class TextureBuilder {
 public:
  explicit TextureBuilder(BuildContext& context);

  void build_all();

 private:
  /// A texture, and what its colours are; kReflectance for floats.
  struct Job {
    std::size_t texture;
    ColorMeaning meaning;

    bool operator<(const Job& other) const {
      return std::pair(texture, meaning) < std::pair(other.texture, other.meaning);
    }
  };

  void note_uses(const PbrtMaterial& material);
  int build(const Job& job, int depth);
  int build_parts(const Job& job, int depth);
  void add(const Job& job);
  template <class Texture, class Input, class Get>
  Texture compound(const PbrtTexture& texture, const Get& get);
  FloatTexture float_texture(const PbrtTexture& texture);
  SpectrumTexture spectrum_texture(const PbrtTexture& texture, ColorMeaning meaning);
  ImageMapTexture image_map(const PbrtTexture& described);
  std::shared_ptr<const TextureImage> image(const ParameterList& list);

  BuildContext& context_;
  std::map<std::string, std::size_t, std::less<>> floats_, spectra_;
  std::set<Job> used_, begun_;
  std::map<Job, int> heights_;  ///< Of what is done.
  /// By path and encoding.
  std::map<std::tuple<std::string, ImageEncoding::Kind, float>, std::shared_ptr<const TextureImage>>
      images_;
};

TextureBuilder::TextureBuilder(BuildContext& context) : context_(context) {
  for (std::size_t i = 0; i < context.pbrt.textures.size(); ++i) {
    const PbrtTexture& texture = context.pbrt.textures[i];
    (texture.kind == PbrtTextureKind::kFloat ? floats_ : spectra_).emplace(texture.name, i);
  }
  for (const PbrtMaterial& material : context.pbrt.materials) note_uses(material);
}

void TextureBuilder::note_uses(const PbrtMaterial& material) {
  for (const auto& parameter : material.parameters.all()) {
    if (parameter->type != ParameterType::kTexture) continue;
    const bool index = std::find(kMetalIndexParameters.begin(), kMetalIndexParameters.end(),
                                 parameter->name) != kMetalIndexParameters.end();
    for (const std::string& name : std::get<std::vector<std::string>>(parameter->values)) {
      const auto found = spectra_.find(name);
      if (found == spectra_.end()) continue;
      used_.insert({found->second, index ? ColorMeaning::kUnbounded : ColorMeaning::kReflectance});
    }
  }
}

void TextureBuilder::build_all() {
  for (const Job& job : used_) build(job, 0);
  for (std::size_t i = 0; i < context_.pbrt.textures.size(); ++i) {
    const bool has_use = heights_.contains({i, ColorMeaning::kUnbounded});
    if (!has_use) build({i, ColorMeaning::kReflectance}, 0);
    context_.pbrt.textures[i].parameters.report_unused(context_.diagnostics);
  }
}

/// @param depth textures that this one is being built for
/// @return how many textures deep it is, itself included
int TextureBuilder::build(const Job& job, int depth) {
  const auto found = heights_.find(job);
  if (found != heights_.end()) return found->second;
  const PbrtTexture& texture = context_.pbrt.textures[job.texture];
  if (!begun_.insert(job).second) {
    fail_at(texture.location, "texture {} is made of itself", in_quotes(texture.name));
  }
  const int height = depth < kDeepestTexture ? 1 + build_parts(job, depth) : kDeepestTexture + 1;
  if (height > kDeepestTexture) {
    fail_at(texture.location, "texture {} is part of a nest of more than {} textures",
            in_quotes(texture.name), kDeepestTexture);
  }
  add(job);
  heights_.emplace(job, height);
  return height;
}

/// @return the greatest height among them
int TextureBuilder::build_parts(const Job& job, int depth) {
  const PbrtTexture& texture = context_.pbrt.textures[job.texture];
  int highest = 0;
  for (const auto& parameter : texture.parameters.all()) {
    if (parameter->type != ParameterType::kTexture) continue;
    const bool floats = kind_of(texture, parameter->name) == PbrtTextureKind::kFloat;
    const auto& named = floats ? floats_ : spectra_;
    for (const std::string& name : std::get<std::vector<std::string>>(parameter->values)) {
      const auto found = named.find(name);
      if (found == named.end()) continue;  // an error once it is looked up
      const Job part{found->second, floats ? ColorMeaning::kReflectance : job.meaning};
      highest = std::max(highest, build(part, depth + 1));
    }
  }
  return highest;
}

void TextureBuilder::add(const Job& job) {
  const PbrtTexture& texture = context_.pbrt.textures[job.texture];
  check_type(texture);
  TextureTable& table = context_.scene.textures;
  if (texture.kind == PbrtTextureKind::kFloat) {
    context_.float_textures[texture.name] = table.add(float_texture(texture));
    return;
  }
  const SpectrumTextureId id = table.add(spectrum_texture(texture, job.meaning));
  const bool reflectance = job.meaning == ColorMeaning::kReflectance;
  (reflectance ? context_.reflectance_textures : context_.unbounded_textures)[texture.name] = id;
}

/// The types that are the same for floats and spectra.
/// @param get an input by its name and default
template <class Texture, class Input, class Get>
Texture TextureBuilder::compound(const PbrtTexture& texture, const Get& get) {
  const ParameterList& list = texture.parameters;
  if (texture.type == "imagemap") return image_map(texture);
  if (texture.type == "scale") {
    return ScaleTexture<Input>{get("tex", 1.0), float_input(context_, list, "scale", 1)};
  }
  if (texture.type == "mix") {
    return MixTexture<Input>{get("tex1", 0.0), get("tex2", 1.0),
                             float_input(context_, list, "amount", 0.5)};
  }
  if (texture.type == "directionmix") {
    return DirectionMixTexture<Input>{get("tex1", 0.0), get("tex2", 1.0),
                                      texture_direction(context_, texture, "dir", Vec3d(0, 1, 0))};
  }
  if (texture.type == "dots") {
    return DotsTexture<Input>{get("inside", 1.0), get("outside", 0.0),
                              texture_mapping(context_, texture)};
  }
  if (texture.type == "bilerp") {
    return BilerpTexture<Input>{get("v00", 0.0), get("v01", 1.0), get("v10", 0.0), get("v11", 1.0),
                                texture_mapping(context_, texture)};
  }
  CheckerboardTexture<Input> board{get("tex1", 1.0), get("tex2", 0.0)};
  const int dimension = list.get_integer("dimension", 2);
  if (dimension == 2) {
    board.mapping = texture_mapping(context_, texture);
  } else if (dimension == 3) {
    board.mapping = solid_mapping(context_, texture);
  } else {
    fail_at(list.location_of("dimension"), "there is no checkerboard of dimension {}; use 2 or 3",
            dimension);
  }
  return board;
}

FloatTexture TextureBuilder::float_texture(const PbrtTexture& texture) {
  const ParameterList& list = texture.parameters;
  if (texture.type == "constant") return static_cast<float>(list.get_float("value", 1));
  const auto roughness = [&] { return static_cast<float>(list.get_float("roughness", 0.5)); };
  if (texture.type == "fbm") {
    return FbmTexture{solid_mapping(context_, texture), octaves_of(list), roughness()};
  }
  if (texture.type == "wrinkled") {
    return WrinkledTexture{solid_mapping(context_, texture), octaves_of(list), roughness()};
  }
  if (texture.type == "windy") return WindyTexture{solid_mapping(context_, texture)};
  return compound<FloatTexture, FloatInput>(texture, [&](std::string_view name, double otherwise) {
    return float_input(context_, list, name, otherwise);
  });
}

SpectrumTexture TextureBuilder::spectrum_texture(const PbrtTexture& texture, ColorMeaning meaning) {
  const ParameterList& list = texture.parameters;
  if (texture.type == "constant") {
    const bool given = list.type_of("value").has_value();
    const SpectrumValue value = list.get_spectrum("value", {});
    return context_.scene.spectra->add(
        given ? distribution_of(context_, value, meaning, list, "value") : SpectralDistribution(1),
        SpectrumRole::kReflectance);
  }
  if (texture.type == "marble") {
    const auto number = [&](std::string_view name, double otherwise) {
      return static_cast<float>(list.get_float(name, otherwise));
    };
    return MarbleTexture{solid_mapping(context_, texture), octaves_of(list),
                         number("roughness", 0.5), number("scale", 1), number("variation", 0.2)};
  }
  return compound<SpectrumTexture, SpectrumInput>(
      texture, [&](std::string_view name, double otherwise) {
        return spectrum_input(context_, list, name, otherwise, meaning);
      });
}

ImageMapTexture TextureBuilder::image_map(const PbrtTexture& described) {
  const ParameterList& list = described.parameters;
  ImageMapTexture texture;
  texture.image = image(list);
  texture.mapping = texture_mapping(context_, described);
  texture.wrap = at_location(list.location_of("wrap"),
                             [&] { return image_wrap(list.get_string("wrap", "repeat")); });
  texture.scale = static_cast<float>(list.get_float("scale", 1));
  texture.invert = list.get_bool("invert", false);
  const std::string filter = list.get_string("filter", "bilinear");
  if (filter != "bilinear") {
    context_.diagnostics.warn(
        list.location_of("filter"),
        fmt::format("the filter {} is not supported; images are looked up bilinearly",
                    in_quotes(filter)));
  }
  list.type_of("maxanisotropy");  // of pbrt's filter "EWA" alone
  return texture;
}

std::shared_ptr<const TextureImage> TextureBuilder::image(const ParameterList& list) {
  const ImageEncoding encoding = at_location(list.location_of("encoding"), [&] {
    return image_encoding(list.get_string("encoding", "sRGB"));
  });
  const std::string path = file_of(context_, list, "filename").string();
  std::shared_ptr<const TextureImage>& found = images_[{path, encoding.kind, encoding.gamma}];
  if (!found) {
    const SourceLocation& location = list.location_of("filename");
    const Image image = read_scene_image(context_, path, location);
    found = at_location(location, [&] { return texture_image(image, path, encoding); });
  }
  return found;
}

}  // namespace

void build_textures(BuildContext& context) { TextureBuilder(context).build_all(); }

}  // namespace freepath
