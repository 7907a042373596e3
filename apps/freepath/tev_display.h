#pragma once
/// @file A picture in a running tev (https://github.com/Tom94/tev), by its protocol over TCP.

#include <cstdint>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "freepath/render/film.h"

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

  /// Sends R, G, B and A as they are.
  void show(const Film& film) { show(film.to_image({})); }
  /// The same of a picture's first four channels.
  void show(const Image& picture);

 private:
  void connect(const DisplayAddress& address);
  void create(const Image& image);
  void send_rows(const Image& image, int first, int count);
  void send(const std::vector<char>& packet);
  void give_up(const std::string& reason);

  std::string name_, place_;
  int socket_ = -1;
  bool created_ = false;
};

}  // namespace freepath::program
