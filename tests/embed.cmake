# Installs the library, builds examples/embed against it outside of the build tree, and runs it.
# Called by ctest with BUILD, SOURCE, WORK, GENERATOR and READELF set.
include(${CMAKE_CURRENT_LIST_DIR}/run_paths_check.cmake)
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN} failed:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
file(GLOB_RECURSE installed ${WORK}/prefix/bin/* ${WORK}/prefix/*.so*)
check_run_paths("$ORIGIN" ${installed})

# The generator that built the library: no other need be installed.
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/examples/embed -B ${WORK}/embed
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix)
if(output MATCHES "Found|OpenVDB|COMPONENT")
  message(FATAL_ERROR "find_package(freepath) prints:\n${output}")
endif()
run(${CMAKE_COMMAND} --build ${WORK}/embed)
check_run_paths(${WORK}/prefix ${WORK}/embed/embed)
run(${WORK}/prefix/bin/freepath generate cloud -o ${WORK}/cloud.vdb --resolution 32)
set(render ${WORK}/prefix/bin/freepath render ${WORK}/cloud.vdb --size 8x8 --spp 1 -o)
run(${render} ${WORK}/cloud.exr)
if(NOT EXISTS ${WORK}/cloud.exr)
  message(FATAL_ERROR "the installed program wrote no picture")
endif()
run(${WORK}/embed/embed ${WORK}/cloud.vdb)
message("${output}")
# exp(-1.7642) = 0.1713 by both estimates; the standard errors are at most 0.0012
if(NOT output MATCHES "gaussian: 0\\.1(6[7-9]|7[0-5])[0-9] of the paths escape, transmittance 0\\.1(6[7-9]|7[0-5])")
  message(FATAL_ERROR "the gaussian's transmittance is not 0.1713")
endif()

run(${CMAKE_COMMAND} -E touch ${WORK}/damaged.vdb)
execute_process(COMMAND ${WORK}/embed/embed ${WORK}/damaged.vdb RESULT_VARIABLE result
                ERROR_VARIABLE output)
if(NOT result EQUAL 1 OR NOT output MATCHES "damaged.vdb")
  message(FATAL_ERROR "an empty file ended with ${result}: ${output}")
endif()

# Pictures are written without the library that reads them, and are not read without it.
set(program ${render})
list(GET program 0 program)
set(diff ${program} diff ${WORK}/cloud.exr ${WORK}/cloud.exr)
run(${diff})
file(GLOB_RECURSE images ${WORK}/prefix/libfreepath_images.so)
file(REMOVE ${images})
run(${render} ${WORK}/again.exr)
execute_process(COMMAND ${diff} RESULT_VARIABLE result ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "can't load the library that reads images")
  message(FATAL_ERROR "without its library of images the program ended with ${result}: ${output}")
endif()
