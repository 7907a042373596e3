#pragma once
/// @file NetCDF files of clouds, for tests.

#include <netcdf.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace freepath::testing_volumes {

inline constexpr int kTimes = 2, kNx = 5, kNy = 4, kNz = 6;

/// A variable to be written.
struct CloudVariable {
  std::string name;
  std::vector<std::string> dimensions;
  std::vector<double> values;
  std::vector<std::pair<std::string, std::string>> texts{};
  std::vector<std::pair<std::string, double>> numbers{};
  nc_type type = NC_DOUBLE;
};

/// Writes a file with variables along dimensions time, z, y and x; times are records where the
/// format has them.
/// @param mode of nc_create
/// @throws Error with NetCDF's reason
void write_netcdf(const std::filesystem::path& path, const std::vector<CloudVariable>& variables,
                  int mode = NC_NETCDF4);

/// Values of a function over (time, z, y, x).
std::vector<double> sampled(const std::function<double(int, int, int, int)>& f);
/// Values from a first one on, evenly spaced.
std::vector<double> even(int count, double first, double step);

/// Liquid water of the cloud at a sample [kg/m³].
double water(int t, int z, int y, int x);
/// Effective radius there [m].
double radius(int t, int z, int y, int x);
/// What they mean [1/m]: 3/2 LWC/(ρ_w r_e) with ρ_w = 1000 kg/m³.
double extinction(int t, int z, int y, int x);

/// A cloud with x and z in m, y in km; lwc in kg/m³ and re in µm.
std::vector<CloudVariable> cloud();

}  // namespace freepath::testing_volumes
