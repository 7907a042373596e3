#pragma once
/// @file Names for contents: the same bytes, the same name.

#include <string>
#include <string_view>

namespace freepath {

/// Takes in texts and files one after the other, and makes a name of them that others will not
/// have. Where a text ends counts: "ab", "c" is not "a", "bc".
class ContentDigest {
 public:
  void add(std::string_view text);
  /// The bytes of a file; not its name.
  /// @throws Error if it can't be read
  void add_file(const std::string& path);
  /// 40 hexadecimal digits (SHA-1).
  std::string hex() const;

 private:
  std::string parts_;  // a digest for each
};

}  // namespace freepath
