// Include and Import, and the files that parameters name.

#include <utility>

#include "freepath/scene/pbrt/scene_parser.h"
#include "freepath/scene/pbrt/source_text.h"

namespace freepath {

std::string SceneParser::read_named_file(const std::filesystem::path& path,
                                         const SourceLocation& location) {
  if (++files_read_ > limits_.files) {
    fail_at(location, "the scene reads more than {} files", limits_.files);
  }
  std::string bytes;
  try {
    bytes = unpack(reader_.read(path, limits_.file_bytes), limits_.file_bytes);
  } catch (const Error& error) {
    fail_at(location, "cannot read {}: {}", in_quotes(path.string()), error.what());
  }
  return check_text(std::move(bytes), path.string());
}

void SceneParser::open_file(const Token& name, const SourceLocation& location) {
  const std::filesystem::path path =
      locate_file(reader_, name.text, tokens_.file_of(name), tokens_.main_file());
  if (tokens_.is_open(path)) {
    fail_at(location, "{} includes itself", in_quotes(path.string()));
  }
  if (static_cast<int>(tokens_.depth()) >= limits_.include_depth) {
    fail_at(location, "files include one another more than {} deep", limits_.include_depth);
  }
  tokens_.open(path, read_named_file(path, location));
}

void SceneParser::include_file(const SourceLocation& location) {
  const Token name = expect_string("the name of a file");
  open_file(name, location);
}

// An imported file begins with a copy of the state, and leaves none of its own behind.
void SceneParser::import_file(const SourceLocation& location) {
  const Token name = expect_string("the name of a file");
  const GraphicsState state = state_;
  const auto coordinate_systems = coordinate_systems_;
  const std::size_t outside = std::exchange(scopes_outside_import_, scopes_.size());
  const std::size_t outside_files = tokens_.begin_part();
  open_file(name, location);
  parse_directives();
  if (scopes_.size() > scopes_outside_import_) {
    const OpenScope& open = scopes_.back();
    fail_at(open.location, "this {} is never closed in the imported file", begin_of(open.scope));
  }
  tokens_.end_part(outside_files);
  scopes_outside_import_ = outside;
  coordinate_systems_ = coordinate_systems;
  state_ = state;
}

std::shared_ptr<const SpectrumSamples> SceneParser::read_spectrum(const std::string& name,
                                                                  const SourceLocation& location) {
  const std::filesystem::path path =
      locate_file(reader_, name, *location.file, tokens_.main_file());
  auto& spectrum = spectra_[path.string()];
  if (spectrum == nullptr) {
    if (!reader_.exists(path)) {
      fail_at(location, "there is neither a known spectrum nor a file {}", in_quotes(name));
    }
    Lexer lexer(path.string(), read_named_file(path, location));
    spectrum = parse_spectrum_file(lexer);
  }
  return spectrum;
}

}  // namespace freepath
