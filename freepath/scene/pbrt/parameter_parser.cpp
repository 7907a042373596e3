#include "freepath/scene/pbrt/parameter_parser.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "freepath/base/counted.h"
#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath {
namespace {

/// More than any statement has; keeps the search for names given twice from taking long.
constexpr std::size_t kMostParameters = 200;

struct Declaration {
  ParameterType type;
  std::string name;
};

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    const bool blank = c == ' ' || (c >= '\t' && c <= '\r');
    if (!blank) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::exchange(word, {}));
    }
  }
  if (!word.empty()) words.push_back(word);
  return words;
}

ParameterType parse_type(const std::string& name, const SourceLocation& location) {
  if (const auto type = find_parameter_type(name)) return *type;
  std::vector<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(ParameterType::kBlackbody); ++i) {
    names.push_back(name_of(static_cast<ParameterType>(i)));
  }
  fail_at(location, "there is no parameter type {}{}", in_quotes(name), did_you_mean(name, names));
}

Declaration parse_declaration(const Token& token, const SourceLocation& location) {
  const std::vector<std::string> words = words_of(token.text);
  if (words.size() != 2) {
    fail_at(location, "expected a parameter's type and name, as in \"float fov\", found {}",
            describe(token));
  }
  return {parse_type(words[0], location), words[1]};
}

std::string_view expected_token(ParameterType type) {
  switch (type) {
    case ParameterType::kInteger:
      return "an integer";
    case ParameterType::kBool:
      return "true or false";
    case ParameterType::kString:
      return "a string";
    case ParameterType::kTexture:
      return "the name of a texture as a string";
    case ParameterType::kSpectrum:
      return "a name as a string, or pairs of wavelength and value";
    default:
      return "a number";
  }
}

/// Values of one parameter as they come in.
class ValueReader {
 public:
  ValueReader(TokenStream& tokens, const ParameterContext& context, Parameter& parameter)
      : tokens_(tokens), context_(context), parameter_(parameter) {}

  /// Reads one value, or a list of them in brackets.
  void read() {
    if (tokens_.peek().kind != TokenKind::kOpenBracket) {
      add(tokens_.next());
    } else {
      const Token open = tokens_.next();
      while (tokens_.peek().kind != TokenKind::kCloseBracket) {
        if (tokens_.peek().kind == TokenKind::kEnd) {
          fail_at(tokens_.location(open), "this bracket is never closed");
        }
        add(tokens_.next());
      }
      tokens_.next();
    }
    finish();
  }

 private:
  void add(const Token& token);
  void add_integer(const Token& token);
  void finish();
  void finish_spectrum();
  void require_multiple(std::size_t count) const;
  [[noreturn]] void fail_value(const Token& token) const;

  TokenStream& tokens_;
  const ParameterContext& context_;
  Parameter& parameter_;
  std::vector<double> numbers_;
  std::vector<int> integers_;
  std::vector<std::string> strings_;
  std::vector<bool> bools_;
};

void ValueReader::fail_value(const Token& token) const {
  fail_at(tokens_.location(token), "parameter {} of type {} expects {}, found {}",
          in_quotes(parameter_.name), name_of(parameter_.type), expected_token(parameter_.type),
          describe(token));
}

void ValueReader::add_integer(const Token& token) {
  if (!token.is_whole) fail_value(token);
  if (token.number < std::numeric_limits<int>::min() ||
      token.number > std::numeric_limits<int>::max()) {
    fail_at(tokens_.location(token), "integer {} is out of the range of 32 bits",
            in_quotes(token.source));
  }
  integers_.push_back(static_cast<int>(token.number));
}

void ValueReader::add(const Token& token) {
  const bool is_string = token.kind == TokenKind::kString;
  switch (parameter_.type) {
    case ParameterType::kBool: {
      // Scenes for pbrt-v3 have them in quotes.
      const std::string_view word = is_string ? std::string_view(token.text) : token.source;
      if (word != "true" && word != "false") fail_value(token);
      bools_.push_back(word == "true");
      return;
    }
    case ParameterType::kString:
    case ParameterType::kTexture:
      if (!is_string) fail_value(token);
      strings_.push_back(token.text);
      return;
    case ParameterType::kInteger:
      if (token.kind != TokenKind::kNumber) fail_value(token);
      add_integer(token);
      return;
    case ParameterType::kSpectrum:
      if (is_string && numbers_.empty()) {
        strings_.push_back(token.text);
        return;
      }
      if (!strings_.empty()) fail_value(token);
      [[fallthrough]];
    default:
      if (token.kind != TokenKind::kNumber) fail_value(token);
      numbers_.push_back(token.number);
  }
}

void ValueReader::require_multiple(std::size_t count) const {
  if (count == 0) {
    fail_at(parameter_.location, "parameter {} has no value", in_quotes(parameter_.name));
  }
  const int width = numbers_per_value(parameter_.type);
  if (count % static_cast<std::size_t>(width) == 0) return;
  fail_at(parameter_.location, "parameter {} of type {} expects a multiple of {} numbers, has {}",
          in_quotes(parameter_.name), name_of(parameter_.type), width, count);
}

