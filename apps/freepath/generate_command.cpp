// freepath generate: procedural volumes, written to a file.

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "freepath/base/error.h"
#include "freepath/io/volume_write.h"
#include "freepath/scene/procedural.h"

namespace freepath::program {
namespace {

constexpr const char* kGenerateFooter =
    R"(Kinds:
  cloud     a cumulus with a flat base; field density, 0 to 1
  smoke     a rising column; field density, 0 to 1
  fireball  an explosion; fields density, 0 to 1, and temperature, 300 to 3000 K
  fog       a bank that is dense everywhere, 0.55 to 1; field density
  noise     a ball of voxels that have nothing to do with each other; field density, 0 to 1
  puffs     two round puffs far apart, the same at any resolution; field density, 0 to 1

The longest side is 100 units of the world, up is +y, the volume stands on y = 0. The same seed and
resolution give the same file on any number of threads.

Examples:
  freepath generate cloud -o cloud.vdb
  freepath generate smoke -o smoke.vdb --resolution 512 --seed 3
  freepath generate fireball -o fireball.vdb --half)";

using Generator = std::vector<Field> (*)(const ProceduralOptions&);
const std::map<std::string, Generator> kGenerators{
    {"cloud", generate_cloud}, {"smoke", generate_smoke}, {"fireball", generate_fireball},
    {"fog", generate_fog},     {"noise", generate_noise}, {"puffs", generate_puffs}};

struct GenerateOptions {
  std::string kind, output;
  ProceduralOptions volume;
  bool half = false;
};

void show_progress(double fraction) {
  show_status(fmt::format("sampling {:3.0f} %", 100 * fraction));
}

void run(GenerateOptions& options) {
  if (std::filesystem::path(options.output).extension() != ".vdb") {
    fail("{}: a volume is written as OpenVDB; give the file a name that ends in .vdb",
         options.output);
  }
  AtomicFile file(options.output);  // before the time is spent
  options.volume.progress = show_progress;
  const std::vector<Field> fields = kGenerators.at(options.kind)(options.volume);
  clear_status();
  std::vector<const Field*> pointers;
  pointers.reserve(fields.size());
  for (const Field& field : fields) pointers.push_back(&field);
  write_vdb(file, pointers, {.half = options.half});
}

}  // namespace

void add_generate_command(CLI::App& program) {
  auto options = std::make_shared<GenerateOptions>();
  CLI::App* const command =
      program.add_subcommand("generate", "Make a procedural volume and write it to a .vdb file");
  command->footer(kGenerateFooter);
  command->add_option("KIND", options->kind, "cloud, smoke, fireball, fog, noise or puffs")
      ->required()
      ->check(CLI::IsMember(kGenerators));
  command->add_option("-o,--output", options->output, "File to write (.vdb)")->required();
  command
      ->add_option("--resolution", options->volume.resolution,
                   "Voxels along the longest side, 16 to 2048")
      ->capture_default_str();
  command->add_option("--seed", options->volume.seed, "Another seed, another volume")
      ->capture_default_str()
      ->check(kWholeNumber);
  command->add_flag("--half", options->half, "Store values in half precision");
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
