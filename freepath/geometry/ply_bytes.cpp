#include "freepath/geometry/ply_bytes.h"

#include <algorithm>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// Meshes are packed to a tenth at best. What unpacks to a hundred times as much, and is large, is
/// no mesh but meant to fill memory.
std::size_t largest_mesh(std::size_t packed) {
  constexpr std::size_t kHarmless = std::size_t{256} << 20;
  constexpr std::size_t kLargestRatio = 100;
  const std::size_t possible = GzipReader::largest_size(packed);
  return std::min(possible,
                  std::max(kHarmless, possible / GzipReader::kLargestRatio * kLargestRatio));
}

}  // namespace

PlyBytes::PlyBytes(std::string_view content, const std::string& name)
    : name_(name), ahead_(content), largest_size_(content.size()) {
  if (!is_gzip(content)) return;
  packed_.emplace(content);
  ahead_ = {};
  largest_size_ = largest_mesh(content.size());
}

void PlyBytes::unpack(std::size_t size) {
  std::string rest(ahead_);
  try {
    while (rest.size() < size) {
      const std::size_t before = rest.size();
      if (!packed_->append_to(rest)) {
        packed_.reset();
        break;
      }
      total_ += rest.size() - before;
      if (total_ > largest_size_) {
        fail("it unpacks to more than {} bytes, far more than packed meshes do; unpack it first",
             largest_size_);
      }
    }
  } catch (const Error& error) {
    fail("{}: {}", name_, error.what());
  }
  unpacked_ = std::move(rest);
  ahead_ = unpacked_;
}

}  // namespace freepath
