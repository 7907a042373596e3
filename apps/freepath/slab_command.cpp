#include "apps/freepath/commands.h"

namespace freepath::program {

void add_slab_command(CLI::App&) {}

}  // namespace freepath::program
