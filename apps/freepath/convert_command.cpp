// freepath convert: volumes of one format, written in another.

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/render_volumes.h"
#include "freepath/base/error.h"
#include "freepath/io/volume.h"
#include "freepath/io/volume_scale.h"
#include "freepath/io/volume_units.h"
#include "freepath/io/volume_write.h"

namespace freepath::program {
namespace {

constexpr const char* kConvertFooter =
    R"(Reads OpenVDB, NanoVDB, VTI and legacy VTK images, NRRD, MetaImage, NIfTI, NetCDF, and raw values of
which --raw-size and --raw-type tell the layout (x fastest). Writes OpenVDB (.vdb), NanoVDB (.nvdb) or
VTI (.vti), by the name of OUT. docs/volumes.md tells what is read of each format.

Of a NetCDF file with liquid water (lwc, ql, qc, ...) and effective radius (re, ...), the grid is
"extinction", 3/2 LWC/(rho_w r_e) in 1/m, positions being in m; its variables are grids too, and NAME@3
is the fourth time of one.

--unit gives positions in another unit than the file's, which it must tell, or --input-unit tell.
Values that are extinctions (1/m) follow, so that optical depths stay.

Examples:
  freepath convert les.nc cloud.vdb --unit km
  freepath convert les.nc cloud.nvdb --grid extinction@12 --half
  freepath convert smoke.vti smoke.vdb --grid density --grid temperature
  freepath convert scan.nii.gz scan.vdb --scale 0.001 --negative clamp
  freepath convert values.raw smoke.vdb --raw-size 64,64,128 --raw-type uint8 --raw-spacing 0.1
  freepath convert cloud.vdb cloud.vti)";

struct ConvertOptions {
  std::string input, output;
  std::vector<std::string> grids;
  bool all = false, half = false;
  std::string name, unit, input_unit;
  double scale = 1, effective_radius = 0;
  std::string negative = "error", invalid = "zero";
  std::string raw_size, raw_type = "float32", raw_spacing, raw_origin, raw_order = "little";
  uint64_t raw_offset = 0;
};

/// One number for all axes, or three.
Vec3d parse_axes(const std::string& text, std::string_view option) {
  const std::vector<double> numbers = parse_numbers(text, option);
  if (numbers.size() == 1) return Vec3d(numbers[0]);
  if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
  fail("{}: '{}' has {} values; give one for all axes, or three: X,Y,Z", option, text,
       numbers.size());
}

RawLayout read_raw_layout(const ConvertOptions& options) {
  RawLayout layout;
  const Vec3d size = parse_axes(options.raw_size, "--raw-size");
  constexpr double kMost = 1 << 24;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] >= 1 && size[axis] <= kMost) || size[axis] != std::floor(size[axis])) {
      fail("--raw-size: {} is not a whole number from 1 to {}", size[axis], kMost);
    }
    layout.counts[axis] = static_cast<int>(size[axis]);
  }
  constexpr std::array kOrders{Choice<std::endian>{"little", std::endian::little},
                               Choice<std::endian>{"big", std::endian::big}};
  layout.type = options.raw_type;
  layout.order = parse_choice(options.raw_order, "--raw-order", kOrders);
  layout.offset = options.raw_offset;
  if (!options.raw_spacing.empty()) {
    layout.spacing = parse_axes(options.raw_spacing, "--raw-spacing");
  }
  if (!options.raw_origin.empty()) layout.origin = parse_axes(options.raw_origin, "--raw-origin");
  return layout;
}

LoadOptions read_load_options(const ConvertOptions& options) {
  VolumeOptions volume;
  volume.files = {options.input};
  volume.negative = options.negative;
  volume.invalid = options.invalid;
  LoadOptions load = plan_volumes(volume).front().grids.front();
  constexpr double kMicrometer = 1e-6;
  load.effective_radius = kMicrometer * options.effective_radius;
  if (!options.raw_size.empty()) load.raw = read_raw_layout(options);
  return load;
}

double meters_of_option(const std::string& unit, std::string_view option) {
  const std::optional<double> meters = meters_of(unit);
  if (!meters) fail("{}: '{}' is no unit of length; give m, km, cm, mm or um", option, unit);
  return *meters;
}

/// Factor of the lengths of a field.
double length_scale(const ConvertOptions& options, const LoadedField& loaded) {
  if (options.unit.empty()) {
    if (options.input_unit.empty()) return 1;
    fail("--input-unit changes nothing without --unit, the one to convert to");
  }
  const double target = meters_of_option(options.unit, "--unit");
  const std::string& own = loaded.length_unit;
  if (!options.input_unit.empty()) {
    if (!own.empty()) fail("--input-unit: {} tells its own unit, {}", options.input, own);
    return meters_of_option(options.input_unit, "--input-unit") / target;
  }
  const std::optional<double> meters = meters_of(own);
  if (!meters) {
    fail("--unit: {} {}; tell its unit by --input-unit", options.input,
         own.empty() ? "doesn't tell the unit of its positions"
                     : fmt::format("has positions in '{}', which is not known", own));
  }
  return *meters / target;
}