/// @throws Error unless wavelengths are positive and increase
std::shared_ptr<const SpectrumSamples> make_samples(std::span<const double> pairs,
                                                    const SourceLocation& location) {
  auto spectrum = std::make_shared<SpectrumSamples>();
  double last = 0;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
    if (!(pairs[i] > last)) {
      fail_at(location, "wavelengths must be positive and increase, but {} follows {}", pairs[i],
              last);
    }
    last = pairs[i];
    spectrum->wavelengths.push_back(pairs[i]);
    spectrum->values.push_back(pairs[i + 1]);
  }
  return spectrum;
}

void ValueReader::finish_spectrum() {
  std::vector<SpectrumValue> spectra;
  if (!numbers_.empty()) {
    require_multiple(numbers_.size());
    spectra.emplace_back(make_samples(numbers_, parameter_.location));
  }
  for (std::string& name : strings_) {
    if (is_named_spectrum(name)) {
      spectra.emplace_back(NamedSpectrum{std::move(name)});
    } else {
      spectra.emplace_back(context_.read_spectrum(name, parameter_.location));
    }
  }
  if (spectra.empty()) require_multiple(0);
  parameter_.values = std::move(spectra);
}

void ValueReader::finish() {
  switch (parameter_.type) {
    case ParameterType::kBool:
      require_multiple(bools_.size());
      parameter_.values = std::move(bools_);
      return;
    case ParameterType::kString:
    case ParameterType::kTexture:
      require_multiple(strings_.size());
      parameter_.values = std::move(strings_);
      return;
    case ParameterType::kInteger:
      require_multiple(integers_.size());
      parameter_.values = std::move(integers_);
      return;
    case ParameterType::kSpectrum:
      finish_spectrum();
      return;
    default:
      require_multiple(numbers_.size());
      numbers_.shrink_to_fit();
      parameter_.values = std::move(numbers_);
  }
}

std::shared_ptr<const Parameter> parse_values(TokenStream& tokens, const ParameterContext& context,
                                              Declaration declaration,
                                              const SourceLocation& location) {
  auto parameter = std::make_shared<Parameter>();
  parameter->type = declaration.type;
  parameter->name = std::move(declaration.name);
  parameter->location = location;
  parameter->color_space = context.color_space;
  ValueReader(tokens, context, *parameter).read();
  return parameter;
}

ParameterType type_of_option(TokenStream& tokens, const std::string& name) {
  const Token& value = tokens.peek();
  if (value.kind == TokenKind::kString) return ParameterType::kString;
  if (value.source == "true" || value.source == "false") return ParameterType::kBool;
  if (value.kind == TokenKind::kNumber) {
    return value.is_whole ? ParameterType::kInteger : ParameterType::kFloat;
  }
  fail_at(tokens.location(value), "option {} expects a number, a string, true or false, found {}",
          in_quotes(name), describe(value));
}

}  // namespace

ParameterList parse_parameters(TokenStream& tokens, const ParameterContext& context,
                               const std::string& owner, const SourceLocation& location) {
  ParameterList list(owner, location);
  for (std::size_t count = 0; tokens.peek().kind == TokenKind::kString; ++count) {
    const Token token = tokens.next();
    const SourceLocation location = tokens.location(token);
    if (count == kMostParameters) {
      fail_at(location, "{} has more than {} parameters", owner, kMostParameters);
    }
    list.add(parse_values(tokens, context, parse_declaration(token, location), location));
  }
  return list;
}

std::shared_ptr<const Parameter> parse_option(TokenStream& tokens,
                                              const ParameterContext& context) {
  const Token token = tokens.next();
  const SourceLocation location = tokens.location(token);
  const std::vector<std::string> words = words_of(token.text);
  if (token.kind != TokenKind::kString || words.empty() || words.size() > 2) {
    fail_at(location, "Option expects the name of an option as a string, found {}",
            describe(token));
  }
  const ParameterType type =
      words.size() == 2 ? parse_type(words[0], location) : type_of_option(tokens, words[0]);
  return parse_values(tokens, context, {type, words.back()}, location);
}

std::shared_ptr<const SpectrumSamples> parse_spectrum_file(Lexer& lexer) {
  std::vector<double> pairs;
  const SourceLocation start = lexer.location(lexer.peek());
  while (lexer.peek().kind != TokenKind::kEnd) {
    const Token token = lexer.next();
    if (token.kind != TokenKind::kNumber) {
      fail_at(lexer.location(token), "expected a number of a spectrum, found {}", describe(token));
    }
    pairs.push_back(token.number);
  }
  if (pairs.empty() || pairs.size() % 2 != 0) {
    fail_at(start, "a spectrum file expects pairs of wavelength and value, has {}",
            counted(pairs.size(), "number"));
  }
  return make_samples(pairs, start);
}

}  // namespace freepath
