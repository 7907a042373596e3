// Packets begin with their length in bytes, that of the length itself included (32 bits), and their
// kind. Numbers are little-endian, texts end in a 0.

#include "apps/freepath/tev_display.h"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/freepath/console.h"
#include "freepath/base/error.h"

namespace freepath::program {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr char kCreateImage = 4;
constexpr char kUpdateImage = 6;  // with offsets and strides
constexpr int kChannelsShown = 4;
constexpr std::array<const char*, kChannelsShown> kNames{"R", "G", "B", "A"};

/// A viewer that takes no data for so long is given up: rendering waits for it meanwhile.
constexpr int kPatienceInSeconds = 5;
/// Rows are sent together up to so many values, so that the viewer can show them one by one.
constexpr int kValuesPerPacket = 1 << 18;

class Packet {
 public:
  explicit Packet(char kind) {
    put(uint32_t{0});
    put(kind);
  }
  template <class T>
  void put(T value) {
    const auto* const bytes = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
  }
  void put_text(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    put('\0');
  }
  void put_names() {
    put(int32_t{kChannelsShown});
    for (const char* name : kNames) put_text(name);
  }
  std::vector<char> finish() {
    const auto size = static_cast<uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &size, sizeof(size));
    return std::move(bytes_);
  }

 private:
  std::vector<char> bytes_;
};

[[noreturn]] void fail_address(const std::string& text) {
  fail("--display: '{}' is not HOST:PORT, as in localhost:14158 or [::1]:14158", text);
}

}  // namespace

DisplayAddress parse_display(const std::string& text) {
  DisplayAddress address;
  std::string_view rest = text;
  if (rest.starts_with('[')) {
    const std::size_t end = rest.find(']');
    if (end == std::string_view::npos) fail_address(text);
    address.host = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
  } else {
    const std::size_t colon = rest.find(':');
    // Two colons without brackets are an IPv6 address alone.
    const bool is_bare = colon == std::string_view::npos || rest.rfind(':') != colon;
    const std::size_t length = is_bare ? rest.size() : colon;
    if (length > 0) address.host = rest.substr(0, length);
    rest.remove_prefix(length);
  }
  if (address.host.empty()) fail_address(text);
  if (rest.empty()) return address;
  if (!rest.starts_with(':')) fail_address(text);
  rest.remove_prefix(1);
  int port = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), port);
  if (error != std::errc() || end != rest.data() + rest.size() || port < 1 || port > 65535) {
    fail_address(text);
  }
  address.port = rest;
  return address;
}

TevDisplay::TevDisplay(const DisplayAddress& address, std::string name)
    : name_(std::move(name)), place_(fmt::format("{}, port {}", address.host, address.port)) {
  connect(address);
}

TevDisplay::~TevDisplay() {
  if (socket_ >= 0) close(socket_);
}

void TevDisplay::connect(const DisplayAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (error != 0) return give_up(gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> list(found, freeaddrinfo);
  int reason = 0;
  for (const addrinfo* entry = list.get(); entry != nullptr; entry = entry->ai_next) {
    const int candidate =
        socket(entry->ai_family, entry->ai_socktype | SOCK_CLOEXEC, entry->ai_protocol);
    if (candidate < 0) {
      reason = errno;
      continue;
    }
    const timeval patience{kPatienceInSeconds, 0};  // of connecting, too
    setsockopt(candidate, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
    if (::connect(candidate, entry->ai_addr, entry->ai_addrlen) == 0) {
      socket_ = candidate;
      return;
    }
    reason = errno == EINPROGRESS ? ETIMEDOUT : errno;
    close(candidate);
  }
  give_up(std::strerror(reason));
}

void TevDisplay::give_up(const std::string& reason) {
  warn("--display: {} ({}): {}; the picture is not shown{}",
       created_ ? "lost the viewer" : "no viewer can be reached", place_, reason,
       created_ ? " any more" : "");
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

void TevDisplay::show(const Image& picture) {
  if (socket_ < 0) return;
  // The viewer is told numbers alone, which it takes for sRGB's.
  std::optional<Image> converted;
  if (picture.chromaticities) converted = in_srgb(picture);
  const Image& image = converted ? *converted : picture;
  if (!created_) create(image);
  const int rows = std::max(1, kValuesPerPacket / (image.width * kChannelsShown));
  for (int first = 0; first < image.height && socket_ >= 0; first += rows) {
    send_rows(image, first, std::min(rows, image.height - first));
  }
}

void TevDisplay::create(const Image& image) {
  Packet packet(kCreateImage);
  packet.put(char{1});  // to the front
  packet.put_text(name_);
  packet.put(int32_t{std::max(image.full_width, image.width)});
  packet.put(int32_t{std::max(image.full_height, image.height)});
  packet.put_names();
  send(packet.finish());
  created_ = true;
}

void TevDisplay::send_rows(const Image& image, int first, int count) {
  Packet packet(kUpdateImage);
  packet.put(char{0});  // stays where it is
  packet.put_text(name_);
  packet.put_names();
  packet.put(int32_t{image.x});
  packet.put(int32_t{image.y + first});
  packet.put(int32_t{image.width});
  packet.put(int32_t{count});
  for (int64_t channel = 0; channel < kChannelsShown; ++channel) packet.put(channel);  // offsets
  for (int channel = 0; channel < kChannelsShown; ++channel) packet.put(int64_t{kChannelsShown});
  for (int row = first; row < first + count; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (int channel = 0; channel < kChannelsShown; ++channel) {
        packet.put(image.pixel(column, row)[channel]);
      }
    }
  }
  send(packet.finish());
}

void TevDisplay::send(const std::vector<char>& packet) {
  for (std::size_t sent = 0; sent < packet.size();) {
    if (socket_ < 0) return;
    const ssize_t count = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      give_up(errno == EAGAIN ? "it takes no data" : std::strerror(errno));
    }
  }
}

}  // namespace freepath::program
