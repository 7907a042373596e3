#include "freepath/evaluation/comparison.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/evaluation/flip.h"
#include "freepath/evaluation/process_time.h"
#include "freepath/evaluation/run_seed.h"

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
  render.layers = {Layer::kVariance, Layer::kSamples, Layer::kLookups};
  return render;
}

/// Renders a pixel, so that what can't work is known at once.
void try_configuration(const Subject& subject, const ComparisonSettings& settings,
                       const Configuration& configuration) {
  RenderSettings render = settings_of(settings, configuration);
  render.samples = 1;
  render.crop = Crop{.x0 = 0, .y0 = 0, .x1 = 1, .y1 = 1};
  subject.render(render, {});
}

/// The configurations as they can be run.
std::vector<Configuration> tried_configurations(const Subject& subject,
                                                const ComparisonSettings& settings) {
  std::vector<Configuration> configurations = settings.configurations;
  for (Configuration& configuration : configurations) {
    try {
      try_configuration(subject, settings, configuration);
    } catch (const Error& error) {
      const std::string reason = error.what();
      if (!settings.may_interpolate || configuration.interpolation != Interpolation::kStochastic) {
        fail("{}: {}", configuration.tracker, reason);
      }
      configuration.interpolation = Interpolation::kTrilinear;
      try {
        try_configuration(subject, settings, configuration);
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
  Experiment(const Subject& subject, const ComparisonSettings& settings,
             const ComparisonProgressFunction& progress)
      : subject_(subject), settings_(settings), progress_(progress) {}

  Comparison run() {
    configurations_ = tried_configurations(subject_, settings_);
    name_configurations();
    get_references();
    pictures_.resize(configurations_.size());
    snapshots_.resize(configurations_.size());
    for (int repeat = 0; repeat < settings_.repeats; ++repeat) {
      const std::size_t count = configurations_.size();
      for (std::size_t i = 0; i < count; ++i) {
        run_once((i + static_cast<std::size_t>(repeat)) % count, repeat);
      }
    }
    report("errors", 1);
    evaluate();
    result_.seconds = clock_.seconds();
    return std::move(result_);
  }

 private:
  struct Snapshot {
    double seconds;
    std::vector<float> means;
  };

  void name_configurations();
  void get_references();
  void run_once(std::size_t which, int repeat);
  void evaluate();
  void evaluate_run(std::size_t which, std::size_t repeat);
  void find_efficiencies();
  /// The colours of a film that grows, when it has twice the samples that it had.
  std::function<void(const Film&)> take_snapshots(std::vector<Snapshot>& snapshots,
                                                  const Clock& clock) const;

  void report(const std::string& step, double fraction) {
    if (progress_ && !progress_({step, fraction, clock_.seconds()})) {
      throw Interrupted("interrupted: nothing is written");
    }
  }
  /// Tells of a rendering that does a part of the work.
  ProgressFunction progress_of(const std::string& step, double begin, double part) {
    return [this, step, begin, part](const RenderProgress& rendering) {
      if (!progress_) return true;
      const double done =
          rendering.samples_total > 0 ? rendering.samples_done / rendering.samples_total : 0;
      return progress_({step, begin + part * std::min(1.0, done), clock_.seconds()});
    };
  }
  /// Share of the work that references take.
  double reference_share() const {
    const double runs = settings_.time * static_cast<double>(configurations_.size());
    const double reference = settings_.reference.file.empty() ? settings_.reference.time : 0;
    return runs + reference > 0 ? reference / (runs + reference) : 0;
  }

  const Subject& subject_;
  const ComparisonSettings& settings_;
  const ComparisonProgressFunction& progress_;
  std::vector<Configuration> configurations_;
  Clock clock_;
  Comparison result_;
  std::vector<std::vector<PixelEstimates>> pictures_;          // of each run
  std::vector<std::vector<std::vector<Snapshot>>> snapshots_;  // of each run
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
  const double share = reference_share();
  for (const Configuration& configuration : configurations_) {
    const bool is_nearest = configuration.interpolation == Interpolation::kNearest;
    std::optional<std::size_t>& place = is_nearest ? nearest : trilinear;
    if (!place) {
      place = result_.references.size();
      Configuration standard;
      if (is_nearest) standard.interpolation = Interpolation::kNearest;
      Reference reference = get_reference(subject_, settings_.reference, standard, settings_.render,
                                          progress_of("reference", 0, share));
      if (reference.estimates.mean.empty()) throw Interrupted("interrupted: nothing is written");
      result_.references.push_back(std::move(reference));
    }
    result_.reference_of.push_back(*place);
  }
}

std::function<void(const Film&)> Experiment::take_snapshots(std::vector<Snapshot>& snapshots,
                                                            const Clock& clock) const {
  return [&snapshots, &clock, last = uint32_t{0}](const Film& film) mutable {
    const uint32_t samples = film.sample_counts().fewest;
    if (samples == 0 || samples < 2 * last) return;
    last = samples;
    snapshots.push_back({clock.seconds(), estimates_of(film).mean});
  };
}

void Experiment::run_once(std::size_t which, int repeat) {
  ConfigurationResult& result = result_.configurations[which];
  RenderSettings render = settings_of(settings_, result.configuration);
  render.walk.seed = run_seed(settings_.seed, which, repeat);
  render.time_limit = settings_.time / settings_.repeats;
  render.samples = (settings_.samples + settings_.repeats - 1) / settings_.repeats;
  snapshots_[which].emplace_back();
  const auto runs = static_cast<double>(configurations_.size() * settings_.repeats);
  const double done = static_cast<double>(repeat) * result_.configurations.size() +
                      static_cast<double>((which + result_.configurations.size() -
                                           repeat % result_.configurations.size()) %
                                          result_.configurations.size());
  const double share = reference_share();
  const std::string step =
      fmt::format("{}, run {} of {}", result.name, repeat + 1, settings_.repeats);
  const double begin = share + (1 - share) * done / runs;
  report(step, begin);
  const Clock clock;
  render.on_pass = take_snapshots(snapshots_[which].back(), clock);
  const double cpu_before = process_cpu_seconds();
  const RenderResult rendered =
      subject_.render(render, progress_of(step, begin, (1 - share) / runs));
  ComparisonRun run;
  run.cpu_seconds = process_cpu_seconds() - cpu_before;
  if (rendered.interrupted) throw Interrupted("interrupted: nothing is written");
  if (rendered.pixels_without_samples > 0) {
    fail("{}: {} pixels have no sample after {:.1f} s: give more --time, or fewer --repeats",
         result.name, rendered.pixels_without_samples, rendered.seconds);
  }
  run.seconds = rendered.seconds;
  run.samples = rendered.samples;
  run.paths = rendered.paths;
  run.overflows = rendered.overflows;
  run.free_paths = rendered.free_paths;
  run.shadow_rays = rendered.shadow_rays;
  result.runs.push_back(run);
  pictures_[which].push_back(estimates_of(rendered.film));
}

void Experiment::evaluate_run(std::size_t which, std::size_t repeat) {
  ConfigurationResult& result = result_.configurations[which];
  ComparisonRun& run = result.runs[repeat];
  const PixelEstimates& picture = pictures_[which][repeat];
  const PixelEstimates& reference = result_.reference(which).estimates;
  run.error = squared_error(picture.mean, reference);
  for (std::size_t i = 0; i < picture.variance.size(); ++i) {
    run.variance[i % 3] += picture.variance[i] / static_cast<double>(picture.pixel_count());
  }
  std::vector<float> differences =
      high_range_flip(reference.mean, picture.mean, picture.width, picture.height);
  run.flip = std::accumulate(differences.begin(), differences.end(), 0.0) /
             static_cast<double>(differences.size());
  if (repeat == 0) result.flip = std::move(differences);
  for (const Snapshot& snapshot : snapshots_[which][repeat]) {
    run.convergence.push_back({snapshot.seconds, squared_error(snapshot.means, reference).mse});
  }
}

void Experiment::evaluate() {
  const std::size_t configurations = result_.configurations.size();
  const auto repeats = static_cast<std::size_t>(settings_.repeats);
  tbb::parallel_for(std::size_t{0}, configurations * repeats,
                    [&](std::size_t i) { evaluate_run(i / repeats, i % repeats); });
  for (std::size_t which = 0; which < configurations; ++which) {
    ConfigurationResult& result = result_.configurations[which];
    std::vector<const PixelEstimates*> parts;
    for (const PixelEstimates& picture : pictures_[which]) parts.push_back(&picture);
    result.together = merged(parts);
    result.first = std::move(pictures_[which].front());
    result.bias = test_bias(result.together, result_.reference(which).estimates);
    result_.tests += result.bias.tests();
  }
  result_.threshold = family_wise_threshold(settings_.level, result_.tests);
  for (ConfigurationResult& result : result_.configurations) {
    // Written so that a NaN fails.
    result.passes_bias_test = result.bias.worst() <= result_.threshold;
  }
  find_efficiencies();
}

void Experiment::find_efficiencies() {
  const ConfigurationResult& baseline = result_.configurations[result_.baseline];
  for (ConfigurationResult& result : result_.configurations) {
    std::vector<double> ratios;
    for (std::size_t repeat = 0; repeat < result.runs.size(); ++repeat) {
      const ComparisonRun& mine = result.runs[repeat];
      const ComparisonRun& theirs = baseline.runs[repeat];
      const bool positive = mine.error.mse > 0 && theirs.error.mse > 0;
      ratios.push_back(positive ? theirs.error.mse * theirs.cpu_seconds /
                                      (mine.error.mse * mine.cpu_seconds)
                                : 0);
    }
    result.efficiency = geometric_interval(ratios);
  }
}

}  // namespace

Interval ConfigurationResult::over_runs(
    const std::function<double(const ComparisonRun&)>& figure) const {
  std::vector<double> values;
  for (const ComparisonRun& run : runs) values.push_back(figure(run));
  return mean_interval(values);
}

Comparison compare(const Subject& subject, const ComparisonSettings& settings,
                   const ComparisonProgressFunction& progress) {
  if (settings.configurations.empty()) fail("nothing to compare: no methods are given");
  if (settings.repeats < 1) fail("nothing to compare: {} repeats", settings.repeats);
  if (settings.time <= 0 && settings.samples == 0) {
    fail("nothing to compare: neither a time nor samples are given");
  }
  return Experiment(subject, settings, progress).run();
}

}  // namespace freepath
