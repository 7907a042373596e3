// What is said of broken scenes: one sentence, at the place where the trouble is.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {
namespace {

struct Broken {
  const char* text;
  const char* location;  ///< file:line:column
  const char* message;   ///< A piece of it.
};

const std::map<std::string, std::string>& files_beside() {
  static const std::map<std::string, std::string> kFiles = {
      {"self.pbrt", "\nInclude \"self.pbrt\""},
      {"ping.pbrt", R"(Include "pong.pbrt")"},
      {"pong.pbrt", R"(  Include "ping.pbrt")"},
      {"main.pbrt", R"(Include "scene.pbrt")"},
      {"open.pbrt", "\n AttributeBegin"},
      {"close.pbrt", " AttributeEnd"},
      {"typo.pbrt", "Shape \"sphere\"\nShpae"},
      {"binary.pbrt", std::string("Shape \n\x01\x02", 9)},
      {"cut.gz", std::string("\x1f\x8b\x08\x00\x00", 5)},
      {"odd.spd", "400 1 500"},
      {"words.spd", "400 one"},
      {"empty.spd", "# nothing"},
      {"falling.spd", "500 1 400 2"},
  };
  return kFiles;
}

void expect_error(const Broken& broken) {
  SCOPED_TRACE(broken.text);
  const std::string message = error_of(broken.text, files_beside());
  const std::string start = std::string(broken.location) + ": ";
  EXPECT_EQ(message.rfind(start, 0), 0U) << message << " does not begin with " << start;
  EXPECT_NE(message.find(broken.message), std::string::npos) << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
  EXPECT_LT(message.size(), 300U) << message;
}

void expect_errors(const std::vector<Broken>& table) {
  for (const Broken& broken : table) expect_error(broken);
}

TEST(BrokenScenes, Tokens) {
  expect_errors({
      {R"(Film "rgb)", "scene.pbrt:1:6", "not closed"},
      {"Film \"rgb\n\"", "scene.pbrt:1:6", "not closed"},
      {"WorldBegin\n  Shape \"sphere\" \"float radius", "scene.pbrt:2:18", "not closed"},
      {R"(Film "a\q")", "scene.pbrt:1:8", R"(unknown escape '\q')"},
      {"Scale nan 1 1", "scene.pbrt:1:7", "'nan' is not a finite number"},
      {"Scale 1 -inf 1", "scene.pbrt:1:9", "'-inf' is not a finite number"},
      {"Scale 1 1 1e999", "scene.pbrt:1:11", "'1e999' is out of range"},
      {"Scale 1 1 1e39", "scene.pbrt:1:11", "'1e39' is out of range"},
      {"Scale 1 2x 1", "scene.pbrt:1:9", "'2x' is not a number"},
      {"Scale 1 0x10 1", "scene.pbrt:1:9", "'0x10' is not a number"},
      {"\n\n  {", "scene.pbrt:3:3", "found '{'"},
      {"\xc3\xa9t\xc3\xa9", "scene.pbrt:1:1", R"(found '\xc3\xa9t\xc3\xa9')"},
      {"Film \"rgb\"\n[", "scene.pbrt:2:1", "expected a directive, found '['"},
      {R"("Film")", "scene.pbrt:1:1", "expected a directive, found string 'Film'"},
      {"WorldBegin\n\n 12", "scene.pbrt:3:2", "expected a directive, found number '12'"},
      {"WorldBegin \x7f", "scene.pbrt:1:12", "byte 0x7f is no text"},
  });
}

TEST(BrokenScenes, BinaryFiles) {
  const std::string nul = std::string("WorldBegin\n\0\0\0", 14);
  EXPECT_EQ(error_of(nul), "scene.pbrt:2:1: byte 0x00 is no text; is this a pbrt scene file?");
  std::string noise = "\x76\x2f\x31\x01";  // How an OpenEXR file begins.
  for (int i = 0; i < 1000; ++i) noise += static_cast<char>(i * 7919 % 251);
  EXPECT_EQ(error_of(noise), "scene.pbrt:1:4: byte 0x01 is no text; is this a pbrt scene file?");
  EXPECT_EQ(error_of(std::string("\x1f\x8b\x08\x00\x00", 5)),
            "scene.pbrt: its gzip stream ends too soon; is the file truncated?");
  EXPECT_EQ(error_of("\x1f\x8b no gzip after all"), "scene.pbrt: its gzip stream is damaged");
  EXPECT_EQ(error_of(""), "scene.pbrt:1:1: the scene has no WorldBegin");
}

TEST(BrokenScenes, Directives) {
  expect_errors({
      {"Worldbegin", "scene.pbrt:1:1", "no directive 'Worldbegin'; did you mean 'WorldBegin'?"},
      {"WorldBegin\nShpae \"sphere\"", "scene.pbrt:2:1", "did you mean 'Shape'?"},
      {R"(WorldBegin Volume "x")", "scene.pbrt:1:12", "there is no directive 'Volume'"},
      {"Film rgb", "scene.pbrt:1:6", "expected the type of Film as a string, found 'rgb'"},
      {"Camera", "scene.pbrt:1:7", "found the end of the file"},
      {R"(Camera "perspective" 30)", "scene.pbrt:1:22", "expected a directive, found number '30'"},
      {R"(ColorSpace "sgrb")", "scene.pbrt:1:12", "did you mean 'srgb'?"},
      {"ActiveTransform Never", "scene.pbrt:1:17", "expected StartTime, EndTime or All"},
      {"TransformTimes 1", "scene.pbrt:1:17", "expected the ending time"},
      {"TransformTimes 1 0", "scene.pbrt:1:1", "must begin before they end"},
      {"Option seed 3", "scene.pbrt:1:8", "Option expects the name"},
      {R"(Option "seed")", "scene.pbrt:1:14", "option 'seed' expects"},
      {R"(Option "seed" Film)", "scene.pbrt:1:15", "found 'Film'"},
      {R"(Option "a b c" 1)", "scene.pbrt:1:8", "Option expects the name"},
      {R"(Option "seed" 1 Option "seed" 2)", "scene.pbrt:1:24", "given twice"},
      {R"(WorldBegin Attribute "shpae" "float x" 1)", "scene.pbrt:1:22", "did you mean 'shape'?"},
      {R"(WorldBegin Texture "t" "color" "constant")", "scene.pbrt:1:24",
       "float or spectrum, not 'color'"},
      {R"(WorldBegin Texture "t" "float")", "scene.pbrt:1:31", "expected the type of Texture"},
      {R"(MakeNamedMedium "m" "float g" 0)", "scene.pbrt:1:1", R"("string type")"},
      {R"(WorldBegin MakeNamedMaterial "m")", "scene.pbrt:1:12", R"("string type")"},
      {"MediumInterface fog", "scene.pbrt:1:17", "expected the name of a medium"},
  });
}

TEST(BrokenScenes, OrderOfDirectives) {
  expect_errors({
      {R"(Film "rgb")", "scene.pbrt:1:11", "the scene has no WorldBegin"},
      {R"(Shape "sphere" WorldBegin)", "scene.pbrt:1:1", "Shape must stand after WorldBegin"},
      {R"(LightSource "point")", "scene.pbrt:1:1", "must stand after WorldBegin"},
      {"AttributeBegin", "scene.pbrt:1:1", "must stand after WorldBegin"},
      {R"(Material "diffuse")", "scene.pbrt:1:1", "must stand after WorldBegin"},
      {R"(Import "a.pbrt")", "scene.pbrt:1:1", "Import must stand after WorldBegin"},
      {"WorldBegin\nCamera \"perspective\"", "scene.pbrt:2:1", "Camera must stand before"},
      {R"(WorldBegin Film "rgb")", "scene.pbrt:1:12", "Film must stand before WorldBegin"},
      {R"(WorldBegin Option "seed" 1)", "scene.pbrt:1:12", "Option must stand before"},
      {"WorldBegin WorldBegin", "scene.pbrt:1:12", "WorldBegin must stand before WorldBegin"},
  });
}

TEST(BrokenScenes, Scopes) {
  expect_errors({
      {"WorldBegin\nAttributeBegin\n", "scene.pbrt:2:1", "AttributeBegin is never closed"},
      {"WorldBegin\n AttributeEnd", "scene.pbrt:2:2", "AttributeEnd has no AttributeBegin"},
      {"WorldBegin ObjectEnd", "scene.pbrt:1:12", "ObjectEnd has no ObjectBegin"},
      {R"(WorldBegin ObjectBegin "a")", "scene.pbrt:1:12", "ObjectBegin is never closed"},
      {"WorldBegin TransformBegin", "scene.pbrt:1:12", "TransformBegin is never closed"},
      {"WorldBegin\nAttributeBegin\nObjectBegin \"a\"\nAttributeEnd", "scene.pbrt:4:1",
       "expected ObjectEnd for the ObjectBegin in line 3, found AttributeEnd"},
      {"WorldBegin\nObjectBegin \"a\"\nAttributeBegin\nObjectEnd", "scene.pbrt:4:1",
       "expected AttributeEnd for the AttributeBegin in line 3"},
      {"WorldBegin\nObjectBegin \"a\" ObjectBegin \"b\"", "scene.pbrt:2:17",
       "inside another object, begun in line 2"},
      {R"(WorldBegin ObjectBegin "a" ObjectInstance "a")", "scene.pbrt:1:28",
       "may not stand inside an object"},
      {R"(WorldBegin Import "open.pbrt" AttributeEnd)", "open.pbrt:2:2", "never closed"},
      {R"(WorldBegin AttributeBegin Import "close.pbrt")", "close.pbrt:1:2",
       "has no AttributeBegin"},
      {R"(WorldBegin Include "open.pbrt")", "open.pbrt:2:2", "never closed"},
  });
  std::string deep = "WorldBegin\n";
  for (int i = 0; i < 1001; ++i) deep += "AttributeBegin\n";
  EXPECT_NE(error_of(deep).find("scene.pbrt:1002:1: attributes and objects stand more than 1000"),
            std::string::npos);
}

TEST(BrokenScenes, TransformsThatAreNone) {
  expect_errors({
      {"Translate 1 2", "scene.pbrt:1:14", "expected number 3 of the 3 of Translate"},
      {R"(Translate 1 2 "3")", "scene.pbrt:1:15", "found string '3'"},
      {"Translate 1 2 3 4", "scene.pbrt:1:17", "expected a directive, found number '4'"},
      {"Scale 0 0 0", "scene.pbrt:1:1", "Scale by 0 is singular"},
      {"\nScale 1 1 0", "scene.pbrt:2:1", "Scale by 0 is singular"},
      {"Rotate 90 0 0 0", "scene.pbrt:1:1", "an axis that is not 0 0 0"},
      {"Rotate 90 0 0", "scene.pbrt:1:14", "number 4 of the 4 of Rotate"},
      {"LookAt 1 2 3 1 2 3 0 1 0", "scene.pbrt:1:1", "a target other than the position"},
      {"LookAt 0 0 0 0 2 0 0 1 0", "scene.pbrt:1:1", "not parallel to the view"},
      {"LookAt 0 0 0 0 2 0 0 0 0", "scene.pbrt:1:1", "an up vector that is not 0 0 0"},
      {"LookAt 0 0 0 0 2 0", "scene.pbrt:1:19", "number 7 of the 9 of LookAt"},
      {"Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 ]", "scene.pbrt:1:43",
       "number 16 of the 16 of a transform"},
      {"Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 7 ]", "scene.pbrt:1:45", "expected ']'"},
      {"Transform [ 1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1 ]", "scene.pbrt:1:1", "singular"},
      {"ConcatTransform [ 1 2 0 0 2 4 0 0 0 0 1 0 0 0 0 1 ]", "scene.pbrt:1:1", "singular"},
      {"Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2 ]", "scene.pbrt:1:1", "the last one 1"},
      {"Scale 1e20 1 1\nScale 1e20 1 1", "scene.pbrt:2:1", "too large or small"},
      {"Scale 1e-20 1 1\nScale 1e-20 1 1", "scene.pbrt:2:1", "too large or small"},
      {"Translate 3e38 0 0", "scene.pbrt:1:1", "too large or small"},
      {R"(CoordSysTransform "camera")", "scene.pbrt:1:19", "no coordinate system 'camera'"},
      {R"(Camera "perspective" CoordSysTransform "camrea")", "scene.pbrt:1:40",
       "did you mean 'camera'?"},
  });
}

TEST(BrokenScenes, Parameters) {
  expect_errors({
      {R"(Film "rgb" "flaot x" 1)", "scene.pbrt:1:12", "type 'flaot'; did you mean 'float'?"},
      {R"(Film "rgb" "float" 1)", "scene.pbrt:1:12", "expected a parameter's type and name"},
      {R"(Film "rgb" "float a b" 1)", "scene.pbrt:1:12", "expected a parameter's type and name"},
      {R"(Film "rgb" "" 1)", "scene.pbrt:1:12", "expected a parameter's type and name"},
      {R"(Film "rgb" "float x")", "scene.pbrt:1:21", "found the end of the file"},
      {R"(Film "rgb" "float x" Sampler)", "scene.pbrt:1:22", "expects a number, found 'Sampler'"},
      {R"(Film "rgb" "float x" [])", "scene.pbrt:1:12", "has no value"},
      {R"(Film "rgb" "spectrum x" [])", "scene.pbrt:1:12", "has no value"},
      {R"(Film "rgb" "float x" [ 1 2)", "scene.pbrt:1:22", "bracket is never closed"},
      {R"(Film "rgb" "float x" [ 1 [ 2 ] ])", "scene.pbrt:1:26", "expects a number, found '['"},
      {R"(Film "rgb" "float x" "1")", "scene.pbrt:1:22", "expects a number, found string '1'"},
      {R"(Film "rgb" "float x" [ 1 "a" ])", "scene.pbrt:1:26", "found string 'a'"},
      {R"(Film "rgb" "integer x" 1.5)", "scene.pbrt:1:24", "an integer, found number '1.5'"},
      {R"(Film "rgb" "integer x" 2147483648)", "scene.pbrt:1:24", "range of 32 bits"},
      {R"(Film "rgb" "integer x" -99999999999)", "scene.pbrt:1:24", "range of 32 bits"},
      {R"(Film "rgb" "float x" 1e40)", "scene.pbrt:1:22", "out of range"},
      {R"(Film "rgb" "float x" NaN)", "scene.pbrt:1:22", "not a finite number"},
      {R"(Film "rgb" "bool x" yes)", "scene.pbrt:1:21", "expects true or false, found 'yes'"},
      {R"(Film "rgb" "bool x" 1)", "scene.pbrt:1:21", "expects true or false"},
      {R"(Film "rgb" "string x" 1)", "scene.pbrt:1:23", "expects a string"},
      {R"(Film "rgb" "string x" true)", "scene.pbrt:1:23", "expects a string"},
      {R"(Film "rgb" "point3 x" [1 2])", "scene.pbrt:1:12", "a multiple of 3 numbers, has 2"},
      {R"(Film "rgb" "point2 x" 1)", "scene.pbrt:1:12", "a multiple of 2 numbers, has 1"},
      {R"(Film "rgb" "rgb x" [1 2 3 4])", "scene.pbrt:1:12", "a multiple of 3 numbers, has 4"},
      {R"(Film "rgb" "spectrum x" [400 1 500])", "scene.pbrt:1:12", "a multiple of 2"},
      {R"(Film "rgb" "spectrum x" [500 1 400 2])", "scene.pbrt:1:12", "400 follows 500"},
      {R"(Film "rgb" "spectrum x" [0 1])", "scene.pbrt:1:12", "positive and increase"},
      {R"(Film "rgb" "spectrum x" [400 1 "metal-Au-k"])", "scene.pbrt:1:32",
       "found string 'metal-Au-k'"},
      {R"(Film "rgb" "spectrum x" "metal-Xy-k")", "scene.pbrt:1:12",
       "neither a known spectrum nor a file 'metal-Xy-k'"},
      {R"(Film "rgb" "spectrum x" "odd.spd")", "odd.spd:1:1", "has 3 numbers"},
      {R"(Film "rgb" "spectrum x" "words.spd")", "words.spd:1:5", "found 'one'"},
      {R"(Film "rgb" "spectrum x" "empty.spd")", "empty.spd:1:10", "has 0 numbers"},
      {R"(Film "rgb" "spectrum x" "falling.spd")", "falling.spd:1:1", "400 follows 500"},
      {"Film \"rgb\" \"float x\" 1\n  \"integer x\" 2", "scene.pbrt:2:3",
       "'x' is given twice, first in line 1"},
  });
  std::string many = R"(Film "rgb")";
  for (int i = 0; i < 201; ++i) many += fmt::format("\n\"float x{}\" 1", i);
  EXPECT_EQ(error_of(many), "scene.pbrt:202:1: Film 'rgb' has more than 200 parameters");
}

TEST(BrokenScenes, References) {
  expect_errors({
      {"WorldBegin\nNamedMaterial \"glas\"\nMakeNamedMaterial \"glass\" \"string type\" \"x\"",
       "scene.pbrt:2:15", "no material 'glas'; did you mean 'glass'?"},
      {R"(WorldBegin MediumInterface "" "fgo" MakeNamedMedium "fog" "string type" "x")",
       "scene.pbrt:1:31", "no medium 'fgo'; did you mean 'fog'?"},
      {"MediumInterface \"fog\"\nWorldBegin", "scene.pbrt:1:17", "no medium 'fog'"},
      {R"(WorldBegin Material "diffuse" "texture reflectance" "wood")", "scene.pbrt:1:31",
       "there is no texture 'wood'"},
      {R"(WorldBegin Texture "wood" "float" "constant" Shape "disk" "texture alpha" )"
       R"("woood")",
       "scene.pbrt:1:59", "did you mean 'wood'?"},
      {"WorldBegin\nObjectInstance \"tree\"", "scene.pbrt:2:16", "there is no object 'tree'"},
      {"WorldBegin ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\" ObjectEnd", "scene.pbrt:2:13",
       "object 'a' is defined already"},
      {"MakeNamedMedium \"m\" \"string type\" \"x\"\nMakeNamedMedium \"m\" \"string type\" \"x\"",
       "scene.pbrt:2:17", "medium 'm' is defined already"},
      {"WorldBegin MakeNamedMaterial \"m\" \"string type\" \"x\"\n"
       R"(MakeNamedMaterial "m" "string type" "x")",
       "scene.pbrt:2:19", "material 'm' is defined already"},
      {"WorldBegin Texture \"t\" \"float\" \"constant\"\nTexture \"t\" \"float\" \"constant\"",
       "scene.pbrt:2:9", "float texture 't' is defined already"},
      {"WorldBegin\nTexture \"t\" \"float\" \"scale\" \"texture tex\" \"t\"", "scene.pbrt:2:1",
       "texture 't' is made of itself"},
      {"WorldBegin\nTexture \"t\" \"float\" \"scale\" \"texture tex\" \"u\"\n"
       R"(Texture "u" "float" "scale" "texture tex" "t")",
       "scene.pbrt:2:1", "texture 't' is made of itself"},
      {"WorldBegin Attribute \"texture\" \"texture tex\" \"t\"\nTexture \"t\" \"float\" \"scale\"",
       "scene.pbrt:2:1", "texture 't' is made of itself"},
      {R"(WorldBegin Attribute "shape" "texture alpha" "t")", "scene.pbrt:1:30",
       "there is no texture 't'"},
  });
}

TEST(BrokenScenes, Files) {
  expect_errors({
      {"Include missing.pbrt", "scene.pbrt:1:9", "found 'missing.pbrt'"},
      {"\nInclude \"missing.pbrt\"", "scene.pbrt:2:1", "'missing.pbrt': there is no such file"},
      {R"(WorldBegin Import "missing.pbrt")", "scene.pbrt:1:12", "there is no such file"},
      {R"(Include "self.pbrt")", "self.pbrt:2:1", "'self.pbrt' includes itself"},
      {R"(Include "ping.pbrt")", "pong.pbrt:1:3", "'ping.pbrt' includes itself"},
      {R"(Include "main.pbrt")", "main.pbrt:1:1", "'scene.pbrt' includes itself"},
      {R"(WorldBegin Import "self.pbrt")", "self.pbrt:2:1", "includes itself"},
      {"WorldBegin\nInclude \"typo.pbrt\"", "typo.pbrt:2:1", "did you mean 'Shape'?"},
      {R"(Include "binary.pbrt")", "binary.pbrt:2:1", "byte 0x01 is no text"},
      {R"(Include "cut.gz")", "scene.pbrt:1:1", "'cut.gz': its gzip stream ends too soon"},
      {R"(Include "")", "scene.pbrt:1:1", "there is no such file"},
  });
  std::map<std::string, std::string> deep;
  for (int i = 0; i < 40; ++i) {
    deep[fmt::format("{}.pbrt", i)] = fmt::format(R"(Include "{}.pbrt")", i + 1);
  }
  EXPECT_EQ(error_of(R"(Include "0.pbrt")", deep),
            "30.pbrt:1:1: files include one another more than 32 deep");
}

TEST(BrokenScenes, ThatReadTooManyFiles) {
  // Each file includes the next one ten times: 10^6 files in seven texts.
  std::map<std::string, std::string> files;
  for (int i = 0; i < 7; ++i) {
    std::string& text = files[fmt::format("{}.pbrt", i)];
    for (int k = 0; i < 6 && k < 10; ++k) text += fmt::format(R"(Include "{}.pbrt" )", i + 1);
  }
  EXPECT_NE(error_of(R"(Include "0.pbrt")", files).find("more than 100000 files"),
            std::string::npos);
}

}  // namespace
}  // namespace freepath::testing
