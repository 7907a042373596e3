# Every library comes from Debian 12's packages (scripts/setup installs them).
include(freepath_library_dependencies)
find_package(Boost REQUIRED)  # Math, headers alone
find_package(embree 3 REQUIRED)
pkg_check_modules(netcdf REQUIRED IMPORTED_TARGET netcdf)
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
if(FREEPATH_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(FREEPATH_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
