#include "apps/freepath/run_plan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "apps/freepath/parse.h"
#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "freepath/paths/film_file.h"

namespace freepath::program {
namespace {

namespace fs = std::filesystem;

/// "A<separator>B", two whole numbers.
std::optional<std::array<uint32_t, 2>> two_numbers(std::string_view text, char separator) {
  std::array<uint32_t, 2> numbers{};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, numbers[0]);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != separator) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, numbers[1]);
  if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
  return numbers;
}

SampleRange parse_samples(const std::string& text) {
  constexpr uint32_t kMost = 1U << 30;
  const auto numbers = two_numbers(text, '-');
  if (!numbers || (*numbers)[0] > (*numbers)[1] || (*numbers)[1] >= kMost) {
    fail("--samples: '{}' is not FIRST-LAST, numbers of samples counted from 0, as in 0-63", text);
  }
  return {(*numbers)[0], (*numbers)[1] - (*numbers)[0] + 1};
}

Tile parse_tile(const std::string& text) {
  const auto numbers = two_numbers(text, '/');
  if (!numbers || (*numbers)[0] < 1 || (*numbers)[0] > (*numbers)[1]) {
    fail("--tiles: '{}' is not NUMBER/COUNT, counted from 1, as in 1/8 to 8/8", text);
  }
  return {(*numbers)[0], (*numbers)[1]};
}

constexpr std::array kProgressForms{Choice<ProgressForm>{"auto", ProgressForm::kAutomatic},
                                    Choice<ProgressForm>{"bar", ProgressForm::kBar},
                                    Choice<ProgressForm>{"lines", ProgressForm::kLines},
                                    Choice<ProgressForm>{"json", ProgressForm::kJson},
                                    Choice<ProgressForm>{"none", ProgressForm::kNone}};
constexpr std::array kSeedModes{Choice<bool>{"frame", true}, Choice<bool>{"same", false}};

/// Options that no sample depends on, or of which a film or its identity tells elsewhere.
constexpr std::array<std::string_view, 32> kWithoutInfluence = {
    "help",          "output",         "spp",     "time",          "exposure",
    "view",          "stats",          "frames",  "layers",        "crop",
    "denoise",       "display",        "samples", "tiles",         "resume",
    "checkpoint",    "every",          "noise",   "progress",      "seed-mode",
    "seed",          "skip-existing",  "threads", "batch",         "simd",
    "exr",           "size",           "tracker", "transmittance", "color",
    "interpolation", "max-scatterings"};

/// A value as it is on any machine: of a file its name alone, as its contents count.
std::string portable(const std::string& value) {
  std::error_code error;
  if (!fs::is_regular_file(value, error)) return value;
  return fs::path(value).filename().string();
}

std::vector<std::pair<std::string, std::string>> given_options(const CLI::App& command) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name =
        option->get_lnames().empty() ? option->get_name() : option->get_lnames().front();
    const auto* const known = std::find(kWithoutInfluence.begin(), kWithoutInfluence.end(), name);
    if (known != kWithoutInfluence.end()) continue;
    std::string values;
    for (const std::string& value : option->results()) {
      values += (values.empty() ? "" : " ") + portable(value);
    }
    const bool is_option = !option->get_lnames().empty();
    if (values == option->get_default_str()) continue;
    facts.emplace_back(is_option ? "--" + name : name, values);
  }
  return facts;
}

}  // namespace

void add_run_plan_options(CLI::App& command, RunPlanOptions& o) {
  const auto text = [&](const char* name, std::string& value, const char* help) {
    return command.add_option(name, value, help)->group("Run");
  };
  text(
      "--samples", o.samples,
      "Render the samples FIRST-LAST alone, counted from 0, as in 0-63 and 64-127: parts to merge, "
      "from .film files");
  text("--tiles", o.tiles, "Render the NUMBERth of COUNT tiles alone, as in 1/8 to 8/8");
  text("--checkpoint", o.checkpoint,
       "Save what there is to a .film file now and then, and at the end");
  command.add_option("--every", o.every, "Seconds between checkpoints")
      ->capture_default_str()
      ->check(kFiniteNumber & CLI::PositiveNumber)
      ->group("Run");
  text("--resume", o.resume,
       "Go on with a .film file, if need be to more --spp; where the --checkpoint of the same name "
       "is not there yet, from the start");
  command
      .add_option("--noise", o.noise,
                  "Render as many samples as it takes for the standard error of a pixel, root mean "
                  "square, to be this part of the picture's mean; --spp is the most")
      ->check(CLI::Range(1e-6, 1.0))
      ->group("Run");
  text("--progress", o.progress,
       "How to tell how far it is: bar, lines, json (a line every ten seconds), none, or auto: a "
       "bar "
       "in a terminal, lines elsewhere")
      ->capture_default_str();
  text("--seed-mode", o.seed_mode,
       "Seeds of --frames: frame, where the number of the frame is added to --seed, or same, whose "
       "grain stands still")
      ->capture_default_str();
  command
      .add_flag("--skip-existing", o.skip_existing,
                "Leave out pictures, and frames, of which every file is there already")
      ->group("Run");
}

RunPlan read_run_plan(const CLI::App& command, const RunPlanOptions& options) {
  RunPlan plan;
  if (!options.samples.empty()) plan.samples = parse_samples(options.samples);
  if (!options.tiles.empty()) plan.tile = parse_tile(options.tiles);
  plan.checkpoint = options.checkpoint;
  plan.resume = options.resume;
  for (const auto& [name, file] :
       {std::pair("--checkpoint", plan.checkpoint), std::pair("--resume", plan.resume)}) {
    if (!file.empty() && !is_film_file(file)) {
      fail("{}: '{}' has not the extension of a film, {}", name, file, kFilmExtension);
    }
  }
  plan.every = options.every;
  if (options.noise > 0) plan.noise = options.noise;
  plan.progress = parse_choice(options.progress, "--progress", kProgressForms);
  plan.seed_per_frame = parse_choice(options.seed_mode, "--seed-mode", kSeedModes);
  plan.skip_existing = options.skip_existing;
  plan.options = given_options(command);
  const auto given = [&](const char* name) { return command.count(name) > 0; };
  for (const char* other : {"--spp", "--time", "--noise"}) {
    if (plan.samples && given(other)) {
      fail("--samples and {} both say how many samples; give one of them", other);
    }
  }
  plan.limits_samples = given("--spp");
  if (plan.noise && plan.tile) {
    fail(
        "--noise and --tiles: each tile would choose a number of samples of its own; choose one "
        "by --noise on a small --size, and give it as --spp");
  }
  if (given("--every") && plan.checkpoint.empty()) {
    fail("--every is the time between checkpoints; give their file: --checkpoint FILE.film");
  }
  return plan;
}

PictureIdentity picture_identity(const RunPlan& plan, const RenderSettings& settings,
                                 std::string_view color, const InputFileLog& files) {
  PictureIdentity identity{version(), settings.walk.seed, plan.options};
  identity.add_methods(settings, color);
  identity.add_contents(files.names());
  return identity;
}

}  // namespace freepath::program
