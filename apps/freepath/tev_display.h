#pragma once
/// @file A picture in a running tev (https://github.com/Tom94/tev), by its protocol over TCP.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "freepath/sensors/film.h"

namespace freepath::program {

/// Where a viewer listens.
struct DisplayAddress {
  std::string host = "localhost";
  std::string port = "14158";
};

/// "host:port", "host", ":port", "[::1]:port" or "::1".
/// @throws Error naming the option
DisplayAddress parse_display(const std::string& text);

/// Shows a picture. What goes wrong is told once, on standard error, and ends the showing.
class TevDisplay {
 public:
  /// @param name of the picture there
  TevDisplay(const DisplayAddress& address, std::string name);
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  /// Sends R, G, B and A as they are, or as much as the viewer takes at once; what is left goes
  /// with the next call. Never waits: while a picture is under way, those that come are left out.
  void show(const Film& film);
  /// The same of a picture's first four channels, which the viewer has a few seconds to take.
  void show_last(const Image& image);

 private:
  void connect(const DisplayAddress& address);
  /// @return 0, or the error's number
  int wait_for_connection() const;
  /// Waits for a moment at most.
  bool wait_until_writable() const;
  void create(const Image& image);
  void put(const Image& image);
  void put_rows(const Image& image, int first, int count);
  void put(const std::vector<char>& packet);
  /// @return bytes that the viewer took
  std::size_t push();
  void give_up(const std::string& reason);

  std::string name_, address_;
  int socket_ = -1;
  std::vector<char> waiting_;  ///< Of which the viewer has the first `sent_` bytes.
  std::size_t sent_ = 0;
  bool created_ = false;
};

}  // namespace freepath::program
