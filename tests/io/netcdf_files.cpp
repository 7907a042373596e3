#include "tests/io/netcdf_files.h"

#include <cstddef>

#include "freepath/base/error.h"

namespace freepath::testing_volumes {
namespace {

void check(int status) {
  if (status != NC_NOERR) throw Error(nc_strerror(status));
}

}  // namespace

void write_netcdf(const std::filesystem::path& path, const std::vector<CloudVariable>& variables,
                  int mode) {
  int file = 0;
  check(nc_create(path.c_str(), NC_CLOBBER | mode, &file));
  const std::pair<const char*, std::size_t> sizes[] = {
      {"time", NC_UNLIMITED}, {"z", kNz}, {"y", kNy}, {"x", kNx}};
  for (const auto& [name, size] : sizes) {
    int id = 0;
    check(nc_def_dim(file, name, size, &id));
  }
  std::vector<int> ids;
  for (const CloudVariable& variable : variables) {
    std::vector<int> dimensions;
    for (const std::string& name : variable.dimensions) {
      dimensions.emplace_back();
      check(nc_inq_dimid(file, name.c_str(), &dimensions.back()));
    }
    ids.emplace_back();
    check(nc_def_var(file, variable.name.c_str(), variable.type,
                     static_cast<int>(dimensions.size()), dimensions.data(), &ids.back()));
    for (const auto& [name, text] : variable.texts) {
      nc_put_att_text(file, ids.back(), name.c_str(), text.size(), text.c_str());
    }
    for (const auto& [name, number] : variable.numbers) {
      nc_put_att_double(file, ids.back(), name.c_str(),
                        name == "_FillValue" ? variable.type : NC_DOUBLE, 1, &number);
    }
  }
  check(nc_enddef(file));
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const std::vector<std::size_t> first(variables[i].dimensions.size(), 0);
    std::vector<std::size_t> counts;
    for (const std::string& name : variables[i].dimensions) {
      counts.push_back(name == "time" ? kTimes : name == "z" ? kNz : name == "y" ? kNy : kNx);
    }
    check(
        nc_put_vara_double(file, ids[i], first.data(), counts.data(), variables[i].values.data()));
  }
  check(nc_close(file));
}

std::vector<double> sampled(const std::function<double(int, int, int, int)>& f) {
  std::vector<double> values;
  for (int t = 0; t < kTimes; ++t) {
    for (int z = 0; z < kNz; ++z) {
      for (int y = 0; y < kNy; ++y) {
        for (int x = 0; x < kNx; ++x) values.push_back(f(t, z, y, x));
      }
    }
  }
  return values;
}

double water(int t, int z, int y, int x) { return 1e-4 * (1 + t + 2 * x + 3 * y + 5 * z); }
double radius(int /*t*/, int z, int /*y*/, int /*x*/) { return 5e-6 + 1e-6 * z; }
double extinction(int t, int z, int y, int x) {
  return 1.5 * water(t, z, y, x) / (1000 * radius(t, z, y, x));
}

std::vector<double> even(int count, double first, double step) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(first + step * i);
  return values;
}

std::vector<CloudVariable> cloud() {
  return {{"time", {"time"}, {0, 60}, {{"units", "seconds since 2000-01-01"}}},
          {"x", {"x"}, even(kNx, 100, 50), {{"units", "m"}}},
          {"y", {"y"}, even(kNy, 0.2, 0.025), {{"units", "km"}}},
          {"z", {"z"}, even(kNz, 300, 40), {{"units", "meters"}}},
          {"lwc", {"time", "z", "y", "x"}, sampled(water), {{"units", "kg m-3"}}},
          {"re",
           {"time", "z", "y", "x"},
           sampled([](int t, int z, int y, int x) { return 1e6 * radius(t, z, y, x); }),
           {{"units", "um"}}}};
}

}  // namespace freepath::testing_volumes
