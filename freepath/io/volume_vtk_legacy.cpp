// Reads VTK's old format (.vtk): structured points, as text or in big-endian numbers.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_text.h"
#include "freepath/io/volume_vtk.h"

namespace freepath::io {
namespace {

/// Reads the statements of a file and collects its arrays.
class LegacyVtk {
 public:
  explicit LegacyVtk(const VolumeFile& file) : file_(file), cursor_(file, 0) {}

  std::vector<DenseGrid> read() {
    read_head();
    std::string keyword;
    while (!(keyword = cursor_.word()).empty()) {
      if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
        begin_attributes(keyword);
      } else if (!read_general(keyword)) {
        read_attribute(keyword);
      }
    }
    return std::move(grids_);
  }

 private:
  void read_head() {
    cursor_.line();  // the version: all of them are alike here
    cursor_.line();  // a title
    const std::string encoding(trimmed(cursor_.line()));
    if (encoding != "ASCII" && encoding != "BINARY") {
      file_.fail_damaged(
          fmt::format("its third line is '{}' and neither ASCII nor BINARY", excerpt(encoding)));
    }
    text_ = encoding == "ASCII";
    if (const std::string word = cursor_.word(); word != "DATASET") {
      file_.fail_damaged(fmt::format("'{}' where DATASET belongs", excerpt(word)));
    }
    const std::string kind = cursor_.word();
    if (kind != "STRUCTURED_POINTS") {
      fail(
          "{}: it holds {}, not STRUCTURED_POINTS; resample it to an image (ResampleToImage in "
          "ParaView)",
          file_.name(), excerpt(kind));
    }
    // These may stand in any order, with fields of the whole file among them.
    bool has_dimensions = false, has_origin = false, has_spacing = false;
    while (!has_dimensions || !has_origin || !has_spacing) {
      const std::string keyword = cursor_.word();
      if (keyword == "DIMENSIONS") {
        image_.nodes = checked_counts(file_, "DIMENSIONS with", three_numbers(keyword));
        has_dimensions = true;
      } else if (keyword == "ORIGIN") {
        image_.origin = three_vector(keyword);
        has_origin = true;
      } else if (keyword == "SPACING" || keyword == "ASPECT_RATIO") {
        image_.spacing = three_vector(keyword);
        has_spacing = true;
      } else if (!read_general(keyword)) {
        file_.fail_damaged(
            fmt::format("'{}' where DIMENSIONS, ORIGIN or SPACING belongs", excerpt(keyword)));
      }
    }
  }

  /// Reads what may stand anywhere. @return false if it is none of that
  bool read_general(const std::string& keyword) {
    if (keyword == "METADATA") {
      while (!cursor_.at_end() && !trimmed(cursor_.line()).empty()) continue;
    } else if (keyword == "FIELD") {
      read_field();
    } else {
      return false;
    }
    return true;
  }

  std::vector<double> three_numbers(const std::string& keyword) {
    std::string text;
    for (int i = 0; i < 3; ++i) text += cursor_.word() + " ";
    return header_numbers(file_, keyword, text, 3);
  }

  Vec3d three_vector(const std::string& keyword) {
    const std::vector<double> numbers = three_numbers(keyword);
    return {numbers[0], numbers[1], numbers[2]};
  }

  uint64_t count(std::string_view what) {
    const std::string word = cursor_.word();
    const double value = header_numbers(file_, what, word, 1)[0];
    constexpr double kMost = 1e12;
    if (!(value >= 0 && value <= kMost) || value != std::floor(value)) {
      file_.fail_damaged(fmt::format("{} of {}", excerpt(word), what));
    }
    return static_cast<uint64_t>(value);
  }

  void begin_attributes(const std::string& keyword) {
    samples_ = keyword == "POINT_DATA" ? VtkSamples::kPoints : VtkSamples::kCells;
    const uint64_t declared = count(keyword);
    samples_count_ = dense_bytes(vtk_counts(image_, samples_), 1);
    if (declared != samples_count_) {
      fail("{}: {} is {}, where its DIMENSIONS make {}; correct it", file_.name(), keyword,
           declared, samples_count_);
    }
  }

