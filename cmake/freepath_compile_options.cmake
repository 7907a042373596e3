# What every target of the project is compiled with. Linked as freepath_options.
add_library(freepath_options INTERFACE)
target_compile_features(freepath_options INTERFACE cxx_std_20)
# No contraction by the compiler's choice: SSE4 and one lane can't fuse a multiplication and an addition,
# and a picture does not depend on the machine that made it.
target_compile_options(freepath_options INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra
                       $<$<BOOL:${FREEPATH_WARNINGS_AS_ERRORS}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # Where short strings are joined, GCC 12 warns without cause (its bug 105651).
  target_compile_options(freepath_options INTERFACE -Wno-restrict)
endif()
# Collecting garbage below a gigabyte costs the compiler a tenth of its time.
target_compile_options(freepath_options INTERFACE
                       $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # The string instruction that GCC clears structs of some hundred bytes with takes as long as a random
  # number. (Not of builds that clang-tidy reads, which does not know the option.)
  target_compile_options(
    freepath_options
    INTERFACE $<$<CONFIG:Release>:-mmemset-strategy=unrolled_loop:512:noalign,libcall:-1:noalign>)
endif()
# Nobody replaces our functions when the program starts, and only so may GCC put one into another in
# code for any address.
target_compile_options(freepath_options INTERFACE
                       $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
# A program loads only the libraries that it calls.
target_link_options(freepath_options INTERFACE -Wl,--as-needed)
if(FREEPATH_SANITIZE)
  set(flags -fsanitize=${FREEPATH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(FREEPATH_SANITIZE_ONLY)
    # Warnings that come of the sanitizers are not looked at.
    list(APPEND flags -O1 -g1 -Wno-error)
    set(flags "$<$<IN_LIST:$<TARGET_PROPERTY:NAME>,${FREEPATH_SANITIZE_ONLY}>:${flags}>")
  endif()
  target_compile_options(freepath_options INTERFACE "${flags}")
  target_link_options(freepath_options INTERFACE -fsanitize=${FREEPATH_SANITIZE})
endif()
