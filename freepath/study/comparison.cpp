#include "freepath/study/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/study/comparison_evaluation.h"
#include "freepath/study/flip.h"
#include "freepath/study/process_time.h"
#include "freepath/study/run_seed.h"

namespace freepath {
namespace {

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

RenderSettings settings_of(const ComparisonSettings& settings, const Configuration& configuration) {
  RenderSettings render = settings.render;
  render.walk.tracker = configuration.tracker;
  render.walk.transmittance = configuration.transmittance;
  render.walk.interpolation = configuration.interpolation;
  render.whole_passes = true;
  render.studies_unbounded_weights = true;  // the report tells heavy tails
  render.layers = {Layer::kVariance, Layer::kSamples, Layer::kLookups};
  return render;
}

/// Renders a pixel, so that what can't work is known at once.
void try_configuration(const RenderTarget& target, const ComparisonSettings& settings,
                       const Configuration& configuration) {
  RenderSettings render = settings_of(settings, configuration);
  render.samples = 1;
  render.crop = Crop{.x0 = 0, .y0 = 0, .x1 = 1, .y1 = 1};
  target.render(render, {});
}

/// The configurations as they can be run.
std::vector<Configuration> tried_configurations(const RenderTarget& target,
                                                const ComparisonSettings& settings) {
  std::vector<Configuration> configurations = settings.configurations;
  for (Configuration& configuration : configurations) {
    try {
      try_configuration(target, settings, configuration);
    } catch (const Error& error) {
      const std::string reason = error.what();
      if (!settings.may_interpolate || configuration.interpolation != Interpolation::kStochastic) {
        fail("{}: {}", configuration.tracker, reason);
      }
      configuration.interpolation = Interpolation::kTrilinear;
      try {
        try_configuration(target, settings, configuration);
      } catch (const Error&) {
        fail("{}: {}", configuration.tracker, reason);
      }
    }
  }
  return configurations;
}

/// Runs, and what they leave behind until all are done.
class Experiment {
 public:
  Experiment(const RenderTarget& target, const ComparisonSettings& settings,
             const ComparisonProgressFunction& progress)
      : target_(target), settings_(settings), progress_(progress) {}

  Comparison run() {
    prepare();
    for (int repeat = settings_.first_round; repeat < end_round(); ++repeat) {
      const std::size_t count = configurations_.size();
      for (std::size_t i = 0; i < count; ++i) {
        run_once((i + static_cast<std::size_t>(repeat)) % count, repeat);
      }
    }
    result_.level = settings_.level;
    evaluate(result_);
    result_.seconds = clock_.seconds();
    return std::move(result_);
  }
  std::vector<Reference> references() {
    prepare();
    return std::move(result_.references);
  }

 private:
  /// Errors of a film as it grows, and the time that finding them took.
  struct Watch {
    std::vector<ConvergencePoint> points;
    double seconds = 0, cpu_seconds = 0;
    uint32_t samples = 0;
  };

  void prepare() {
    configurations_ = tried_configurations(target_, settings_);
    name_configurations();
    get_references();
  }
  int end_round() const {
    return settings_.end_round > 0 ? settings_.end_round : settings_.repeats;
  }
  void name_configurations();
  void get_references();
  Reference reference_by_plan(const Configuration& standard);
  void run_once(std::size_t which, int repeat);
  /// Takes in the errors of a run's picture, and the picture itself.
  void take_picture(std::size_t which, ComparisonRun& run, PixelEstimates picture);
  /// Looks at a film whenever it has twice the samples that it had.
  std::function<void(const Film&)> watcher(std::size_t which, Watch& watch,
                                           const Clock& clock) const;

