# What the library needs, in the build and where the installed library is used. Every package is
# Debian 12's.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(Imath REQUIRED)
find_package(fmt REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(OpenImageIO REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)
find_package(pugixml REQUIRED)
list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_CXX_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
find_package(OpenVDB REQUIRED)

# Debian's OpenImageIO names the headers of optional libraries that need not be installed.
get_target_property(openimageio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
foreach(folder ${openimageio_includes})
  if(NOT EXISTS ${folder})
    list(REMOVE_ITEM openimageio_includes ${folder})
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES
                      "${openimageio_includes}")
