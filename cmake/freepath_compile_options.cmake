# What every target of the project is compiled with. Linked as freepath_options.
add_library(freepath_options INTERFACE)
target_compile_features(freepath_options INTERFACE cxx_std_20)
# No contraction by the compiler's choice: a fused multiply-add is written as one (MulAdd), so that
# AVX2 and AVX-512 round alike and a picture does not depend on the machine that made it.
target_compile_options(freepath_options INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra
                       $<$<BOOL:${FREEPATH_WARNINGS_AS_ERRORS}>:-Werror>)
# A program loads only the libraries that it calls: OpenImageIO alone brings 250 others, which take
# longer to load than most tests to run.
target_link_options(freepath_options INTERFACE -Wl,--as-needed)
if(FREEPATH_SANITIZE)
  target_compile_options(freepath_options INTERFACE -fsanitize=${FREEPATH_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(freepath_options INTERFACE -fsanitize=${FREEPATH_SANITIZE})
endif()