  void report(const std::string& step, double fraction) {
    if (progress_ && !progress_({step, fraction, clock_.seconds()})) {
      throw Interrupted("interrupted: nothing is written");
    }
  }
  /// Tells of a rendering that does a part of the work and has a time to end.
  ProgressFunction progress_of(const std::string& step, double begin, double part, double time) {
    return [this, step, begin, part, time](const RenderProgress& rendering) {
      if (!progress_) return true;
      double done = time > 0 ? rendering.seconds / time : 0;
      if (rendering.samples_total > 0) {
        done = std::max(done, rendering.samples_done / rendering.samples_total);
      }
      return progress_({step, begin + part * std::min(1.0, done), clock_.seconds()});
    };
  }
  /// Share of the work that references take, by time or samples, whichever both are given in.
  double reference_share() const {
    if (!settings_.reference.file.empty() || !settings_.references.empty()) return 0;
    const auto share = [&](double reference, double run) {
      return reference / (reference + run * static_cast<double>(configurations_.size()));
    };
    if (settings_.time > 0 && settings_.reference.time > 0) {
      return share(settings_.reference.time, settings_.time);
    }
    if (settings_.samples > 0 && settings_.reference.samples > 0) {
      return share(settings_.reference.samples, settings_.samples);
    }
    constexpr double kGuess = 0.2;
    return kGuess;
  }

