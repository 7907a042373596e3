#include "freepath/sensors/layers.h"

#include <algorithm>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/nearest_name.h"

namespace freepath {
namespace {

using Names = std::string_view;

constexpr Names kAlbedo[] = {"albedo.R", "albedo.G", "albedo.B"};
constexpr Names kDepth[] = {"depth.Z"};
constexpr Names kLookups[] = {"lookups"};
constexpr Names kVariance[] = {"variance.R", "variance.G", "variance.B"};
constexpr Names kSamples[] = {"samples"};
constexpr Names kNormal[] = {"normal.X", "normal.Y", "normal.Z"};
constexpr Names kPosition[] = {"position.X", "position.Y", "position.Z"};
constexpr Names kTransmittance[] = {"transmittance.R", "transmittance.G", "transmittance.B"};
constexpr Names kEmission[] = {"emission.R", "emission.G", "emission.B"};
constexpr Names kBackground[] = {"background.R", "background.G", "background.B"};
constexpr Names kDirect[] = {"direct.R", "direct.G", "direct.B"};
constexpr Names kIndirect[] = {"indirect.R", "indirect.G", "indirect.B"};
constexpr Names kHalves[] = {"A.R", "A.G", "A.B", "B.R", "B.G", "B.B"};

constexpr std::array<LayerInfo, kLayers> kInfos{
    LayerInfo{Layer::kAlbedo, "albedo", kAlbedo},
    LayerInfo{Layer::kDepth, "depth", kDepth},
    LayerInfo{Layer::kLookups, "lookups", kLookups},
    LayerInfo{Layer::kVariance, "variance", kVariance},
    LayerInfo{Layer::kSamples, "samples", kSamples},
    LayerInfo{Layer::kNormal, "normal", kNormal},
    LayerInfo{Layer::kPosition, "position", kPosition},
    LayerInfo{Layer::kTransmittance, "transmittance", kTransmittance},
    LayerInfo{Layer::kEmission, "emission", kEmission},
    LayerInfo{Layer::kBackground, "background", kBackground},
    LayerInfo{Layer::kDirect, "direct", kDirect},
    LayerInfo{Layer::kIndirect, "indirect", kIndirect},
    LayerInfo{Layer::kHalves, "halves", kHalves}};

LayerSet parse_one(std::string_view name) {
  if (name == "all") return LayerSet::all();
  if (name == "none") return {};
  if (name == "default") return LayerSet::standard();
  std::string known;
  std::vector<std::string_view> names;
  for (const LayerInfo& info : kInfos) {
    if (info.name == name) return {info.layer};
    known += known.empty() ? "" : ", ";
    known += info.name;
    names.push_back(info.name);
  }
  const std::string_view nearest = nearest_name(name, names);
  fail("there is no layer '{}'{}; known are {}, and all, none, default", name,
       nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest), known);
}

}  // namespace

const std::array<LayerInfo, kLayers>& layer_infos() { return kInfos; }

LayerSet parse_layers(std::string_view text) {
  LayerSet layers;
  while (true) {
    const std::size_t comma = text.find(',');
    layers = layers.with(parse_one(text.substr(0, comma)));
    if (comma == std::string_view::npos) return layers;
    text.remove_prefix(comma + 1);
  }
}

std::string to_string(LayerSet layers) {
  std::string text;
  for (const LayerInfo& info : kInfos) {
    if (!layers.has(info.layer)) continue;
    text += text.empty() ? "" : ",";
    text += info.name;
  }
  return text.empty() ? "none" : text;
}

}  // namespace freepath
