#include "freepath/paths/film_file.h"

#include <blosc.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/input_file.h"
#include "freepath/base/json_text.h"
#include "freepath/tracking/statistics_fields.h"

namespace freepath {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little,
              "films are written as they lie in memory");

constexpr std::string_view kMagic = "freepath film 2\n";
/// Bytes that are packed at a time.
constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr uint64_t kLargestHeader = std::size_t{1} << 26;

/// Both ways between a struct and JSON: `visit(name, member)` for each member.
template <class Visitor>
void visit_counts(PathCounts& counts, const Visitor& visit) {
  visit("paths", counts.paths);
  visit("overflows", counts.overflows);
  visit("cut_paths", counts.cut_paths);
  visit("cut_weight", counts.cut_weight);
}

template <class Visitor>
void visit_window(PixelWindow& window, const Visitor& visit) {
  visit("x", window.x);
  visit("y", window.y);
  visit("width", window.width);
  visit("height", window.height);
  visit("full_width", window.full_width);
  visit("full_height", window.full_height);
}

template <class Visit, class Struct>
Json to_json(Visit visit_members, Struct values) {
  Json json;
  visit_members(values, [&](const char* name, const auto& value) { json[name] = value; });
  return json;
}

template <class Struct, class Visit>
Struct from_json(Visit visit_members, const Json& json) {
  Struct values;
  visit_members(values, [&](const char* name, auto& value) { json.at(name).get_to(value); });
  return values;
}

constexpr auto kStatistics = [](auto& values, const auto& visit) {
  visit_statistics(values, visit);
};
constexpr auto kCounts = [](auto& values, const auto& visit) { visit_counts(values, visit); };
constexpr auto kWindow = [](auto& values, const auto& visit) { visit_window(values, visit); };

Json to_json(const Chromaticity& point) { return {point.x, point.y}; }

Chromaticity chromaticity(const Json& json) { return {json.at(0), json.at(1)}; }

Json header_json(const FilmHeader& header) {
  Json counts = to_json(kCounts, header.counts);
  counts["free_paths"] = to_json(kStatistics, header.counts.free_paths);
  counts["shadow_rays"] = to_json(kStatistics, header.counts.shadow_rays);
  Json json = {{"version", header.identity.version},
               {"seed", header.identity.seed},
               {"facts", header.identity.facts},
               {"region", to_json(kWindow, header.region)},
               {"window", to_json(kWindow, header.window)},
               {"wanted_samples", header.wanted_samples},
               {"first_sample", header.first_sample},
               {"fewest_samples", header.samples.fewest},
               {"most_samples", header.samples.most},
               {"pixels_without_samples", header.samples.pixels_without},
               {"layers", to_string(header.layers)},
               {"buckets", {header.buckets.count, header.buckets.first, header.buckets.last}},
               {"counts", counts},
               {"seconds", header.seconds},
               {"notes", header.notes}};
  if (header.chromaticities) {
    const auto& [primaries, white] = *header.chromaticities;
    json["chromaticities"] = {to_json(primaries.red), to_json(primaries.green),
                              to_json(primaries.blue), to_json(white)};
  }
  return json;
}

/// Whether a window lies in its picture, whose pixels can be numbered.
bool is_valid(const PixelWindow& window) {
  constexpr int64_t kMost = int64_t{1} << 31;
  return window.x >= 0 && window.y >= 0 && window.width > 0 && window.height > 0 &&
         int64_t{window.x} + window.width <= window.full_width &&
         int64_t{window.y} + window.height <= window.full_height &&
         int64_t{window.full_width} * window.full_height < kMost;
}

