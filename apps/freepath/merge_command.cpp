// freepath merge: parts of a picture made one, and pictures of different seeds averaged.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/film_options.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/render_output.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/paths/film_merge.h"

namespace freepath::program {
namespace {

constexpr const char* kMergeFooter =
    R"(Parts are .film files, which `freepath render` writes with -o PART.film or --checkpoint: ranges
of samples (--samples 0-63), tiles (--tiles 1/8), crops, in any combination and from any machines.
What they become has the bits of the picture of one process. Parts that overlap, leave a gap, or are
of another scene, seed, option or version are refused by name.

With --average, pictures of different --seed are averaged, each pixel weighted by its samples; the
layers variance and samples are those of all.

The result is written as by `freepath render`: an .exr with all layers that the parts have, a .png,
.pfm or .qoi of the colour, or another .film, to be merged or gone on with.

Examples:
  freepath render cloud.vdb --samples 0-63 -o a.film
  freepath render cloud.vdb --samples 64-127 -o b.film
  freepath merge a.film b.film -o cloud.exr -o cloud.png
  freepath merge tile.*.film -o cloud.film --partial
  freepath merge seed1.film seed2.film -o both.exr --average)";

struct MergeCommandOptions {
  std::vector<std::string> parts, outputs;
  MergeOptions merge;
  std::string stats;
  FilmOptions film;
  double exposure = 0;
  std::string view;
};

/// The report of a part, from what rendering noted in its film.
RenderReport report_of(const FilmHeader& header, PictureLook& look) {
  RenderReport report;
  report.settings.walk.seed = header.identity.seed;
  try {
    const nlohmann::json notes = nlohmann::json::parse(header.notes);
    look.view = static_cast<ViewTransform>(notes.at("view").get<int>());
    for (const nlohmann::json& entry : notes.at("metadata")) {
      const nlohmann::json& value = entry.at(1);
      MetadataValue read;
      if (value.is_string()) {
        read = value.get<std::string>();
      } else if (value.is_array()) {
        Matrix4d matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = value.at(i);
        read = matrix;
      } else if (value.is_number_integer()) {
        read = value.get<int64_t>();
      } else {
        read = value.get<double>();
      }
      report.metadata.emplace_back(entry.at(0).get<std::string>(), read);
    }
  } catch (const nlohmann::json::exception&) {
    // A film that another program than `render` has written has its sums alone.
    report.metadata.clear();
  }
  for (const auto& [name, value] : header.identity.facts) {
    if (name == "tracker") report.settings.walk.tracker = value;
    if (name == "transmittance") report.settings.walk.transmittance = value;
  }
  return report;
}

void run(const MergeCommandOptions& options) {
  if (options.outputs.empty()) {
    fail("-o, --output is required: the picture to write, .exr, .png, .pfm, .qoi or .film");
  }
  for (const std::string& output : options.outputs) check_output(output);
  check_statistics_file(options.stats, options.outputs, options.parts);
  FilmPlan film = read_film_options(options.film);
  PictureFilesAside aside(options.outputs, options.stats);
  FilmFile merged = merge_films(options.parts, options.merge);
  PictureLook look{.exposure = options.exposure};
  RenderReport report = report_of(merged.header, look);
  if (!options.view.empty()) look.view = read_view(options.view);
  if (!film.layers) film.layers = merged.header.layers;
  if (film.denoiser && !merged.header.layers.has(Layer::kNormal)) {
    fail(
        "--denoise looks at the layer normal, which the parts do not have; render them with "
        "--layers default,normal");
  }
  RenderResult result{.film = std::move(merged.film)};
  result.counts = merged.header.counts;
  result.seconds = report.seconds_render = merged.header.seconds;
  const Film::SampleCounts samples = result.film.sample_counts();
  result.samples = samples.fewest;
  result.most_samples = samples.most;
  // What is missing by --partial is what was asked for.
  const std::vector<std::string> written =
      aside.write({look, film, nullptr, &merged.header}, result, report);
  tell("merged {}: {} per pixel, {:.1f} s of rendering\n", counted(options.parts.size(), "part"),
       samples_text(result), result.seconds);
  if (samples.pixels_without > 0) {
    warn("{} of {} pixels have no sample: black with alpha 0", samples.pixels_without,
         result.film.pixel_count());
  }
  for (const std::string& file : written) tell("wrote {}\n", file);
  require_no_overflows(result);
}

}  // namespace

void add_merge_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("merge", "Merge the parts of a picture, or average pictures");
  const auto options = std::make_shared<MergeCommandOptions>();
  command->add_option("part", options->parts, "Films to merge, .film")->required();
  command
      ->add_option("-o,--output", options->outputs,
                   "Picture to write, .exr, .png, .pfm, .qoi or .film; may be repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_flag("--average", options->merge.average, "Average pictures of different seeds");
  command->add_flag("--partial", options->merge.partial,
                    "Take what there is where parts are missing");
  command->add_option("--stats", options->stats, "Write statistics to a JSON file");
  command->add_option("--layers", options->film.layers,
                      "Layers of an .exr, as of `freepath render` [those of the parts]");
  add_exr_option(*command, options->film.exr);
  command->add_flag("--denoise", options->film.denoise,
                    "Denoise the colour by Open Image Denoise, where that is installed");
  command->add_option("--exposure", options->exposure, "Exposure of a .png or .qoi [stops]")
      ->capture_default_str()
      ->check(kFiniteNumber);
  command->add_option("--view", options->view,
                      "View transform of a .png: standard or neutral [that of the parts]");
  command->footer(kMergeFooter);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