Field converted(const ConvertOptions& options, LoadedField& loaded) {
  const double lengths = length_scale(options, loaded);
  const double values = options.scale / (loaded.value_unit == "1/m" ? lengths : 1);
  if (lengths == 1 && values == 1) return std::move(loaded.field);
  return scaled_field(loaded.field, values, lengths);
}

/// The fields of the grids that are chosen; several of one name would be one to readers.
std::vector<LoadedField> load_chosen(const ConvertOptions& options) {
  LoadOptions load = read_load_options(options);
  std::vector<LoadedField> loaded;
  const auto take = [&](std::vector<LoadedField> fields) {
    for (LoadedField& field : fields) loaded.push_back(std::move(field));
  };
  if (options.all) {
    visit_grids(options.input, {}, load,
                [&](const GridInfo& info, std::vector<LoadedField> fields) {
                  if (fields.empty()) {
                    warn("{}: grid \"{}\" is left out: {}", options.input, info.name, info.reason);
                  }
                  take(std::move(fields));
                });
    if (loaded.empty()) fail("{}: it has no grid that could be converted", options.input);
    return loaded;
  }
  std::vector<std::string> grids = options.grids;
  if (grids.empty()) grids.emplace_back();
  for (const std::string& grid : grids) {
    load.selection = parse_grid_selection(grid);
    take(load_fields(options.input, load));
  }
  return loaded;
}

void run(const ConvertOptions& options) {
  volume_format(options.output);
  if (options.all && !options.grids.empty()) {
    fail("--all and --grid say which grids are converted twice; give one or the other");
  }
  if (!(options.scale > 0)) fail("--scale: {} is not above 0", options.scale);
  if (options.effective_radius < 0) {
    fail("--effective-radius: {} is below 0", options.effective_radius);
  }
  AtomicFile file(options.output);  // before the time is spent
  std::vector<LoadedField> loaded = load_chosen(options);
  if (!options.name.empty() && loaded.size() != 1) {
    fail("--name: {} fields would have it; convert one", loaded.size());
  }
  std::vector<Field> fields;
  fields.reserve(loaded.size());
  for (LoadedField& one : loaded) {
    for (const std::string& warning : one.warnings) warn("{}", warning);
    fields.push_back(converted(options, one));
    if (!options.name.empty()) fields.back().name = options.name;
  }
  std::vector<const Field*> pointers;
  pointers.reserve(fields.size());
  for (const Field& field : fields) pointers.push_back(&field);
  write_volume(file, pointers, {.half = options.half});
}

void add_raw_options(CLI::App& command, ConvertOptions& o) {
  constexpr const char* kGroup = "Raw values (IN has no header)";
  CLI::Option* const size =
      command.add_option("--raw-size", o.raw_size, "Voxels along each axis: X,Y,Z")->group(kGroup);
  const auto add = [&](const char* name, auto& target, const char* text) {
    return command.add_option(name, target, text)->group(kGroup)->needs(size);
  };
  add("--raw-type", o.raw_type,
      "int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32 or float64")
      ->capture_default_str();
  add("--raw-order", o.raw_order, "Order of the bytes in a number: little or big")
      ->capture_default_str();
  add("--raw-offset", o.raw_offset, "Bytes before the first value [0]")->check(kWholeNumber);
  add("--raw-spacing", o.raw_spacing, "Steps between voxels, one or X,Y,Z [1]");
  add("--raw-origin", o.raw_origin, "Position of the first voxel's centre, X,Y,Z [0,0,0]");
}

}  // namespace

void add_convert_command(CLI::App& program) {
  auto options = std::make_shared<ConvertOptions>();
  ConvertOptions& o = *options;
  CLI::App* const command =
      program.add_subcommand("convert", "Write a volume in another format, scale or unit");
  command->footer(kConvertFooter);
  command->add_option("IN", o.input, "Volume file of any format that is read")->required();
  command->add_option("OUT", o.output, "File to write (.vdb, .nvdb, .vti)")->required();
  command->add_option("--grid", o.grids, "Grid to convert, by name or number; again for another")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_flag("--all", o.all, "Convert all grids that can be densities");
  command->add_option("--name", o.name, "Name of the grid in OUT");
  command->add_option("--scale", o.scale, "Multiplies the values [1]")->check(kFiniteNumber);
  command->add_option("--unit", o.unit, "Unit of positions in OUT: m, km, cm, mm or um");
  command->add_option("--input-unit", o.input_unit, "Unit of positions in IN, if it tells none");
  command->add_flag("--half", o.half, "Store values in 16 bits (.vdb, .nvdb)");
  command
      ->add_option("--effective-radius", o.effective_radius,
                   "Radius of droplets where a NetCDF file has none [um]")
      ->check(kFiniteNumber);
  command->add_option("--negative", o.negative, "Negative densities: error or clamp")
      ->capture_default_str();
  command->add_option("--invalid", o.invalid, "Voxels that are NaN or infinite: error or zero")
      ->capture_default_str();
  add_raw_options(*command, o);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
