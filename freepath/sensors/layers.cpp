#include "freepath/sensors/layers.h"

#include <iterator>
#include <sstream>

#include "freepath/base/error.h"
#include "freepath/base/nearest_name.h"

namespace freepath {
namespace {

constexpr std::array<LayerInfo, kLayers> kInfos{
    LayerInfo{Layer::kAlbedo, "albedo", "albedo.R albedo.G albedo.B"},
    LayerInfo{Layer::kDepth, "depth", "depth.Z"},
    LayerInfo{Layer::kLookups, "lookups", "lookups"},
    LayerInfo{Layer::kVariance, "variance", "variance.R variance.G variance.B"},
    LayerInfo{Layer::kSamples, "samples", "samples"},
    LayerInfo{Layer::kNormal, "normal", "normal.X normal.Y normal.Z"},
    LayerInfo{Layer::kPosition, "position", "position.X position.Y position.Z"},
    LayerInfo{Layer::kTransmittance, "transmittance",
              "transmittance.R transmittance.G transmittance.B"},
    LayerInfo{Layer::kEmission, "emission", "emission.R emission.G emission.B"},
    LayerInfo{Layer::kBackground, "background", "background.R background.G background.B"},
    LayerInfo{Layer::kDirect, "direct", "direct.R direct.G direct.B"},
    LayerInfo{Layer::kIndirect, "indirect", "indirect.R indirect.G indirect.B"},
    LayerInfo{Layer::kHalves, "halves", "A.R A.G A.B B.R B.G B.B"}};

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

std::vector<std::string> channels_of(LayerSet layers) {
  std::vector<std::string> channels;
  for (const LayerInfo& info : kInfos) {
    if (!layers.has(info.layer)) continue;
    std::istringstream names{std::string(info.channels)};
    channels.insert(channels.end(), std::istream_iterator<std::string>(names), {});
  }
  return channels;
}

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
