#pragma once
/// @file A scene as a pbrt file describes it: plain data, with nothing of it built.

#include <optional>
#include <string>
#include <vector>

#include "freepath/scene/pbrt/parameter_list.h"
#include "freepath/scene/pbrt/transform.h"

namespace freepath {

/// A statement that names an implementation: Film "rgb" "integer xresolution" 640.
struct PbrtEntity {
  std::string type;
  SourceLocation location;
  ParameterList parameters;
};

struct PbrtCamera : PbrtEntity {
  TransformPair camera_from_world;
  std::string medium;  ///< Medium that it is in; empty for vacuum.
};

struct PbrtMedium : PbrtEntity {
  std::string name;
  TransformPair world_from_medium;
};

struct PbrtMaterial : PbrtEntity {
  std::string name;  ///< Empty unless it was made by MakeNamedMaterial.
};

enum class PbrtTextureKind { kFloat, kSpectrum };

struct PbrtTexture : PbrtEntity {
  std::string name;  ///< Unique among those of its kind.
  PbrtTextureKind kind = PbrtTextureKind::kFloat;
  TransformPair world_from_texture;
};

struct PbrtLight : PbrtEntity {
  TransformPair world_from_light;
  std::string medium;  ///< Medium that it is in; empty for vacuum.
};

/// The emission of the shapes that refer to it.
using PbrtAreaLight = PbrtEntity;

struct PbrtShape : PbrtEntity {
  TransformPair world_from_object;
  bool reverse_orientation = false;
  int material = 0;               ///< Index into PbrtScene::materials.
  std::optional<int> area_light;  ///< Index into PbrtScene::area_lights.
  std::string inside_medium;      ///< Empty for vacuum.
  std::string outside_medium;
  std::optional<int> object;  ///< Index into PbrtScene::objects; such a shape is seen in instances.
};

/// Shapes between ObjectBegin and ObjectEnd.
struct PbrtObject {
  std::string name;
  SourceLocation location;
  std::vector<int> shapes;  ///< Indices into PbrtScene::shapes.
};

/// A copy of an object. A point of one of its shapes goes through the shape's world_from_object
/// first and then through this world_from_instance.
struct PbrtInstance {
  SourceLocation location;
  int object = 0;  ///< Index into PbrtScene::objects.
  TransformPair world_from_instance;
};

/// A scene, with all names in it known to refer to something.
struct PbrtScene {
  std::string file;  ///< The main file.
  ParameterList options;
  std::optional<PbrtCamera> camera;
  std::optional<PbrtEntity> film, sampler, filter, integrator, accelerator;
  ColorSpace color_space = ColorSpace::kSrgb;  ///< Colour space at WorldBegin, so that of the film.
  double start_time = 0;                       ///< Time of the starting transforms.
  double end_time = 1;                         ///< Time of the ending transforms.
  std::vector<PbrtMedium> media;
  /// The first is the "diffuse" of shapes that come before any Material.
  std::vector<PbrtMaterial> materials;
  std::vector<PbrtTexture> textures;
  std::vector<PbrtLight> lights;
  std::vector<PbrtAreaLight> area_lights;
  std::vector<PbrtShape> shapes;
  std::vector<PbrtObject> objects;
  std::vector<PbrtInstance> instances;
};

}  // namespace freepath
