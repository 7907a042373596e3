#include "apps/freepath/commands.h"

namespace freepath::program {

void add_generate_command(CLI::App&) {}

}  // namespace freepath::program
