// The extension _freepath: the library's facade for arrays.

#include <nanobind/stl/string.h>

#include <cctype>
#include <exception>
#include <string>
#include <string_view>

#include "freepath/base/build_options.h"
#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "python/src/bindings.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

/// A message of the library that names options of the program, which are arguments of the same
/// names here: "--max-scatterings 100" becomes "max_scatterings=100".
std::string with_arguments(std::string_view text) {
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && std::islower(static_cast<unsigned char>(text[i])) != 0;
  };
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (!text.substr(i).starts_with("--") || !is_letter(i + 2)) {
      result += text[i++];
      continue;
    }
    for (i += 2; is_letter(i) || (text[i] == '-' && is_letter(i + 1)); ++i) {
      result += text[i] == '-' ? '_' : text[i];
      if (i + 1 == text.size()) return result;
    }
    const bool has_value =
        i + 1 < text.size() && text[i] == ' ' &&
        (std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0 ||
         text.substr(i + 1).starts_with("clamp") || text.substr(i + 1).starts_with("zero"));
    if (!has_value) continue;
    result += '=';
    ++i;
    const bool is_word = is_letter(i);
    if (is_word) result += '\'';
    while (is_letter(i) || (!is_word && i < text.size() && text[i] >= '0' && text[i] <= '9')) {
      result += text[i++];
    }
    if (is_word) result += '\'';
  }
  return result;
}

}  // namespace
}  // namespace freepath::python

NB_MODULE(_freepath, module) {
  using namespace freepath;
  // A density whose function sees the variable that holds it lives until the process ends, which
  // Python's collector can't know of, and is no news to users.
  nb::set_leak_warnings(false);
  module.doc() = "The library's facade for arrays; freepath is the module to import.";
  // For as long as the process lives, as the translator does.
  PyObject* const error_type = PyErr_NewExceptionWithDoc(
      "freepath.Error",
      "Bad input or a failed operation: the message says what is wrong, where, and what to do.",
      PyExc_ValueError, nullptr);
  module.attr("Error") = nb::borrow(error_type);
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void* type) {
        try {
          std::rethrow_exception(thrown);
        } catch (const Error& error) {
          PyErr_SetString(static_cast<PyObject*>(type),
                          python::with_arguments(error.what()).c_str());
        }
      },
      error_type);
  module.attr("version") = std::string(version());
  module.attr("max_channels") = kMaxChannels;
  python::bind_methods(module);
  python::bind_fields(module);
  python::bind_field_states(module);
  python::bind_media(module);
  python::bind_sampling(module);
  python::bind_scenes(module);
  python::bind_films(module);
  python::bind_pictures(module);
  python::bind_render_options(module);
  python::bind_rendering(module);
  python::bind_fluxes(module);
  python::bind_comparisons(module);
  python::bind_comparison_states(module);
  python::bind_laboratory(module);
}
