#include <unistd.h>

#include <cstring>
#include <exception>

#include "apps/freepath/run.h"

namespace {

/// Libraries start threads of their own when they are loaded, and throw where they get none.
[[noreturn]] void end_before_the_beginning() {
  constexpr const char* kMessage =
      "freepath: error: it can't start: a library that it needs found too few threads or too "
      "little "
      "memory; raise the limits (ulimit -u, ulimit -v, a container's)\n";
  if (write(STDERR_FILENO, kMessage, std::strlen(kMessage)) < 0) _exit(2);
  _exit(1);
}

void before_libraries() { std::set_terminate(end_before_the_beginning); }

/// Called before the constructors of libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const kBeforeLibraries)() = before_libraries;

}  // namespace

int main(int argc, char** argv) { return freepath::program::run(argc, argv); }
