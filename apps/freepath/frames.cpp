#include "apps/freepath/frames.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include "apps/freepath/parse.h"
#include "apps/freepath/render_output.h"
#include "freepath/base/error.h"
#include "freepath/io/image.h"

namespace freepath::program {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestFrame = 999'999'999;
constexpr std::size_t kMostFrames = 1'000'000;
constexpr int kMostDigits = 20;

/// Takes a number from the front of a text.
std::optional<int> take_number(std::string_view& text, int largest) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, value);
  if (error != std::errc() || value > largest) return std::nullopt;
  text.remove_prefix(digits);
  return value;
}

/// Frames from one to another, in steps.
struct FrameRange {
  int first = 0, last = 0, step = 1;
};

/// "7", "1-48" or "1-48x2".
std::optional<FrameRange> read_range(std::string_view text) {
  const auto take = [&](char sign) {
    const bool present = text.starts_with(sign);
    if (present) text.remove_prefix(1);
    return present;
  };
  const std::optional<int> first = take_number(text, kLargestFrame);
  if (!first) return std::nullopt;
  if (text.empty()) return FrameRange{*first, *first, 1};
  if (!take('-')) return std::nullopt;
  const std::optional<int> last = take_number(text, kLargestFrame);
  if (!last) return std::nullopt;
  if (text.empty()) return FrameRange{*first, *last, 1};
  if (!take('x')) return std::nullopt;
  const std::optional<int> step = take_number(text, kLargestFrame);
  if (!step || *step == 0 || !text.empty()) return std::nullopt;
  return FrameRange{*first, *last, *step};
}

/// The place of a frame's number in a name.
struct NumberField {
  std::size_t length = 0;  ///< 0: none begins here.
  int digits = 1;
};

/// The place at the front of a text, where there is one.
NumberField number_field_at(std::string_view text) {
  if (text.starts_with('#')) {
    const std::size_t length = std::min(text.find_first_not_of('#'), text.size());
    return length > 1 ? NumberField{length, static_cast<int>(length)} : NumberField{};
  }
  if (text.starts_with("%d")) return {2, 1};
  if (!text.starts_with("%0")) return {};
  std::string_view rest = text.substr(2);
  const std::optional<int> digits = take_number(rest, kMostDigits);
  if (!digits || *digits == 0 || !rest.starts_with('d')) return {};
  return {text.size() - rest.size() + 1, *digits};
}

/// Whether the number of a frame seems to have a place in a name, whatever else is in it.
bool looks_like_sequence(std::string_view name) {
  while (!name.empty()) {
    if (number_field_at(name).length > 0) return true;
    name.remove_prefix(name.starts_with("%%") ? 2 : 1);
  }
  return false;
}

/// "frame 3: ", nothing where a name is the same in all frames.
std::string frame_prefix(const FrameName& name, int frame) {
  return name.has_number() ? fmt::format("frame {}: ", frame) : std::string();
}

void check_readable(const std::string& file, const std::string& prefix) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    fail("{}{}: does not exist; check the name, or leave the frame out of --frames", prefix, file);
  }
  if (!fs::is_regular_file(file, error))
    fail("{}{}: is not a file; give the name of a volume file", prefix, file);
  if (access(file.c_str(), R_OK) != 0) {
    fail("{}{}: can't be read; check its permissions", prefix, file);
  }
}

std::string canonical(const std::string& file) {
  std::error_code error;
  return fs::weakly_canonical(file, error).string();
}

/// Checks that no frame writes over a file that it or another one reads or writes.
void check_distinct(const std::vector<PictureFiles>& pictures) {
  std::set<std::string> volumes;
  for (const PictureFiles& picture : pictures) {
    for (const std::string& volume : picture.volumes) volumes.insert(canonical(volume));
  }
  std::map<std::string, int> frames;
  for (const PictureFiles& picture : pictures) {
    std::vector<std::string> written = picture.outputs;
    for (const std::string& file : {picture.stats, picture.checkpoint}) {
      if (!file.empty()) written.push_back(file);
    }
    for (const std::string& file : written) {
      const std::string name = canonical(file);
      if (volumes.contains(name)) fail("{}: would overwrite a volume; choose another name", file);
      const auto [entry, is_new] = frames.emplace(name, *picture.frame);
      if (is_new || entry->second == *picture.frame) continue;
      fail("{}: frames {} and {} would both write it; choose other names", file, entry->second,
           *picture.frame);
    }
  }
}

/// Checks what a single picture, or one frame, writes.
void check_written(const PictureFiles& picture) {
  for (const std::string& output : picture.outputs) check_output(output);
  check_statistics_file(picture.stats, picture.outputs, picture.volumes);
  if (!picture.checkpoint.empty()) {
    read_option("--checkpoint", [&] { check_file_target(picture.checkpoint); });
  }
}

/// Refuses names with a place for a frame's number where there are no frames.
void check_no_sequence(const PictureFiles& names) {
  std::vector<std::string> all = names.volumes;
  all.insert(all.end(), names.outputs.begin(), names.outputs.end());
  all.insert(all.end(), {names.stats, names.checkpoint, names.resume});
  for (const std::string& name : all) {
    if (!looks_like_sequence(name)) continue;
    fail("{}: has a place for the number of a frame; say which frames, as in --frames 1-48", name);
  }
}

