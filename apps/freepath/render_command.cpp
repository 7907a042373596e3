#include "apps/freepath/commands.h"

namespace freepath::program {

void add_render_command(CLI::App&) {}

}  // namespace freepath::program
