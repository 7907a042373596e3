// Packets begin with their length in bytes, that of the length itself included (32 bits), and their
// kind. Numbers are little-endian, texts end in a 0.

#include "apps/freepath/tev_display.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/progress_bar.h"
#include "freepath/base/error.h"

namespace freepath::program {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr char kCreateImage = 4;
constexpr char kUpdateImage = 6;  // with offsets and strides
constexpr int kChannelsShown = 4;
constexpr std::array<const char*, kChannelsShown> kNames{"R", "G", "B", "A"};

/// Rendering never waits for a viewer. At its beginning, and for the last picture at its end, it
/// has so long [s],
constexpr double kPatience = 3, kPatienceAfterInterrupt = 0.5;
/// and longer while it takes so much [bytes/s].
constexpr double kSlowest = 1e6;
constexpr int kMillisecondsBetweenLooks = 50;
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

/// Patience with a viewer: the time that it is waited for.
class Patience {
 public:
  /// @param taken bytes that it took so far
  bool is_over(std::size_t taken) const {
    const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (StopOnInterrupt::requested() && seconds > kPatienceAfterInterrupt) return true;
    return seconds > kPatience && static_cast<double>(taken) < kSlowest * seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
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
    : name_(std::move(name)), address_(fmt::format("{}, port {}", address.host, address.port)) {
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
    socket_ = socket(entry->ai_family, entry->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                     entry->ai_protocol);
    if (socket_ >= 0 && ::connect(socket_, entry->ai_addr, entry->ai_addrlen) == 0) return;
    reason = errno;
    if (socket_ >= 0 && reason == EINPROGRESS) reason = wait_for_connection();
    if (reason == 0) return;
    if (socket_ >= 0) close(std::exchange(socket_, -1));
  }
  give_up(std::strerror(reason));
}

int TevDisplay::wait_for_connection() const {
  for (const Patience patience; !patience.is_over(0);) {
    if (!wait_until_writable()) continue;
    int reason = 0;
    socklen_t size = sizeof(reason);
    getsockopt(socket_, SOL_SOCKET, SO_ERROR, &reason, &size);
    return reason;
  }
  return ETIMEDOUT;
}

bool TevDisplay::wait_until_writable() const {
  pollfd ready{socket_, POLLOUT, 0};
  return poll(&ready, 1, kMillisecondsBetweenLooks) > 0;
}

void TevDisplay::give_up(const std::string& reason) {
  warn("--display: {} ({}): {}; the picture is not shown{}",
       created_ ? "lost the viewer" : "no viewer can be reached", address_, reason,
       created_ ? " any more" : "");
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

void TevDisplay::show(const Film& film) {
  push();
  if (socket_ >= 0 && waiting_.empty()) put(film.to_image({}));
  push();
}

void TevDisplay::show_last(const Image& image) {
  const Patience patience;
  std::size_t taken = 0;
  const auto drain = [&] {
    while (socket_ >= 0 && !waiting_.empty()) {
      taken += push();
      if (waiting_.empty()) return;
      if (patience.is_over(taken)) return give_up("it takes hardly any data");
      wait_until_writable();
    }
  };
  drain();
  if (socket_ >= 0) put(image);
  drain();
}

void TevDisplay::put(const Image& picture) {
  // The viewer is told numbers alone, which it takes for sRGB's.
  std::optional<Image> converted;
  if (picture.chromaticities) converted = in_srgb(picture);
  const Image& image = converted ? *converted : picture;
  if (!created_) create(image);
  const int rows = std::max(1, kValuesPerPacket / (image.width * kChannelsShown));
  for (int first = 0; first < image.height; first += rows) {
    put_rows(image, first, std::min(rows, image.height - first));
  }
}

void TevDisplay::create(const Image& image) {
  Packet packet(kCreateImage);
  packet.put(char{1});  // to the front
  packet.put_text(name_);
  packet.put(int32_t{std::max(image.full_width, image.width)});
  packet.put(int32_t{std::max(image.full_height, image.height)});
  packet.put_names();
  put(packet.finish());
  created_ = true;
}

void TevDisplay::put_rows(const Image& image, int first, int count) {
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
  put(packet.finish());
}

void TevDisplay::put(const std::vector<char>& packet) {
  waiting_.insert(waiting_.end(), packet.begin(), packet.end());
}

std::size_t TevDisplay::push() {
  const std::size_t before = sent_;
  while (socket_ >= 0 && sent_ < waiting_.size()) {
    const ssize_t count = ::send(socket_, waiting_.data() + sent_, waiting_.size() - sent_,
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      sent_ += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {
      break;
    } else if (errno != EINTR) {
      give_up(std::strerror(errno));
    }
  }
  const std::size_t taken = sent_ - before;
  if (sent_ == waiting_.size()) {
    waiting_.clear();
    sent_ = 0;
  }
  return taken;
}

}  // namespace freepath::program
