# Called by ctest with BUILD and READELF set: the programs and libraries of the build.
include(${CMAKE_CURRENT_LIST_DIR}/run_paths_check.cmake)
file(GLOB built ${BUILD}/bin/* ${BUILD}/lib*/*.so*)
check_run_paths("$ORIGIN" ${built})
