#pragma once
/// @file Files that appear whole or not at all.

#include <filesystem>
#include <string>
#include <string_view>

namespace freepath {

/// Sixteen digits, others each time, which nobody can foresee: for names of files.
std::string random_word();

/// Checks that a file could be written, before the time for its contents is spent: the folder
/// exists and can be written to, the name is not too long, and what stands there already is a file
/// that is not read-only. A link stands for the file that it leads to.
/// @throws Error that names the file and what to do
void check_file_target(const std::string& path);

/// How an AtomicFile is kept until it is complete.
enum class AtomicKind {
  kNameless,  ///< Without a name where the file system can do that: it is gone with the process.
  kNamed      ///< Under a short name that nobody can foresee, as where it can't.
};

/// A file beside the target, which replaces it when it is complete and else disappears: a reader
/// never sees half of it, and an old one survives a failure. It is opened at once, so that what
/// would hinder it is told before its contents are made, and is new: nothing that somebody else has
/// put into the folder is opened or followed.
class AtomicFile {
 public:
  /// @throws Error as check_file_target, and where the folder takes no file
  explicit AtomicFile(const std::string& path, AtomicKind kind = AtomicKind::kNameless);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// The target as it was given, for messages.
  const std::string& path() const { return path_; }
  /// Gives it another target in the same folder. @throws Error as check_file_target
  void retarget(const std::string& path);
  /// The name to open to write to the file; opened again, it is begun anew.
  std::string name() const;
  /// Writes it as a whole. @throws Error that names the target
  void write(std::string_view contents) const;
  /// @throws Error that names the target and the reason, always
  [[noreturn]] void give_up(const std::string& reason) const;
  /// Puts it in the target's place. @throws Error that names the target
  void replace_target();

 private:
  bool open_nameless();
  void open_named();
  /// A free name beside the target, taken by `take`, which sets errno where it fails.
  template <class Take>
  bool take_name(Take take);

  std::string path_;
  std::filesystem::path target_, aside_;  ///< The latter is empty as long as there is no name.
  int descriptor_ = -1;
};

/// Writes a whole file, aside and then renamed.
/// @throws Error that names the file
void write_file(const std::string& path, std::string_view contents);

}  // namespace freepath
