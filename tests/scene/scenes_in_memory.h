#pragma once
/// @file Scenes that are no files: texts with names, and what the parser makes of them.

#include <map>
#include <string>

#include "freepath/base/error.h"
#include "freepath/scene/pbrt/parser.h"

namespace freepath::testing {

/// Files in memory; touches no disk.
class MemoryFileReader final : public FileReader {
 public:
  explicit MemoryFileReader(std::map<std::string, std::string> files) : files_(std::move(files)) {}

  bool exists(const std::filesystem::path& path) const override {
    return files_.contains(path.string());
  }
  std::string read(const std::filesystem::path& path, std::size_t limit) const override {
    const auto found = files_.find(path.string());
    if (found == files_.end()) fail("there is no such file");
    if (found->second.size() > limit) fail("it is too large");
    return found->second;
  }

 private:
  std::map<std::string, std::string> files_;
};

/// A scene with the files beside it; the scene itself is called "scene.pbrt".
inline PbrtScene parse(const std::string& text, Diagnostics& diagnostics,
                       const std::map<std::string, std::string>& files = {}) {
  return parse_pbrt_text(text, "scene.pbrt", diagnostics, MemoryFileReader(files));
}

/// The same for scenes of which nothing is to be said.
inline PbrtScene parse(const std::string& text,
                       const std::map<std::string, std::string>& files = {}) {
  Diagnostics diagnostics;
  PbrtScene scene = parse(text, diagnostics, files);
  if (!diagnostics.warnings().empty()) fail("unexpected warning: {}", diagnostics.warnings()[0]);
  return scene;
}

/// The message of the error that a scene ends with; empty if there is none.
inline std::string error_of(const std::string& text,
                            const std::map<std::string, std::string>& files = {}) {
  Diagnostics diagnostics;
  try {
    parse(text, diagnostics, files);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace freepath::testing
