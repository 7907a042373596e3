#pragma once
/// @file A wavefront of paths through a scene of media, surfaces and lights.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/base/page_allocator.h"
#include "freepath/base/random.h"
#include "freepath/paths/emission_tracer.h"
#include "freepath/paths/escape_queue.h"
#include "freepath/paths/flux_meter.h"
#include "freepath/paths/flux_tally.h"
#include "freepath/paths/glass_spheres.h"
#include "freepath/paths/lobe_branch.h"
#include "freepath/paths/near_light_lines.h"
#include "freepath/paths/near_lights.h"
#include "freepath/paths/open_jobs.h"
#include "freepath/paths/path_job.h"
#include "freepath/paths/path_setup.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/sample_spectra.h"
#include "freepath/paths/shadow_guide.h"
#include "freepath/paths/shadow_tracer.h"
#include "freepath/paths/walk_batches.h"
#include "freepath/sensors/film.h"
#include "freepath/transport/scattering_kernels.h"
#include "freepath/transport/scattering_stream.h"

namespace freepath {

/// Throughputs beyond this are about to overflow: times a radiance they still fit a float.
inline constexpr float kLargestThroughput = 1e28F;

/// Traces paths through a scene: to the next surface or collision, scatter with next-event
/// estimation and multiple importance sampling [Veach97, balance heuristic], Russian roulette,
/// until every path has ended. One wavefront for each thread; its memory is used again.
class PathWavefront {
 public:
  explicit PathWavefront(const PathSetup& setup);
  PathWavefront(const PathWavefront&) = delete;  // its parts refer to each other
  PathWavefront& operator=(const PathWavefront&) = delete;

  /// Traces jobs as long as there are any, and adds the samples of each to the film when its last
  /// path has ended, each pixel's in the order of their numbers.
  /// @return false if they were stopped
  bool trace(const PathJobSource& jobs, Film& film);
  /// Traces one job.
  bool trace(const PathJob& job, Film& film, const std::function<bool()>& stop = {});

  /// Traces paths of light, a chunk of them in each job: `samples` from `first_sample` on, the
  /// upper half of whose numbers is `first_pixel`.
  bool trace(const PathJobSource& jobs);

  /// Counts over all jobs that were finished; those of walks over dropped ones too.
  const PathCounts& counts() const { return counts_; }

 private:
  /// Whether another path is to start, of a new job if there is one and room for it.
  bool has_next_path(const PathJobSource& jobs, const Film& film);
  /// Starts a path in a slot, if there are any. Those that meet nothing at all end at once.
  bool fill(std::size_t slot, const PathJobSource& jobs, Film& film);
  /// Whether the first ray of a path misses everything.
  bool misses_everything(const ScenePath& path) const;
  /// Takes in a path that has ended, and its job if that has with it.
  void end_path(ScenePath& path, const PathJobSource& jobs, Film& film);
  /// Fills order_, and tells the job.
  void set_order(OpenJobs::Job& opened);
  struct PixelSample {
    uint32_t pixel;   ///< Number in the picture.
    uint32_t sample;  ///< Number in the pixel.
    uint32_t set;     ///< Of the wavelengths.
  };
  /// @param number of the job's samples, pixel by pixel
  PixelSample pixel_sample_of(const PathJob& job, std::size_t number) const;
  /// The numbers of a sample's place on the film; those of a pixel often follow each other.
  std::array<float, 2> film_pair(const SampleSequence& numbers, uint32_t pixel, uint32_t sample);
  /// @param path_number of the newest job's paths
  void start_path(std::size_t path_number, ScenePath& path);
  /// Takes in the paths that have ended, and such jobs; others start in their places.
  void end_paths(const PathJobSource& jobs, Film& film);
  const SampleSpectra& colors_of(const PixelSample& sample) const {
    return *setup_.colors[sample.set - setup_.first_set];
  }
  /// Puts the ray of a path among those that fly next.
  void send(std::size_t slot);
  /// Writes the ray of a path in a medium into the stream of its walker.
  void write_ray(std::size_t slot, const Walker& walker, const Vec3f& origin,
                 const Vec3f& direction, float end);
  /// Flies all rays that were sent: those in vacuum are at their end, others are walked.
  void fly();
  /// Where no collision has ended a ray.
  void end_flight(std::size_t slot);
  /// Sets the length of a ray up to a side of the domain, or a plane where paths split.
  void set_side(ScenePath& path, const Vec3f& origin, const Vec3f& direction) const;
  void pass_side(ScenePath& path);
  void take_flight(const WalkBatches::Batch& batch, std::size_t i);
  /// Takes the ray of a path back from a stream, if it lies there alone.
  static void take_ray(ScenePath& path, const RayStream& rays, std::size_t i);
  /// Whether the surface at which a ray ends has to be known before it flies.
  bool needs_surfaces_first(const ScenePath& path) const;
  void find_surface(ScenePath& path);
  /// Where the ray of a path ends, if it ends at a surface.
  SurfaceHit& hit_of(const ScenePath& path) { return hits_[&path - paths_.data()]; }
  PathSample& result_of(const ScenePath& path) { return jobs_.results[path.result]; }