  void read_field() {
    cursor_.word();  // its name
    const uint64_t arrays = count("FIELD");
    for (uint64_t i = 0; i < arrays; ++i) {
      std::string name = cursor_.word();
      while (name == "METADATA") {  // of the array before
        read_general(name);
        name = cursor_.word();
      }
      const uint64_t components = count("an array's components");
      const uint64_t tuples = count("an array's tuples");
      add_array(name, cursor_.word(), static_cast<double>(components), tuples);
    }
  }

  void read_attribute(const std::string& keyword) {
    if (samples_count_ == 0) {
      fail("{}: {} stands before POINT_DATA or CELL_DATA, and is not known there; correct it",
           file_.name(), excerpt(keyword));
    }
    if (keyword == "SCALARS") {
      const auto words = split_words(cursor_.line());
      if (words.size() < 2) file_.fail_damaged("SCALARS without a name and a type");
      const std::string components = words.size() > 2 ? words[2] : "1";
      expect_lookup_table();
      add_array(words[0], words[1], header_numbers(file_, "SCALARS", components, 1)[0],
                samples_count_);
    } else if (keyword == "VECTORS" || keyword == "NORMALS") {
      const std::string name = cursor_.word(), type = cursor_.word();
      add_array(name, type, 3, samples_count_);
    } else if (keyword == "LOOKUP_TABLE") {
      cursor_.word();
      skip_numbers(NumberType::kUint8, 4 * count("LOOKUP_TABLE"));
    } else {
      fail("{}: its {} can't be read; write scalars, vectors or fields alone", file_.name(),
           excerpt(keyword));
    }
  }

  void expect_lookup_table() {
    const std::vector<std::string> words = split_words(cursor_.line());
    if (words.size() != 2 || words[0] != "LOOKUP_TABLE") {
      file_.fail_damaged("SCALARS without LOOKUP_TABLE in the next line");
    }
  }

  void add_array(const std::string& name, const std::string& type_name, double components,
                 uint64_t tuples) {
    const std::optional<NumberType> type = vtk_number_type(type_name);
    constexpr double kMostComponents = 1 << 16;
    if (!type || !(components >= 1 && components <= kMostComponents)) {
      fail(
          "{}: array \"{}\" has {} numbers of type {} in a sample, which can't be read; leave it "
          "out",
          file_.name(), excerpt(name), components, excerpt(type_name));
    }
    const int channels = static_cast<int>(components);
    DenseGrid grid = vtk_grid(image_, samples_, name);
    set_voxel_type(type, type_name, channels, grid);
    const std::size_t voxel_bytes = size_of(*type) * static_cast<std::size_t>(channels);
    const uint64_t begin = cursor_.offset();
    skip_numbers(*type, tuples * static_cast<uint64_t>(channels));
    if (tuples != samples_count_) return;  // no values of samples
    check_dense_size(file_, grid.counts, voxel_bytes,
                     text_ ? DensePacking::kText : DensePacking::kNone);
    grid.info.stored_bytes = cursor_.offset() - begin;
    if (grid.info.reason.empty()) {
      grid.open = [&file = file_, begin, type = *type, text = text_](const GridInfo& /*head*/) {
        ByteSourcePointer bytes = file_bytes(file, begin);
        return text ? text_planes(std::move(bytes))
                    : number_planes(std::move(bytes), {type, std::endian::big});
      };
    }
    grids_.push_back(std::move(grid));
  }

  void skip_numbers(NumberType type, uint64_t numbers) {
    if (numbers > file_.size()) {
      file_.fail_damaged(
          fmt::format("it declares {} numbers, but ends at byte {}", numbers, file_.size()));
    }
    if (!text_) return cursor_.skip(numbers * size_of(type));
    for (uint64_t i = 0; i < numbers; ++i) {
      if (cursor_.word().empty()) file_.fail_damaged("its values end too soon");
    }
  }

  const VolumeFile& file_;
  TextCursor cursor_;
  bool text_ = false;
  VtkImage image_;
  VtkSamples samples_ = VtkSamples::kPoints;
  uint64_t samples_count_ = 0;
  std::vector<DenseGrid> grids_;
};

}  // namespace

VolumeReaderPointer open_vtk_legacy(const VolumeFile& file) {
  return make_dense_reader(file, LegacyVtk(file).read());
}

}  // namespace freepath::io
