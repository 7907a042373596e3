#include "freepath/scene/pbrt/parameter_list.h"

#include <algorithm>
#include <utility>

#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath {
namespace {

[[noreturn]] void fail_type(const Parameter& parameter, std::string_view expected) {
  fail_at(parameter.location, "parameter {} must be of type {}, not {}", in_quotes(parameter.name),
          expected, name_of(parameter.type));
}

void require_one(const Parameter& parameter, std::size_t count) {
  if (count == 1) return;
  fail_at(parameter.location, "parameter {} must be one {}, has {} values",
          in_quotes(parameter.name), name_of(parameter.type), count);
}

const Parameter* find_in(const SharedParameters& parameters, std::string_view name) {
  for (const auto& parameter : parameters) {
    if (parameter->name == name) return parameter.get();
  }
  return nullptr;
}

/// The only value of a parameter, or the default where there is no parameter.
template <class Value>
Value only(const Parameter* parameter, Value otherwise) {
  if (parameter == nullptr) return otherwise;
  const auto& values = std::get<std::vector<Value>>(parameter->values);
  require_one(*parameter, values.size());
  return values[0];
}

template <class Value>
std::span<const Value> every(const Parameter* parameter) {
  if (parameter == nullptr) return {};
  return std::get<std::vector<Value>>(parameter->values);
}

std::vector<SpectrumValue> spectra_of(const Parameter& parameter) {
  std::vector<SpectrumValue> spectra;
  if (parameter.type == ParameterType::kSpectrum) {
    return std::get<std::vector<SpectrumValue>>(parameter.values);
  }
  const auto& numbers = std::get<std::vector<double>>(parameter.values);
  if (parameter.type == ParameterType::kBlackbody) {
    for (const double temperature : numbers) spectra.emplace_back(BlackbodyValue{temperature});
    return spectra;
  }
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    spectra.emplace_back(
        RgbValue{numbers[i], numbers[i + 1], numbers[i + 2], parameter.color_space});
  }
  return spectra;
}

Vec3d triple_of(std::span<const double> numbers, const Vec3d& otherwise) {
  return numbers.empty() ? otherwise : Vec3d(numbers[0], numbers[1], numbers[2]);
}

}  // namespace

void ParameterList::add(std::shared_ptr<const Parameter> parameter) {
  if (const Parameter* const first = find_in(own_, parameter->name)) {
    fail_at(parameter->location, "parameter {} is given twice, first in line {}",
            in_quotes(parameter->name), first->location.line);
  }
  own_.push_back(std::move(parameter));
}

SharedParameters ParameterList::all() const {
  SharedParameters parameters = own_;
  if (inherited_ == nullptr) return parameters;
  for (const auto& parameter : *inherited_) {
    if (find_in(own_, parameter->name) == nullptr) parameters.push_back(parameter);
  }
  return parameters;
}

const Parameter* ParameterList::find_any(std::string_view name) const {
  const Parameter* const own = find_in(own_, name);
  if (own != nullptr || inherited_ == nullptr) return own;
  return find_in(*inherited_, name);
}

const Parameter* ParameterList::find(std::string_view name, ParameterType type) const {
  asked_.emplace(name);
  const Parameter* const parameter = find_any(name);
  if (parameter != nullptr && parameter->type != type) fail_type(*parameter, name_of(type));
  return parameter;
}

const Parameter* ParameterList::find_spectrum(std::string_view name) const {
  asked_.emplace(name);
  const Parameter* const parameter = find_any(name);
  if (parameter == nullptr) return nullptr;
  const ParameterType type = parameter->type;
  if (type != ParameterType::kRgb && type != ParameterType::kSpectrum &&
      type != ParameterType::kBlackbody) {
    fail_type(*parameter, "rgb, spectrum or blackbody");
  }
  return parameter;
}

std::span<const double> ParameterList::numbers(std::string_view name, ParameterType type) const {
  return every<double>(find(name, type));
}

std::span<const double> ParameterList::one(std::string_view name, ParameterType type) const {
  const Parameter* const parameter = find(name, type);
  const std::span<const double> values = every<double>(parameter);
  const auto width = static_cast<std::size_t>(numbers_per_value(type));
  if (parameter != nullptr) require_one(*parameter, values.size() / width);
  return values;
}

