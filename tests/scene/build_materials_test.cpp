// Materials built from text: what they reflect, what their parameters become, and what is said of
// those that are wrong.

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "freepath/scene/assembly/build_materials.h"
#include "freepath/scene/assembly/build_textures.h"
#include "freepath/spectra/named_spectra.h"
#include "tests/scene/built_scenes.h"
#include "tests/scene/expect_near.h"

namespace freepath::testing {
namespace {

/// A scene with materials after the standard one, from the second line on.
std::string with_materials(const std::string& text) { return "WorldBegin\n" + text; }

/// What a message of the only material says, which stands in the second line.
std::string material_error(const std::string& parameters) {
  return build_error(with_materials("Material " + parameters));
}

/// The only material after the standard one.
template <class Kind>
Kind only_material(const std::string& parameters) {
  const ParsedScene built(with_materials("Material " + parameters));
  return std::get<Kind>(built.scene().materials.at(1).kind());
}

TEST(BuildMaterials, HasOneMaterialForEachThatIsNoInterface) {
  const ParsedScene built(with_materials(R"(
      Material "interface"
      Material "diffuse" "rgb reflectance" [ .1 .2 .3 ]
      Material ""
      Material "none"
      Material "diffuse" "rgb reflectance" [ .4 .5 .6 ])"));
  ASSERT_EQ(built.scene().materials.size(), 3U);
  const std::vector<std::optional<uint32_t>> expected = {
      0, std::nullopt, 1, std::nullopt, std::nullopt, 2};
  EXPECT_EQ(built.materials(), expected);
  expect_near(built.albedo(0), Vec3f(0.5F));
  expect_near(built.albedo(1), {0.1F, 0.2F, 0.3F}, 3e-4F);
  expect_near(built.albedo(2), {0.4F, 0.5F, 0.6F}, 3e-4F);
}

TEST(BuildMaterials, DiffuseTakesAnySpectrumAndReflectsHalfByDefault) {
  const ParsedScene built(with_materials(R"(
      Material "diffuse"
      Material "diffuse" "spectrum reflectance" [ 300 .25 900 .25 ]
      Material "diffuse" "blackbody reflectance" 5000)"));
  expect_near(built.albedo(1), Vec3f(0.5F));
  expect_near(built.albedo(2), Vec3f(0.25F));
  // Warmer than white: red above blue.
  EXPECT_GT(built.albedo(3).x, built.albedo(3).z);
  EXPECT_TRUE(built.warnings().empty());
}

TEST(BuildMaterials, ColoursAboveOneAreClippedWithAWarning) {
  const ParsedScene built(with_materials(R"(Material "diffuse" "rgb reflectance" [ .5 2 1 ])"));
  ASSERT_EQ(built.warnings().size(), 1U);
  EXPECT_EQ(built.warnings()[0],
            "scene.pbrt:2:20: 'reflectance' has values above 1, which are clipped to 1");
}

TEST(BuildMaterials, ConductorsAreSmoothCopperByDefault) {
  const ParsedScene built(with_materials(R"(
      Material "conductor"
      Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k")"));
  EXPECT_TRUE(built.scene().materials[1].is_specular());
  // Copper is red: 0.95 0.64 0.54 in the tables of reflectances at normal incidence.
  expect_near(built.albedo(1), {0.95F, 0.64F, 0.54F}, 0.03F);
  expect_near(built.albedo(1), built.albedo(2), 1e-6F);
}

TEST(BuildMaterials, ConductorsTakeAReflectanceInPlaceOfAnIndex) {
  const ParsedScene built(
      with_materials(R"(Material "conductor" "rgb reflectance" [ .8 .6 .4 ] "float roughness" 0)"));
  expect_near(built.albedo(1), {0.8F, 0.6F, 0.4F}, 1e-3F);
  EXPECT_EQ(material_error(R"("conductor" "rgb reflectance" [ 1 1 1 ] "rgb k" [ 3 3 3 ])"),
            "scene.pbrt:2:50: parameters 'k' and 'reflectance' exclude each other");
  EXPECT_EQ(
      material_error(
          R"("coatedconductor" "rgb reflectance" [ 1 1 1 ] "spectrum conductor.eta" "metal-Au-eta")"),
      "scene.pbrt:2:56: parameters 'conductor.eta' and 'reflectance' exclude each other");
}

TEST(BuildMaterials, RoughnessesAlongUAndVReplaceTheOneForBoth) {
  const auto both = only_material<ConductorMaterial>(R"("conductor" "float roughness" .25)");
  EXPECT_EQ(both.roughness.u, FloatInput(0.25F));
  EXPECT_EQ(both.roughness.v, FloatInput(0.25F));
  EXPECT_TRUE(both.roughness.remap);
  const auto apart = only_material<DielectricMaterial>(
      R"("dielectric" "float roughness" .25 "float vroughness" .5 "bool remaproughness" false)");
  EXPECT_EQ(apart.roughness.u, FloatInput(0.25F));
  EXPECT_EQ(apart.roughness.v, FloatInput(0.5F));
  EXPECT_FALSE(apart.roughness.remap);
}

TEST(BuildMaterials, DielectricsTakeANumberOrASpectrumAsIndex) {
  const ParsedScene built(with_materials(R"(
      Material "dielectric"
      Material "dielectric" "float eta" 1.33
      Material "dielectric" "spectrum eta" "glass-BK7"
      Material "thindielectric"
      Material "thindielectric" "float eta" 2)"));
  EXPECT_FLOAT_EQ(built.index_of<DielectricMaterial>(1), 1.5F);
  EXPECT_FLOAT_EQ(built.index_of<DielectricMaterial>(2), 1.33F);
  // The sodium line, as in the catalogues of glasses.
  EXPECT_NEAR(built.index_of<DielectricMaterial>(3), 1.5167F, 2e-4F);
  EXPECT_FLOAT_EQ(built.index_of<ThinDielectricMaterial>(4), 1.5F);
  EXPECT_FLOAT_EQ(built.index_of<ThinDielectricMaterial>(5), 2);
  for (std::size_t i = 1; i <= 5; ++i) EXPECT_TRUE(built.scene().materials[i].transmits());
}

TEST(BuildMaterials, CoatedMaterialsHaveTheDefaultsOfPbrt) {
  const ParsedScene built(with_materials(R"(Material "coateddiffuse" Material "coatedconductor")"));
  const auto& diffuse = std::get<CoatedDiffuseMaterial>(built.scene().materials[1].kind());
  const auto& conductor = std::get<CoatedConductorMaterial>(built.scene().materials[2].kind());
  for (const Coating* coating : {&diffuse.coating, &conductor.coating}) {
    EXPECT_FLOAT_EQ(built.values()[coating->eta][0], 1.5F);
    EXPECT_EQ(coating->roughness.u, FloatInput(0.0F));
    EXPECT_EQ(coating->thickness, FloatInput(0.01F));
    EXPECT_EQ(built.values()[std::get<SpectrumId>(coating->albedo)][0], 0);
    EXPECT_EQ(coating->g, FloatInput(0.0F));
    EXPECT_EQ(coating->max_depth, 10);
    EXPECT_EQ(coating->samples, 1);
  }
  EXPECT_EQ(built.values()[std::get<SpectrumId>(diffuse.reflectance)][1], 0.5F);
  EXPECT_EQ(conductor.roughness.u, FloatInput(0.0F));
  EXPECT_TRUE(std::holds_alternative<ComplexIndex>(conductor.index));
}

TEST(BuildMaterials, CoatedMaterialsTakeAllParameters) {
  const auto diffuse = only_material<CoatedDiffuseMaterial>(R"("coateddiffuse"
      "rgb reflectance" [ .1 .2 .3 ] "float uroughness" .1 "float vroughness" .2 "float eta" 1.3
      "float thickness" 2 "rgb albedo" [ .5 .5 .5 ] "float g" -.5 "integer maxdepth" 50
      "integer nsamples" 4 "bool remaproughness" false)");
  EXPECT_EQ(diffuse.coating.roughness.u, FloatInput(0.1F));
  EXPECT_EQ(diffuse.coating.roughness.v, FloatInput(0.2F));
  EXPECT_FALSE(diffuse.coating.roughness.remap);
  EXPECT_EQ(diffuse.coating.thickness, FloatInput(2.0F));
  EXPECT_EQ(diffuse.coating.g, FloatInput(-0.5F));
  EXPECT_EQ(diffuse.coating.max_depth, 50);
  EXPECT_EQ(diffuse.coating.samples, 4);
  const auto conductor = only_material<CoatedConductorMaterial>(R"("coatedconductor"
      "float interface.roughness" .1 "float interface.eta" 1.2 "rgb conductor.eta" [ 1 2 3 ]
      "rgb conductor.k" [ 3 2 1 ] "float conductor.uroughness" .3)");
  EXPECT_EQ(conductor.coating.roughness.v, FloatInput(0.1F));
  EXPECT_EQ(conductor.roughness.u, FloatInput(0.3F));
  EXPECT_EQ(conductor.roughness.v, FloatInput(0.0F));
  const auto mirror =
      only_material<CoatedConductorMaterial>(R"("coatedconductor" "rgb reflectance" [ .9 .9 .9 ])");
  EXPECT_TRUE(std::holds_alternative<NormalReflectance>(mirror.index));
}

TEST(BuildMaterials, MixesNameMaterialsBeforeAndAfterThem) {
  const ParsedScene built(with_materials(R"(
      MakeNamedMaterial "black" "string type" "diffuse" "rgb reflectance" [ 0 0 0 ]
      MakeNamedMaterial "blend" "string type" "mix" "string materials" [ "black" "white" ]
        "float amount" 1
      MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 1 1 1 ]
      MakeNamedMaterial "more" "string type" "mix" "string materials" [ "blend" "black" ]
        "float amount" 0
      MakeNamedMaterial "even" "string type" "mix" "string materials" [ "white" "black" ])"));
  ASSERT_EQ(built.scene().materials.size(), 6U);
  expect_near(built.albedo(2), Vec3f(1));
  expect_near(built.albedo(4), Vec3f(1));
  EXPECT_EQ(std::get<MixMaterial>(built.scene().materials[5].kind()).amount, FloatInput(0.5F));
}

TEST(BuildMaterials, MixesTakeInterfaces) {
  const ParsedScene built(with_materials(R"(
      MakeNamedMaterial "air" "string type" "interface"
      MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 1 1 1 ]
      MakeNamedMaterial "sieve" "string type" "mix" "string materials" [ "white" "air" ]
        "float amount" .25
      MakeNamedMaterial "nothing" "string type" "mix" "string materials" [ "air" "air" ])"));
  // The standard material is the first.
  ASSERT_EQ(built.materials().size(), 5U);
  EXPECT_FALSE(built.materials()[1]);
  EXPECT_FALSE(built.materials()[4]);
  ASSERT_TRUE(built.materials()[3]);
  EXPECT_TRUE(built.scene().materials[*built.materials()[3]].has_holes());
  EXPECT_TRUE(built.warnings().empty());
}

TEST(BuildMaterials, PaperHasTheDefaultsOfPbrt) {
  const ParsedScene built(with_materials(R"(
      Material "diffusetransmission"
      Material "diffusetransmission" "rgb reflectance" [ .5 .25 .125 ]
        "rgb transmittance" [ .25 .5 .125 ] "float scale" .5
      Texture "leaf" "spectrum" "constant" "rgb value" [ .2 .4 .1 ]
      Material "diffusetransmission" "texture transmittance" "leaf")"));
  expect_near(built.albedo(1), Vec3f(0.5F));
  expect_near(built.albedo(2), Vec3f(0.375F, 0.375F, 0.125F), 1e-4F);
  expect_near(built.albedo(3), Vec3f(0.45F, 0.65F, 0.35F), 5e-4F);
  EXPECT_TRUE(built.warnings().empty());
  EXPECT_EQ(material_error(R"("diffusetransmission" "float scale" -1)"),
            "scene.pbrt:2:32: parameter 'scale' is -1; it must be at least 0");
}

TEST(BuildMaterials, RefusesMixesThatCannotBe) {
  EXPECT_EQ(build_error(with_materials(R"(
MakeNamedMaterial "a" "string type" "mix" "string materials" [ "b" "b" ]
MakeNamedMaterial "b" "string type" "mix" "string materials" [ "c" "a" ]
MakeNamedMaterial "c" "string type" "diffuse")")),
            "scene.pbrt:3:1: material 'a' is a mix of itself");
  EXPECT_EQ(build_error(with_materials(R"(
MakeNamedMaterial "paint" "string type" "diffuse"
Material "mix" "string materials" [ "paint" "pain" ])")),
            "scene.pbrt:4:16: there is no material 'pain'; did you mean 'paint'?");
  EXPECT_EQ(build_error(with_materials(R"(
MakeNamedMaterial "air" "string type" "interface"
Material "mix" "string materials" [ "air" "paper" ])")),
            "scene.pbrt:4:16: there is no material 'paper'");
  EXPECT_EQ(material_error(R"("mix" "string materials" [ "a" ])"),
            "scene.pbrt:2:16: a mix needs the names of two materials in a parameter \"string "
            "materials\", has 1");
}

TEST(BuildMaterials, RefusesMixesThatAreNestedTooDeep) {
  const std::string first = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
  const auto of_the_last = [](int i) {
    return fmt::format(
        "MakeNamedMaterial \"m{}\" \"string type\" \"mix\" \"string materials\" [ \"m{}\" \"m0\" "
        "]\n",
        i, i - 1);
  };
  std::string up = first, down = first;
  for (int i = 1; i <= 64; ++i) {
    up += of_the_last(i);
    down.insert(0, of_the_last(i));
  }
  EXPECT_EQ(build_error(with_materials(up)), "");
  EXPECT_EQ(build_error(with_materials(down)), "");
  EXPECT_EQ(build_error(with_materials(up + of_the_last(65))),
            "scene.pbrt:67:1: this mix is part of a nest of more than 64 mixes");
  EXPECT_EQ(build_error(with_materials(of_the_last(65) + down)),
            "scene.pbrt:66:1: this mix is part of a nest of more than 64 mixes");
}

TEST(BuildMaterials, UnknownMaterialsAreErrorsWithTheNearestName) {
  EXPECT_EQ(material_error(R"("difuse")"),
            "scene.pbrt:2:1: there is no material of type 'difuse'; did you mean 'diffuse'?");
  EXPECT_EQ(material_error(R"("hair")"),
            "scene.pbrt:2:1: the material 'hair' is not supported; there are: coatedconductor, "
            "coateddiffuse, conductor, dielectric, diffuse, diffusetransmission, interface, mix, "
            "thindielectric");
  for (const std::string type : {"measured", "subsurface"}) {
    EXPECT_NE(material_error("\"" + type + "\"").find("'" + type + "' is not supported"),
              std::string::npos);
  }
}

TEST(BuildMaterials, WrongTypesAndValuesAreErrorsWithTheirPlace) {
  EXPECT_EQ(material_error(R"("diffuse" "float reflectance" .5)"),
            "scene.pbrt:2:20: parameter 'reflectance' must be of type rgb, spectrum, blackbody or "
            "texture, not float");
  EXPECT_EQ(material_error(R"("diffuse" "rgb reflectance" [ 0 -1 0 ])"),
            "scene.pbrt:2:20: 'reflectance' is (0, -1, 0): a colour has to be finite and not "
            "negative");
  EXPECT_EQ(material_error(R"("conductor" "integer roughness" 1)"),
            "scene.pbrt:2:22: parameter 'roughness' must be of type float or texture, not integer");
  EXPECT_EQ(material_error(R"("conductor" "float uroughness" -1)"),
            "scene.pbrt:2:22: parameter 'uroughness' is -1; it must be at least 0");
  EXPECT_EQ(material_error(R"("conductor" "float roughness" [ 1 2 ])"),
            "scene.pbrt:2:22: parameter 'roughness' must be one float, has 2 values");
  EXPECT_EQ(material_error(R"("dielectric" "float eta" 0)"),
            "scene.pbrt:2:23: parameter 'eta' is 0; a refractive index must be above 0");
  EXPECT_EQ(material_error(R"("dielectric" "string eta" "glass")"),
            "scene.pbrt:2:23: parameter 'eta' must be of type float, rgb, spectrum or blackbody, "
            "not string");
  EXPECT_EQ(material_error(R"("coateddiffuse" "float g" 1.5)"),
            "scene.pbrt:2:26: parameter 'g' is 1.5; it must be at most 1");
  EXPECT_EQ(material_error(R"("coateddiffuse" "integer maxdepth" 0)"),
            "scene.pbrt:2:26: parameter 'maxdepth' is 0; it must be at least 1");
}

TEST(BuildMaterials, NamesParametersThatDoNothing) {
  const ParsedScene built(with_materials(R"(
Texture "bumps" "float" "constant"
Material "diffuse" "rgb reflectanse" [ 0 0 0 ]
Material "diffuse" "texture displacement" "bumps" "string normalmap" "n.png"
Material "conductor" "texture displacement" "bumps")"));
  ASSERT_EQ(built.warnings().size(), 3U);
  EXPECT_EQ(built.warnings()[0],
            "scene.pbrt:4:20: Material 'diffuse' has no parameter 'reflectanse'; did you mean "
            "'reflectance'?");
  EXPECT_EQ(built.warnings()[1],
            "scene.pbrt:5:20: materials' parameter 'displacement' is not supported; surfaces stay "
            "smooth (and 1 more like this)");
  EXPECT_EQ(built.warnings()[2],
            "scene.pbrt:5:51: materials' parameter 'normalmap' is not supported; surfaces stay "
            "smooth");
}

TEST(BuildMaterials, ParametersOfAttributesAreThoseOfMaterials) {
  const ParsedScene built(with_materials(
      R"(Attribute "material" "rgb reflectance" [ .25 .25 .25 ] "float roughness" 1
         Material "diffuse")"));
  expect_near(built.albedo(1), Vec3f(0.25F));
  EXPECT_TRUE(built.warnings().empty());
}

}  // namespace
}  // namespace freepath::testing