  static bool is_grey(const ScenePath& path);
  /// Whether a path has no colour, so that what it sees of lights can be had in R, G, B.
  bool sees_rgb(const ScenePath& path) const {
    return may_see_rgb_ && !path.is_coloured && (!path.may_differ || is_grey(path));
  }
  /// Those of the lights that it sees, and its throughput in their channels.
  const SpectrumValues& light_spectra(const ScenePath& path, bool in_rgb) const;
  static SampledSpectrum light_throughput(const ScenePath& path, bool in_rgb);
  /// Adds what a path that ends sees outside of the scene.
  /// @param in_image what the image around shows, if that is known
  void escape(ScenePath& path, const LightValue* in_image = nullptr);
  /// The same, perhaps not before see_outside().
  void leave_scene(std::size_t slot);
  /// Looks up what the paths see that wait for it.
  void see_outside();
  /// The surface that a path meets where its ray ends, if any is there. Of several at the place an
  /// opaque one is never passed over, nor a light; ties_ are the others.
  std::optional<SurfaceHit> choose_surface(const ScenePath& path);
  /// The first surface at the place where a ray ends that its alpha lets be there; ties_ are the
  /// others that are.
  std::optional<SurfaceHit> first_there(const ScenePath& path);
  /// Which of several surfaces at a place is met: the highest, and of equal ones the nearest.
  int rank(uint32_t shape) const;
  void meet_surface(std::size_t slot);
  void cross_boundary(ScenePath& path, const SurfaceHit& hit);
  /// Goes on where the surface at which a ray ends is not there.
  void pass_hole(ScenePath& path);
  void scatter_at_surface(std::size_t slot, const SurfaceHit& hit);
  /// Where a new ray starts at a surface, and the media there.
  struct Departure {
    Vec3f origin;
    MediaSetId media;
  };
  Departure depart(const ScenePath& path, const SurfaceHit& hit, const Vec3f& direction);
  void set_media(ScenePath& path, MediaSetId media) const {
    path.media = media;
    path.medium = media_sets_.medium(media);
  }
  ShadowEnd shadow_end(const LightSample& light) const {
    if (!light.area || light.area->light >= shapes_of_lights_.size()) return {light.distance};
    const std::optional<uint32_t>& shape = shapes_of_lights_[light.area->light];
    if (!shape) return {light.distance};
    return {light.distance, ShadowEnd::Target{*shape, light.area->primitive}};
  }
  /// A light for a position; what its own alpha leaves of it.
  /// @param u numbers in [0, 1), as SceneLights::sample() takes them
  LightSample draw_light(const Vec3f& position, const SpectrumValues& spectra,
                         const std::array<float, 3>& u) const;
  /// Whether a path goes on at a surface as if there were none.
  bool is_hole(const ScenePath& path, const SurfaceHit& hit, const Material& material) const;
  /// Puts a path that a medium scatters into the queue for it.
  /// @param i of its ray and its flight
  /// @param magnitude of its throughput
  void collide(std::size_t slot, const WalkBatches::Batch& batch, std::size_t i, float magnitude);
  /// Finds out how a component of the medium that a path is in scatters.
  void set_scatterer(const ScenePath& path, std::size_t component);
  /// Position where a flight has ended [world, relative to the scene's origin].
  Vec3f position_of(const RayStream& rays, std::size_t i) const;
  /// Scatters those in the queue: draws lights for them and where they go on.
  void scatter_in_media(const WalkBatches::Batch& batch);
  /// Writes what all draws of lights have in common, once and for all, if they are of one light.
  void set_only_light();
  /// Takes that light for a scattering in the queue.
  void take_only_light(std::size_t scattering, const ScenePath& path);
  struct Scattering;
  /// Radiance that the only light brings by a scattering unshadowed, times the density of the draw.
  SampledSpectrum from_only_light(const ScenePath& path, const Scattering& scattering);
  /// Whether the shadow ray to a light at some distance plays Russian roulette.
  bool plays(const ScenePath& path, float distance) const {
    return setup_.shadow_guide != nullptr && ShadowGuide::plays(path.scatterings, distance);
  }
  /// Draws the light for a scattering in the queue.
  void draw_light_of(std::size_t scattering, const ScenePath& path);
  /// Draws the light for a scattering inside of glass, through which it is seen.
  void draw_light_through(std::size_t scattering, const ScenePath& path, const GlassSphere& glass,
                          const LightSample& draw);
  /// Sees the light of a lamp that a path meets.
  LightSeen see_light(const ScenePath& path, uint32_t light, const SurfaceHit& hit,
                      const SpectrumValues& spectra) const;
  /// Notes what a surface does to a path where there are GlassSpheres.
  /// @param pdf of its direction before
  /// @return whether it sees lamps now that are drawn through the glass too
  bool refract(ScenePath& path, const SurfaceHit& hit, const MaterialSample& next, float pdf) const;
  /// What the alpha of a light leaves of a draw of it.
  LightSample with_alpha(LightSample light, const Vec3f& position) const;
  /// Follows a scattering in the queue in two directions, if its chance comes. The path has that
  /// drawn for it, and its share.
  /// @param dominant direction from which most light comes
  void split(std::size_t scattering, ScenePath& path, const Vec3f& dominant);
  /// Share of a light that a path brings, the rest being its branches'.
  /// @param distance to it
  float share_of_light(const ScenePath& path, const Vec3f& direction, float distance) const {
    if (path.sun_share == 1 && !path.is_branch) return 1;
    const bool is_sun = !std::isfinite(distance) && setup_.shadow_guide->is_dominant(direction);
    return is_sun ? path.sun_share : path.is_branch ? 0.0F : 1.0F;
  }
  std::vector<LobeBranch>& branches_of(const ScenePath& path) {
    return branches_[&path - paths_.data()];
  }
  /// Goes on with a branch of a path that has ended, if one waits.
  bool take_lobe_branch(ScenePath& path);
  /// Draws a point for a light that the next ray of a path passes near, if it does.
  /// @param length of the ray, may be infinite
  void send_near_line(std::size_t slot, float length);
  /// The same for a scattering in the queue, whose ray need not be that of the path.
  void draw_near_line(std::size_t scattering);
  /// Draws a point of a light for a point of a ray.
  /// @param factor of the path's throughput by which it counts
  void add_near_line(std::size_t slot, const Vec3f& origin, const Vec3f& direction,
                     const NearLights::Point& point, float factor, RandomStream& random);
  /// Traces light by way of the points that were drawn.
  void trace_near_lines();
  /// Casts a ray to its light from a point that was drawn.
  void light_near_line(const NearLightLines::Line& line);
  /// Says how bright a radiance is to the picture: the mean of the channels, in units of white.
  /// Huge where the shadow ray to a light at that distance does not play.
  float brightness(const ScenePath& path, const SampledSpectrum& radiance, bool in_rgb,
                   float distance) const;
  /// With what probability to cast a shadow ray from a surface that brings this if nothing is in
  /// between.
  float shadow_survival(const ScenePath& path, const Vec3f& position, const LightSample& light,
                        const SampledSpectrum& radiance) const;
  /// Casts a ray towards that light, which send_shadows() writes where it can.
  void cast_shadow(std::size_t scattering);
  /// Draws the next direction of a scattering whose phase function the lanes don't know.
  void draw_direction_of(std::size_t scattering);
  /// Turns a path into the direction drawn for a scattering in the queue.
  void turn_scattered(std::size_t scattering, ScenePath& path);
  /// Writes the rays of those that only the next walk needs into its stream.
  void send_scattered(const Walker& walker);
  /// Writes the rays of those to their lights, where these meet but media.
  void send_shadows(const Walker& walker);
  /// Null where the flights of paths find all that a medium emits.
  const EmissionGuide* guide_of(MediumId medium) const {
    if (meter_ != nullptr || scene_.domain) return nullptr;
    const bool wanted =
        setup_.samples_emission.value_or(!setup_.factory->emission_is_uniform(medium));
    return wanted ? setup_.factory->guide(medium) : nullptr;
  }
  void draw_emission(std::size_t scattering, const EmissionGuide& guide);
  /// Whether the limit of scatterings ends a path.
  bool is_cut(const ScenePath& path) const { return path.scatterings > setup_.max_scatterings; }
  /// @param albedo of what would scatter it
  void count_cut(const ScenePath& path, const SampledSpectrum& albedo);
  /// Decides by Russian roulette whether a path goes on.
  /// @param u in (0, 1)
  /// @return false if the path has ended
  bool survives(ScenePath& path, float u) const;
  /// Plays Russian roulette with a given probability of going on.
  static bool goes_on(ScenePath& path, float u, float survival);
  /// Largest magnitude of a path's throughput; no number below infinity if a channel is none.
  float magnitude(const ScenePath& path) const {
    const bool is_first = meter_ != nullptr || !path.may_differ;
    return is_first ? std::abs(path.throughput[0]) : largest_magnitude(path.throughput);
  }
  void go_on(ScenePath& path, const Vec3f& origin, const Vec3f& direction) const;
  /// Sends a path on in a new direction.
  void turn(ScenePath& path, const Vec3f& from, const Vec3f& origin, const Vec3f& direction) const;
  /// The medium of the scene, and its component, in which a collision takes place.
  MediumWalkers::Origin scatterer_of(const ScenePath& path, std::size_t component) const;
  /// Records the first event of a path.
  /// @param weight its probability over that with which it came about, in each channel
  void record_event(ScenePath& path, float t, const SampledSpectrum& weight,
                    const SampledSpectrum& albedo, const Vec3f& normal);
  void record_medium_event(ScenePath& path, float t, const MediumWalkers::Origin& scatterer);
  /// R, G, B on the film of both parts of a radiance.
  Rgb rgb_of(const ScenePath& path, const SampledSpectrum& radiance,
             const SampledSpectrum& rgb) const;
  Rgb transmittance_of(const ScenePath& path) const;
  // Paths of light: path_fluxes.cpp.
  void start_light(std::size_t path_number, ScenePath& path);
  FluxRecord& record_of(const ScenePath& path) { return jobs_.fluxes[path.result]; }
  /// Counts a weight of a path in a cell.
  void deposit(const ScenePath& path, uint32_t cell, float weight);
  void leave_meter(ScenePath& path);
  void arrive_at_ground(const ScenePath& path, const Vec3f& position);
  void absorb_part(const ScenePath& path, const Vec3f& position, std::size_t component);
  void show_collision(std::size_t scattering);
  void show_surface(std::size_t slot, const SurfaceHit& hit, const Material& material,
                    RandomStream& random, const SurfaceContext& context);
  void pass_plane(std::size_t slot);
  /// Goes on with a branch of a path that has ended, if one waits.
  bool take_branch(ScenePath& path);

