#include "apps/freepath/method_list.h"

namespace freepath::program {

std::vector<std::string> split_methods(std::string_view text) {
  std::vector<std::string> methods;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view part = text.substr(0, comma);
    const std::size_t equals = part.find('=');
    const bool is_option = equals != std::string_view::npos && part.find(':') > equals;
    if (is_option && !methods.empty()) {
      methods.back().append(",").append(part);
    } else {
      methods.emplace_back(part);
    }
    if (comma == std::string_view::npos) return methods;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace freepath::program
