#pragma once
/// @file Parameter lists as text: "float fov" 30 "rgb L" [ 1 2 3 ].

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "freepath/scene/pbrt/parameter_list.h"
#include "freepath/scene/pbrt/token_stream.h"

namespace freepath {

/// What a parameter's text means depends on.
struct ParameterContext {
  ColorSpace color_space = ColorSpace::kSrgb;  ///< Colour space of rgb values.
  /// Reads the spectrum in a file that a parameter names.
  /// @throws Error, beginning with the place given, if there is no such file or it is no spectrum
  std::function<std::shared_ptr<const SpectrumSamples>(const std::string&, const SourceLocation&)>
      read_spectrum;
};

/// Reads parameters up to the next token that is no string, and leaves that in the stream.
/// @param owner what messages call the statement
/// @throws Error, beginning "file:line:column: ", for an unknown type, a missing or surplus value,
///   one of another type, a name given twice
ParameterList parse_parameters(TokenStream& tokens, const ParameterContext& context,
                               const std::string& owner, const SourceLocation& location);

/// The name and the one value of an Option directive. The type, which pbrt leaves out there, is
/// that of the value: integer, float, bool or string.
std::shared_ptr<const Parameter> parse_option(TokenStream& tokens, const ParameterContext& context);

/// The numbers of a spectrum file, pairs of wavelength [nm] and value.
/// @throws Error, beginning "file:line:column: "
std::shared_ptr<const SpectrumSamples> parse_spectrum_file(Lexer& lexer);

}  // namespace freepath
