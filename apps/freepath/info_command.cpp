#include "apps/freepath/commands.h"

namespace freepath::program {

void add_info_command(CLI::App&) {}

}  // namespace freepath::program
