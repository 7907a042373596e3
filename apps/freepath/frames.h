#pragma once
/// @file Sequences of volumes and pictures: the numbers of frames, and the names that they make.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freepath::program {

/// "1-48", "1-48x2" (every second one), "7", or several of these separated by commas, as numbers in
/// the order given.
/// @throws Error naming the option, for another form, a frame given twice, or too many of them
std::vector<int> parse_frames(std::string_view text, std::string_view option);

/// The same numbers as parse_frames reads them, in few words: "1-3,5,7-11x2".
std::string format_frames(std::span<const int> frames);

/// A file name in which the number of a frame may have a place: `%d`, `%04d` (at least four digits,
/// with zeros in front) or `####` (the same; two signs or more). `%%` is a percent sign.
class FrameName {
 public:
  /// @throws Error naming the file, for two places, or a percent sign that means none of these
  explicit FrameName(const std::string& name);

  /// Whether the number of a frame has a place in it.
  bool has_number() const { return has_number_; }
  /// The file's name in a frame.
  std::string in_frame(int frame) const;

 private:
  std::string before_, after_;
  bool has_number_ = false;
  int digits_ = 1;  ///< At least.
};

/// Files of one picture.
struct PictureFiles {
  std::optional<int> frame;  ///< Its number, where it belongs to a sequence.
  std::vector<std::string> volumes;
  std::vector<std::string> outputs;
  std::string stats = {};  ///< Empty: none, as those that follow.
  std::string checkpoint = {}, resume = {};
};

/// The files of all pictures: one for each frame, or a single one where `frames` is empty, whose
/// names are taken as they are.
///
/// All is checked that can be before the first picture is rendered: that every volume of every
/// frame can be read, that all there is to write can be written, and that nothing is written twice
/// or over a volume.
/// @param frames value of --frames
/// @param names of the files as they were typed
/// @throws Error that names the file, its frame, and what to do
std::vector<PictureFiles> plan_pictures(const std::string& frames, const PictureFiles& names);

}  // namespace freepath::program