FilmHeader header_of(const Json& json) {
  FilmHeader header;
  header.identity = {json.at("version"), json.at("seed"), json.at("facts")};
  header.region = from_json<PixelWindow>(kWindow, json.at("region"));
  header.window = from_json<PixelWindow>(kWindow, json.at("window"));
  header.wanted_samples = json.at("wanted_samples");
  header.first_sample = json.at("first_sample");
  header.samples = {json.at("fewest_samples"), json.at("most_samples"),
                    json.at("pixels_without_samples")};
  header.layers = parse_layers(json.at("layers").get<std::string>());
  const Json& buckets = json.at("buckets");
  header.buckets = {buckets.at(0), buckets.at(1), buckets.at(2)};
  const Json& counts = json.at("counts");
  header.counts = from_json<PathCounts>(kCounts, counts);
  header.counts.free_paths = from_json<WalkStatistics>(kStatistics, counts.at("free_paths"));
  header.counts.shadow_rays = from_json<WalkStatistics>(kStatistics, counts.at("shadow_rays"));
  header.seconds = json.at("seconds");
  header.notes = json.at("notes");
  if (json.contains("chromaticities")) {
    const Json& c = json.at("chromaticities");
    header.chromaticities = {{chromaticity(c.at(0)), chromaticity(c.at(1)), chromaticity(c.at(2))},
                             chromaticity(c.at(3))};
  }
  constexpr int kMostBuckets = 1 << 16;
  constexpr uint64_t kMostSamples = uint64_t{1} << 31;
  if (!is_valid(header.window) || !is_valid(header.region) || header.buckets.count < 0 ||
      header.buckets.count > kMostBuckets ||
      uint64_t{header.first_sample} + header.samples.most > kMostSamples) {
    fail("its numbers make no sense");
  }
  return header;
}

/// Writes bytes and keeps their checksum.
class Output {
 public:
  explicit Output(std::ostream& stream) : stream_(stream) {}

  void put(const void* bytes, std::size_t count) {
    stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    checksum_ = crc32_z(checksum_, static_cast<const Bytef*>(bytes), count);
  }
  template <class T>
  void put_number(T number) {
    put(&number, sizeof(number));
  }
  void put_checksum() { put_number(static_cast<uint32_t>(checksum_)); }

 private:
  std::ostream& stream_;
  uLong checksum_ = 0;
};

void put_packed(Output& output, std::span<const std::byte> bytes, std::vector<char>& buffer) {
  buffer.resize(kPiece + BLOSC_MAX_OVERHEAD);
  for (std::size_t begin = 0; begin < bytes.size(); begin += kPiece) {
    const std::span piece = bytes.subspan(begin, std::min(kPiece, bytes.size() - begin));
    const int size =
        blosc_compress_ctx(1, BLOSC_SHUFFLE, sizeof(int64_t), piece.size(), piece.data(),
                           buffer.data(), buffer.size(), BLOSC_LZ4_COMPNAME, 0, 1);
    if (size <= 0) fail("its sums can't be packed");
    output.put_number(static_cast<uint32_t>(size));
    output.put(buffer.data(), static_cast<std::size_t>(size));
  }
}

void put_film(std::ostream& stream, FilmHeader header, const Film& film) {
  describe(header, film);
  const std::string text = json_text(header_json(header));
  Output output(stream);
  output.put(kMagic.data(), kMagic.size());
  output.put_number(static_cast<uint64_t>(text.size()));
  output.put(text.data(), text.size());
  std::vector<char> buffer;
  for (const std::span<const std::byte> block : film.sums_in_memory()) {
    put_packed(output, block, buffer);
  }
  output.put_checksum();
}

/// Bytes of a film, wherever they are.
struct Source {
  std::string name;
  uint64_t size = 0;
  std::function<std::size_t(uint64_t offset, std::span<std::byte> bytes)> read;
};

Source source_of_file(const std::string& path) {
  auto file = std::make_shared<InputFile>(path, "a film");
  return {file->name(), file->size(), [file](uint64_t offset, std::span<std::byte> bytes) {
            return file->read(offset, bytes);
          }};
}

/// @param memory has to outlive the source
Source source_of_memory(std::string_view memory, const std::string& name) {
  return {name, memory.size(), [memory](uint64_t offset, std::span<std::byte> bytes) {
            const std::string_view piece = memory.substr(offset, bytes.size());
            std::memcpy(bytes.data(), piece.data(), piece.size());
            return piece.size();
          }};
}

/// Reads a film from its begin to its end.
class Input {
 public:
  explicit Input(Source source) : source_(std::move(source)) {}

  [[noreturn]] void damaged(std::string_view reason) const {
    fail("{}: {}; is it a film that freepath has written, whole?", source_.name, reason);
  }

