#include "apps/freepath/domain_options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "apps/freepath/parse.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath::program {
namespace {

constexpr std::array kUpAxes{Choice<UpAxis>{"y", UpAxis::kY}, Choice<UpAxis>{"z", UpAxis::kZ}};

Box3d parse_domain(const std::string& text, std::string_view option,
                   const std::array<bool, 3>& axes) {
  const std::vector<double> numbers = parse_numbers(text, option);
  const auto count = static_cast<std::size_t>(std::count(axes.begin(), axes.end(), true));
  if (numbers.size() != 2 * count) {
    fail("{}: '{}' has {}; give FROM,TO for each of the {}", option, text,
         counted(numbers.size(), "value"), counted(count, "axis that repeats", "axes that repeat"));
  }
  Box3d extents{Vec3d(0), Vec3d(0)};
  std::size_t next = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!axes[axis]) continue;
    extents.min[axis] = numbers[next++];
    extents.max[axis] = numbers[next++];
    if (extents.min[axis] < extents.max[axis]) continue;
    fail("{}: along {} it reaches from {} to {}; the second has to be the larger", option,
         "xyz"[axis], extents.min[axis], extents.max[axis]);
  }
  return extents;
}

}  // namespace

Rgb spectrum_of(const std::vector<double>& numbers, std::size_t first) {
  const auto at = [&](std::size_t i) { return static_cast<float>(numbers[first + i]); };
  return numbers.size() < first + 3 ? Rgb(at(0)) : Rgb(at(0), at(1), at(2));
}

UpAxis parse_up(const std::string& text) { return parse_choice(text, "--up", kUpAxes); }

PeriodicSides parse_sides(const std::string& periodic, const std::string& domain, UpAxis up_axis) {
  PeriodicSides sides;
  if (periodic.empty()) {
    if (!domain.empty()) fail("--domain is that of --periodic, which is not given");
    return sides;
  }
  const int up = up_index(up_axis);
  std::string_view rest = periodic;
  while (true) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view name = rest.substr(0, comma);
    const std::size_t axis = name.size() == 1 ? std::string_view("xyz").find(name) : 3;
    if (axis >= 3) {
      fail("--periodic: '{}' is not a list of axes, such as x,y", periodic);
    }
    if (static_cast<int>(axis) == up) {
      fail("--periodic: {} is the axis that points up (--up), along which light comes in", name);
    }
    sides.axes[axis] = true;
    if (comma == rest.size()) break;
    rest.remove_prefix(comma + 1);
  }
  if (!domain.empty()) {
    sides.extents = parse_domain(domain, "--domain", sides.axes);
  }
  return sides;
}

std::optional<Ground> parse_ground(const std::string& text, UpAxis up) {
  if (text.empty()) return std::nullopt;
  const std::vector<double> numbers = parse_numbers(text, "--ground");
  if (numbers.size() > 4) fail("--ground: '{}' is not ALBEDO[,HEIGHT] or R,G,B[,HEIGHT]", text);
  Ground ground;
  ground.up = up;
  const bool is_coloured = numbers.size() > 2;
  ground.albedo = is_coloured ? spectrum_of(numbers, 0) : Rgb(static_cast<float>(numbers[0]));
  if (numbers.size() % 2 == 0) ground.height = numbers.back();
  read_option("--ground", [&] { check(ground); });
  return ground;
}

}  // namespace freepath::program