  void finish(ScenePath& path);
  void add_to_film(const OpenJobs::Job& done, Film& film) const;
  /// Sum of what the paths of a sample have found.
  /// @param first place of the first one's result
  PathSample sum_of_paths(std::size_t first, std::size_t count) const;
  LayerSample sum_of_layers(std::size_t first, std::size_t count) const;
  void add_to_tally(const OpenJobs::Job& done);
  /// @param sample of the job
  void add_spectrum(const OpenJobs::Job& done, std::size_t sample, Film& film) const;

  const PathSetup& setup_;
  const PathScene& scene_;
  const FluxMeter* meter_;  // of the setup; its paths carry the first channel alone
  bool has_sides_;          // whether rays end at sides of a domain, or at planes
  MediaSetTable media_sets_;
  MediaSetId camera_media_ = 0;
  std::optional<Box3f> everything_;                         // around the medium, if that is all
  bool is_balanced_ = true;                                 // whether white stays as it is
  bool has_alpha_ = false;                                  // whether a shape of the scene has
  std::vector<std::optional<uint32_t>> shapes_of_lights_;   // by LightSample::Area::light
  std::vector<TiedSurface> ties_;                           // of the surface that a path meets
  std::vector<ScenePath, PageAllocator<ScenePath>> paths_;  // in slots, made as they start
  std::vector<SurfaceHit> hits_;                            // of the paths, if there are surfaces
  std::vector<uint32_t> slots_;  // those of the paths in flight, then the others
  std::size_t active_ = 0;       // paths in flight
  // Rays in flight, and those of the next round, which scatterings write.
  WalkBatches flying_, sent_;
  std::vector<uint32_t> in_vacuum_, sent_in_vacuum_;  // slots of those that need no walk
  FlightStream flights_;
  /// A path that a medium scatters, of the same number in scatterings_.
  struct Scattering {
    uint32_t slot = 0;
    bool in_rgb = false;  ///< Whether the light is.
    const PhaseFunction* phase = nullptr;
    ShadowEnd end;  ///< End of the shadow ray.
    /// The glass that refracts it, if any does.
    std::optional<ShadowTracer::Bend> bend;
    /// Radiance that the light brings unshadowed, times the density of the draw, before roulette of
    /// the path; of the only light from_only_light() says it.
    SampledSpectrum radiance;
    float brought = 1;  ///< share_of_light() of the only light.
  };
  /// How the component scatters that the scattering before was of.
  struct Scatterer {
    std::size_t component = SIZE_MAX;
    const PhaseFunction* phase = nullptr;
    float g = 0;            ///< ScatteringStream::g
    uint32_t is_given = 0;  ///< ScatteringStream::is_given
  };
  Scatterer scatterer_;
  std::optional<SceneLights::OnlyLight> only_light_;
  float only_brightness_ = 0;    // see brightness()
  SampledSpectrum only_in_rgb_;  // radiance of the only light, and what it is in only_colors_
  const SampleSpectra* only_colors_ = nullptr;
  SampledSpectrum only_in_colors_;
  const ScatteringKernels& kernels_;
  ScatteringStream scatterings_;
  bool has_given_ = false;  // whether ScatteringStream::is_given of one of them
  std::array<Scattering, ScatteringStream::kCapacity> scattered_;
  ScatteringStream::Set going_on_ = 0;  // see send_scattered()
  ShadowTracer shadows_;
  EmissionTracer emissions_;
  EscapeQueue escapes_;
  // Where there are lights near media; else null.
  std::optional<NearLightLines> near_lines_;
  std::optional<ShadowTracer> near_shadows_;
  std::vector<std::vector<LobeBranch>> branches_;  // of the paths, if they split
  OpenJobs jobs_;
  uint32_t newest_ = 0;        // job, whose paths start now
  std::size_t next_path_ = 0;  // of those
  std::size_t paths_of_newest_ = 0;
  bool has_more_jobs_ = false;
  /// The newest job's samples (pixel · samples + sample) in the order in which they start.
  std::vector<uint32_t> order_;
  std::vector<uint32_t> sets_, begin_of_set_;        // for that order
  const SampleSpectra* colors_of_sample_ = nullptr;  // of the sample whose paths start now
  uint32_t hashed_pixel_ = UINT32_MAX;
  SampleSequence::Hashes film_hashes_{};  // of that pixel
  bool records_spectra_ = false;
  bool may_see_rgb_ = false;  // whether paths without colour see lights in R, G, B
  PixelWindow window_;        // of the film at work
  PathCounts counts_;
};

}  // namespace freepath