  void take(std::span<std::byte> bytes) {
    if (source_.read(offset_, bytes) != bytes.size()) damaged("it ends too early");
    offset_ += bytes.size();
    checksum_ = crc32_z(checksum_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  }
  template <class T>
  T take_number() {
    T number{};
    take(std::as_writable_bytes(std::span(&number, 1)));
    return number;
  }

  FilmHeader take_header() {
    std::array<char, kMagic.size()> magic{};
    if (source_.size < magic.size()) damaged("it is no film");
    take(std::as_writable_bytes(std::span(magic)));
    const std::string_view begin(magic.data(), magic.size());
    if (begin != kMagic) {
      constexpr std::string_view kAnyVersion = kMagic.substr(0, kMagic.find('2'));
      if (begin.starts_with(kAnyVersion)) {
        fail("{}: is of another version of films' files; write it again by this freepath",
             source_.name);
      }
      damaged("it is no film");
    }
    const auto size = take_number<uint64_t>();
    if (size > std::min(kLargestHeader, source_.size)) damaged("its header is too large");
    std::string text(size, '\0');
    take(std::as_writable_bytes(std::span(text)));
    try {
      return header_of(Json::parse(text));
    } catch (const Json::exception&) {
      damaged("its header is damaged");
    } catch (const Error& error) {
      damaged(error.what());
    }
  }

  void take_packed(std::span<std::byte> bytes, std::vector<std::byte>& buffer) {
    for (std::size_t begin = 0; begin < bytes.size(); begin += kPiece) {
      const std::span piece = bytes.subspan(begin, std::min(kPiece, bytes.size() - begin));
      const auto size = take_number<uint32_t>();
      if (size > kPiece + BLOSC_MAX_OVERHEAD) damaged("its sums are damaged");
      buffer.resize(size);
      take(buffer);
      std::size_t unpacked = 0;
      if (blosc_cbuffer_validate(buffer.data(), size, &unpacked) != 0 || unpacked != piece.size() ||
          blosc_decompress_ctx(buffer.data(), piece.data(), piece.size(), 1) !=
              static_cast<int>(piece.size())) {
        damaged("its sums are damaged");
      }
    }
  }

  void end() {
    const auto expected = static_cast<uint32_t>(checksum_);
    if (take_number<uint32_t>() != expected) damaged("its checksum is another one");
    if (offset_ != source_.size) damaged("there is more behind its end");
  }

  uint64_t size() const { return source_.size; }

 private:
  Source source_;
  uint64_t offset_ = 0;
  uLong checksum_ = 0;
};

/// Takes all of a film.
FilmFile take_film(Input input) {
  FilmHeader header = input.take_header();
  // Packed sums are smaller by a factor that is bounded, so that memory is too.
  constexpr double kMostPacked = 1000;
  const double bytes = static_cast<double>(Film::bytes_per_pixel(header.layers, header.buckets)) *
                       header.window.width * header.window.height;
  if (bytes > kMostPacked * static_cast<double>(input.size())) {
    input.damaged("it is too short for its pixels");
  }
  FilmFile result{header, Film(header.window, header.layers, header.buckets, header.first_sample)};
  result.film.set_chromaticities(header.chromaticities);
  std::vector<std::byte> buffer;
  for (const std::span<std::byte> block : result.film.sums_in_memory()) {
    input.take_packed(block, buffer);
  }
  input.end();
  const Film::SampleCounts counts = result.film.sample_counts();
  if (counts.fewest != header.samples.fewest || counts.most != header.samples.most) {
    input.damaged("its pixels have other samples than its header says");
  }
  try {
    result.film.check_sums();
  } catch (const Error& error) {
    input.damaged(error.what());
  }
  return result;
}

}  // namespace

bool is_film_file(const std::string& path) { return path.ends_with(kFilmExtension); }

void describe(FilmHeader& header, const Film& film) {
  header.window = film.window();
  header.layers = film.layers();
  header.buckets = film.buckets();
  header.chromaticities = film.chromaticities();
  header.first_sample = film.first_sample();
  header.samples = film.sample_counts();
}

void write_film(AtomicFile& file, FilmHeader header, const Film& film) {
  std::ofstream stream(file.name(), std::ios::binary);
  put_film(stream, std::move(header), film);
  stream.close();
  if (stream.fail()) file.give_up("not all of it; is the disk full?");
  file.replace_target();
}

std::string film_bytes(FilmHeader header, const Film& film) {
  std::ostringstream stream;
  put_film(stream, std::move(header), film);
  return std::move(stream).str();
}

FilmHeader read_film_header(const std::string& path) {
  return Input(source_of_file(path)).take_header();
}

FilmFile read_film(const std::string& path) { return take_film(Input(source_of_file(path))); }

FilmFile film_of_bytes(std::string_view bytes, const std::string& name) {
  return take_film(Input(source_of_memory(bytes, name)));
}

}  // namespace freepath
