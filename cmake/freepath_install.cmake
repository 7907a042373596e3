# cmake --install: the library and its headers, found elsewhere by find_package(freepath CONFIG), and
# the program.
include(CMakePackageConfigHelpers)

add_library(freepath_freepath INTERFACE)
target_link_libraries(freepath_freepath INTERFACE freepath_transport freepath_io)

foreach(target base media tracking transport io freepath options)
  set_target_properties(freepath_${target} PROPERTIES EXPORT_NAME ${target})
  list(APPEND freepath_installed freepath_${target})
endforeach()
install(TARGETS ${freepath_installed} EXPORT freepath_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS freepath RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS freepath_images freepath_netcdf LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(room base media tracking transport io)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/freepath/${room}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/freepath
          FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE PATTERN "trackers" EXCLUDE
          PATTERN "transmittance" EXCLUDE)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/freepath/base/version.h
              ${PROJECT_BINARY_DIR}/generated/freepath/base/build_options.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/freepath/base)

set(freepath_package ${CMAKE_INSTALL_LIBDIR}/cmake/freepath)
install(EXPORT freepath_targets NAMESPACE freepath:: DESTINATION ${freepath_package})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/freepathConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/generated/freepathConfig.cmake
                              INSTALL_DESTINATION ${freepath_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/freepathConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/freepathConfig.cmake
              ${PROJECT_BINARY_DIR}/generated/freepathConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/freepath_library_dependencies.cmake
        DESTINATION ${freepath_package})
