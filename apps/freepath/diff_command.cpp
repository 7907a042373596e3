#include "apps/freepath/commands.h"

namespace freepath::program {

void add_diff_command(CLI::App&) {}

}  // namespace freepath::program