  const RenderTarget& target_;
  const ComparisonSettings& settings_;
  const ComparisonProgressFunction& progress_;
  std::vector<Configuration> configurations_;
  Clock clock_;
  Comparison result_;
};

void Experiment::name_configurations() {
  const std::vector<Configuration>& all = configurations_;
  const auto differs = [&](auto part) {
    return std::any_of(all.begin(), all.end(), [&](const Configuration& configuration) {
      return configuration.*part != all.front().*part;
    });
  };
  const bool trackers = differs(&Configuration::tracker);
  const bool transmittances = differs(&Configuration::transmittance);
  // Stochastic interpolation goes without saying, unless both are run.
  const auto has_twin = [&](const Configuration& configuration) {
    return std::any_of(all.begin(), all.end(), [&](const Configuration& other) {
      return other.tracker == configuration.tracker &&
             other.transmittance == configuration.transmittance &&
             other.interpolation != configuration.interpolation;
    });
  };
  for (const Configuration& configuration : all) {
    std::string name;
    const auto append = [&](bool wanted, std::string_view part) {
      if (wanted) name += (name.empty() ? "" : " · ") + std::string(part);
    };
    append(trackers || !transmittances, configuration.tracker);
    append(transmittances, configuration.transmittance);
    append(configuration.interpolation != Interpolation::kStochastic || has_twin(configuration),
           to_string(configuration.interpolation));
    ConfigurationResult result;
    result.configuration = configuration;
    result.name = name;
    result.is_biased = is_biased(configuration);
    result_.configurations.push_back(std::move(result));
  }
  const auto delta = std::find_if(all.begin(), all.end(), [](const Configuration& configuration) {
    return configuration.tracker == "delta";
  });
  result_.baseline = delta == all.end() ? 0 : static_cast<std::size_t>(delta - all.begin());
}

void Experiment::get_references() {
  // Drawing one voxel by its trilinear weight shows the same field on average.
  std::optional<std::size_t> nearest;
  std::optional<std::size_t> trilinear;
  for (const Configuration& configuration : configurations_) {
    const bool is_nearest = configuration.interpolation == Interpolation::kNearest;
    std::optional<std::size_t>& index = is_nearest ? nearest : trilinear;
    if (!index) {
      index = result_.references.size();
      Configuration standard;
      if (is_nearest) standard.interpolation = Interpolation::kNearest;
      if (nearest && trilinear && !settings_.reference.file.empty()) {
        fail(
            "{}: one picture can't be the reference of nearest and of other interpolations, whose "
            "fields differ",
            settings_.reference.file);
      }
      result_.references.push_back(*index < settings_.references.size()
                                       ? settings_.references[*index]
                                       : reference_by_plan(standard));
    }
    result_.reference_of.push_back(*index);
  }
}

Reference Experiment::reference_by_plan(const Configuration& standard) {
  Reference reference =
      get_reference(target_, settings_.reference, standard, settings_.render,
                    progress_of("reference", 0, reference_share(), settings_.reference.time));
  if (reference.estimates.mean.empty()) throw Interrupted("interrupted: nothing is written");
  return reference;
}

std::function<void(const Film&)> Experiment::watcher(std::size_t which, Watch& watch,
                                                     const Clock& clock) const {
  const PixelEstimates& reference = result_.reference(which).estimates;
  return [&](const Film& film) {
    const uint32_t samples = film.sample_counts().fewest;
    if (samples < std::max(1U, 2 * watch.samples)) return;
    watch.samples = samples;
    const double begin = clock.seconds();
    const double cpu_begin = process_cpu_seconds();
    const double mse = squared_error(colours_of(film), reference).mse;
    watch.points.push_back({samples, begin - watch.seconds, mse});
    watch.seconds += clock.seconds() - begin;
    watch.cpu_seconds += process_cpu_seconds() - cpu_begin;
  };
}

void Experiment::run_once(std::size_t which, int repeat) {
  ConfigurationResult& result = result_.configurations[which];
  RenderSettings render = settings_of(settings_, result.configuration);
  render.walk.seed = run_seed(settings_.seed, which, repeat);
  render.time_limit = settings_.time / settings_.repeats;
  render.samples = (settings_.samples + settings_.repeats - 1) / settings_.repeats;
  const int rounds = end_round() - settings_.first_round;
  const auto runs = static_cast<double>(configurations_.size() * rounds);
  const double done =
      static_cast<double>(repeat - settings_.first_round) * result_.configurations.size() +
      static_cast<double>(
          (which + result_.configurations.size() - repeat % result_.configurations.size()) %
          result_.configurations.size());
  const double share = reference_share();
  const std::string step =
      fmt::format("{}, run {} of {}", result.name, repeat + 1, settings_.repeats);
  const double begin = share + (1 - share) * done / runs;
  report(step, begin);
  const Clock clock;
  Watch watch;
  render.on_pass = watcher(which, watch, clock);
  const double cpu_before = process_cpu_seconds();
  const RenderResult rendered =
      target_.render(render, progress_of(step, begin, (1 - share) / runs, render.time_limit));
  ComparisonRun run;
  run.cpu_seconds = process_cpu_seconds() - cpu_before - watch.cpu_seconds;
  if (rendered.interrupted) throw Interrupted("interrupted: nothing is written");
  run.seconds = rendered.seconds - watch.seconds;
  run.samples = rendered.samples;
  run.camera_samples = uint64_t{rendered.samples} * target_.width * target_.height;
  run.overflows = rendered.counts.overflows;
  run.free_paths = rendered.counts.free_paths;
  run.shadow_rays = rendered.counts.shadow_rays;
  run.convergence = std::move(watch.points);
  take_picture(which, run, estimates_of(rendered.film));
  result.runs.push_back(std::move(run));
}

void Experiment::take_picture(std::size_t which, ComparisonRun& run, PixelEstimates picture) {
  ConfigurationResult& result = result_.configurations[which];
  const PixelEstimates& reference = result_.reference(which).estimates;
  run.error = squared_error(picture.mean, reference);
  for (std::size_t i = 0; i < picture.variance.size(); ++i) {
    run.variance[i % 3] += picture.variance[i] / static_cast<double>(picture.pixel_count());
  }
  std::vector<float> differences =
      high_range_flip(reference.mean, picture.mean, picture.width, picture.height);
  run.flip = std::accumulate(differences.begin(), differences.end(), 0.0) /
             static_cast<double>(differences.size());
  if (result.runs.empty()) {
    result.flip = std::move(differences);
    result.together = picture;
    result.first = std::move(picture);
  } else {
    result.together = merged({&result.together, &picture});
  }
}

void check_settings(const ComparisonSettings& settings) {
  if (settings.configurations.empty()) fail("nothing to compare: no methods are given");
  if (settings.repeats < 1) fail("nothing to compare: {}", counted(settings.repeats, "repeat"));
  if (settings.time <= 0 && settings.samples == 0) {
    fail("nothing to compare: neither a time nor samples are given");
  }
  if (settings.samples > 0 && settings.samples < 2U * settings.repeats) {
    fail("{} for {}: each needs two at least, to know its variance",
         counted(settings.samples, "sample"), counted(settings.repeats, "repeat"));
  }
}

}  // namespace

Comparison compare(const RenderTarget& target, const ComparisonSettings& settings,
                   const ComparisonProgressFunction& progress) {
  check_settings(settings);
  return Experiment(target, settings, progress).run();
}

std::vector<Reference> references_of(const RenderTarget& target, const ComparisonSettings& settings,
                                     const ComparisonProgressFunction& progress) {
  check_settings(settings);
  return Experiment(target, settings, progress).references();
}

}  // namespace freepath
