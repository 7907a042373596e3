#include "apps/freepath/method_list.h"

#include "freepath/base/error.h"

namespace freepath::program {
namespace {

bool is_option(std::string_view item) {
  const std::size_t equals = item.find('=');
  return equals != std::string_view::npos && item.find(':') > equals;
}

}  // namespace

std::vector<std::string> split_methods(std::string_view text) {
  std::vector<std::string> methods;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view item = text.substr(0, comma);
    if (item.empty()) fail("a method is missing next to a comma, or the list is empty");
    if (!is_option(item)) {
      methods.emplace_back(item);
    } else if (methods.empty() || methods.back().find(':') == std::string::npos) {
      fail("the option '{}' follows no method with options; methods are NAME:OPTION=VALUE", item);
    } else {
      methods.back().append(",").append(item);
    }
    if (comma == std::string_view::npos) return methods;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace freepath::program