std::vector<FrameName> frame_names(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

}  // namespace

std::vector<int> parse_frames(std::string_view text, std::string_view option) {
  std::vector<int> frames;
  std::string_view rest = text;
  for (bool last = false; !last;) {
    const std::size_t comma = rest.find(',');
    last = comma == std::string_view::npos;
    const std::string_view item = rest.substr(0, comma);
    const std::optional<FrameRange> range = read_range(item);
    if (!range) {
      fail("{}: '{}' is not a frame, nor a range of frames; write 7, 1-48, 1-48x2 or 1,5,9-12",
           option, item);
    }
    if (range->first > range->last) {
      fail("{}: '{}' has its last frame before its first; write the smaller one first", option,
           item);
    }
    for (int64_t frame = range->first; frame <= range->last; frame += range->step) {
      if (frames.size() == kMostFrames) {
        fail("{}: '{}' has more than {} frames; give fewer at a time", option, text, kMostFrames);
      }
      frames.push_back(static_cast<int>(frame));
    }
    if (!last) rest.remove_prefix(comma + 1);
  }
  std::set<int> seen;
  for (const int frame : frames) {
    if (!seen.insert(frame).second) {
      fail("{}: frame {} is given twice in '{}'; give it once", option, frame, text);
    }
  }
  return frames;
}

std::string format_frames(std::span<const int> frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    const int step = i + 1 < frames.size() ? frames[i + 1] - frames[i] : 0;
    std::size_t end = i + 1;
    while (step > 0 && end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
    // Two frames apart are a list, not a range.
    if (step != 1 && end - i < 3) end = i + 1;
    if (!text.empty()) text += ',';
    text += fmt::format("{}", frames[i]);
    if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
    if (end - i > 1 && step > 1) text += fmt::format("x{}", step);
    i = end;
  }
  return text;
}

FrameName::FrameName(const std::string& name) {
  std::string_view rest = name;
  while (!rest.empty()) {
    std::string& part = has_number_ ? after_ : before_;
    if (const NumberField field = number_field_at(rest); field.length > 0) {
      if (has_number_) fail("{}: has two places for the number of a frame; leave one", name);
      has_number_ = true;
      digits_ = field.digits;
      rest.remove_prefix(field.length);
    } else if (rest.starts_with("%%")) {
      part += '%';
      rest.remove_prefix(2);
    } else if (rest.starts_with('%')) {
      fail(
          "{}: '{}' is no place for the number of a frame; write %d or %04d, or %% for a percent "
          "sign",
          name, rest.substr(0, 4));
    } else {
      part += rest.front();
      rest.remove_prefix(1);
    }
  }
}

std::string FrameName::in_frame(int frame) const {
  if (!has_number_) return before_;
  return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::vector<PictureFiles> plan_pictures(const std::string& frames, const PictureFiles& names) {
  if (frames.empty()) {
    check_no_sequence(names);
    check_written(names);
    return {names};
  }
  const std::vector<int> numbers = parse_frames(frames, "--frames");
  const std::vector<FrameName> volumes = frame_names(names.volumes);
  const std::vector<FrameName> outputs = frame_names(names.outputs);
  const FrameName stats(names.stats);
  const FrameName checkpoint(names.checkpoint);
  const FrameName resume(names.resume);
  const auto has_number = [](const FrameName& name) { return name.has_number(); };
  if (numbers.size() > 1) {
    if (std::none_of(volumes.begin(), volumes.end(), has_number)) {
      fail(
          "--frames {}: no volume has a place for the number of a frame, so that all pictures "
          "would be the same; write one, as in smoke.%04d.vdb",
          frames);
    }
    const auto refuse_overwriting = [&](const FrameName& name, const std::string& typed) {
      if (name.has_number() || typed.empty()) return;
      fail(
          "{}: frames would overwrite each other; give the name a place for their number, as in "
          "picture.%04d.exr",
          typed);
    };
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      refuse_overwriting(outputs[i], names.outputs[i]);
    }
    refuse_overwriting(stats, names.stats);
    refuse_overwriting(checkpoint, names.checkpoint);
    refuse_overwriting(resume, names.resume);
  }
  std::vector<PictureFiles> pictures;
  for (const int number : numbers) {
    PictureFiles picture{.frame = number, .volumes = {}, .outputs = {}};
    for (const FrameName& volume : volumes) {
      picture.volumes.push_back(volume.in_frame(number));
      if (volume.has_number() || pictures.empty()) {
        check_readable(picture.volumes.back(), frame_prefix(volume, number));
      }
    }
    for (const FrameName& output : outputs) picture.outputs.push_back(output.in_frame(number));
    picture.stats = stats.in_frame(number);
    picture.checkpoint = checkpoint.in_frame(number);
    picture.resume = resume.in_frame(number);
    check_written(picture);
    pictures.push_back(std::move(picture));
  }
  check_distinct(pictures);
  return pictures;
}

}  // namespace freepath::program