std::vector<Vec2d> ParameterList::pairs(std::string_view name, ParameterType type) const {
  const std::span<const double> values = numbers(name, type);
  std::vector<Vec2d> result;
  result.reserve(values.size() / 2);
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
    result.emplace_back(values[i], values[i + 1]);
  }
  return result;
}

std::vector<Vec3d> ParameterList::triples(std::string_view name, ParameterType type) const {
  const std::span<const double> values = numbers(name, type);
  std::vector<Vec3d> result;
  result.reserve(values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    result.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return result;
}

int ParameterList::get_integer(std::string_view name, int otherwise) const {
  return only<int>(find(name, ParameterType::kInteger), otherwise);
}
std::span<const int> ParameterList::get_integers(std::string_view name) const {
  return every<int>(find(name, ParameterType::kInteger));
}

double ParameterList::get_float(std::string_view name, double otherwise) const {
  const std::span<const double> value = one(name, ParameterType::kFloat);
  return value.empty() ? otherwise : value[0];
}
std::span<const double> ParameterList::get_floats(std::string_view name) const {
  return numbers(name, ParameterType::kFloat);
}

std::vector<Vec2d> ParameterList::get_point2s(std::string_view name) const {
  return pairs(name, ParameterType::kPoint2);
}

Vec3d ParameterList::get_point(std::string_view name, const Vec3d& otherwise) const {
  return triple_of(one(name, ParameterType::kPoint3), otherwise);
}
std::vector<Vec3d> ParameterList::get_points(std::string_view name) const {
  return triples(name, ParameterType::kPoint3);
}

Vec3d ParameterList::get_vector(std::string_view name, const Vec3d& otherwise) const {
  return triple_of(one(name, ParameterType::kVector3), otherwise);
}

std::vector<Vec3d> ParameterList::get_normals(std::string_view name) const {
  return triples(name, ParameterType::kNormal3);
}

bool ParameterList::get_bool(std::string_view name, bool otherwise) const {
  return only<bool>(find(name, ParameterType::kBool), otherwise);
}

std::string ParameterList::get_string(std::string_view name, const std::string& otherwise) const {
  return only<std::string>(find(name, ParameterType::kString), otherwise);
}
std::span<const std::string> ParameterList::get_strings(std::string_view name) const {
  return every<std::string>(find(name, ParameterType::kString));
}

std::string ParameterList::get_texture(std::string_view name) const {
  return only<std::string>(find(name, ParameterType::kTexture), {});
}

SpectrumValue ParameterList::get_spectrum(std::string_view name,
                                          const SpectrumValue& otherwise) const {
  const Parameter* const parameter = find_spectrum(name);
  if (parameter == nullptr) return otherwise;
  const std::vector<SpectrumValue> spectra = spectra_of(*parameter);
  require_one(*parameter, spectra.size());
  return spectra[0];
}
std::vector<SpectrumValue> ParameterList::get_spectra(std::string_view name) const {
  const Parameter* const parameter = find_spectrum(name);
  if (parameter == nullptr) return {};
  return spectra_of(*parameter);
}

std::optional<ParameterType> ParameterList::type_of(std::string_view name) const {
  asked_.emplace(name);
  const Parameter* const parameter = find_any(name);
  if (parameter == nullptr) return std::nullopt;
  return parameter->type;
}

const SourceLocation& ParameterList::location_of(std::string_view name) const {
  const Parameter* const parameter = find_any(name);
  return parameter == nullptr ? location_ : parameter->location;
}

void ParameterList::report_unused(Diagnostics& diagnostics, UnusedPolicy policy) const {
  const std::vector<std::string_view> known(asked_.begin(), asked_.end());
  for (const auto& parameter : own_) {
    if (asked_.contains(parameter->name)) continue;
    const std::string text =
        fmt::format("{} has no parameter {}{}", owner_, in_quotes(parameter->name),
                    did_you_mean(parameter->name, known));
    if (policy == UnusedPolicy::kError) fail_at(parameter->location, "{}", text);
    diagnostics.warn(parameter->location, text);
  }
}

}  // namespace freepath
