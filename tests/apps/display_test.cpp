// --display: a server that takes what a viewer would, and what is left when it goes.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {
namespace {

/// Listens on a port of its own and takes one connection.
class Viewer {
 public:
  /// @param bytes after which it breaks the connection; 0: never
  /// @param is_slow whether it takes a byte now and then
  explicit Viewer(std::size_t bytes = 0, bool is_slow = false) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(listener_, 1), 0);
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, bytes, is_slow] { take(bytes, is_slow); });
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer() { finish(); }

  /// Takes nothing more.
  void give_up() { given_up_ = true; }
  std::string port() const { return std::to_string(port_); }
  /// Waits for the end of the connection.
  const std::vector<char>& finish() {
    if (!thread_.joinable()) return received_;
    if (!accepted_) shutdown(listener_, SHUT_RDWR);  // so that nobody waits for what never comes
    thread_.join();
    close(listener_);
    return received_;
  }

 private:
  void take(std::size_t bytes, bool is_slow) {
    const int connection = accept(listener_, nullptr, nullptr);
    accepted_ = true;
    if (connection < 0) return;
    std::array<char, 4096> buffer{};
    while (true) {
      if (is_slow) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const ssize_t count = read(connection, buffer.data(), is_slow ? 1 : buffer.size());
      if (count <= 0 || given_up_) break;
      received_.insert(received_.end(), buffer.data(), buffer.data() + count);
      if (bytes > 0 && received_.size() >= bytes) {
        const linger at_once{1, 0};
        setsockopt(connection, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
        break;
      }
    }
    close(connection);
  }

  int listener_ = -1;
  std::atomic<bool> accepted_ = false, given_up_ = false;
  uint16_t port_ = 0;
  std::thread thread_;
  std::vector<char> received_;
};

/// Reads what a viewer received.
class Reader {
 public:
  explicit Reader(const std::vector<char>& bytes) : bytes_(bytes) {}
  bool at_end() const { return at_ == bytes_.size(); }
  std::size_t at() const { return at_; }
  template <class T>
  T take() {
    T value{};
    EXPECT_LE(at_ + sizeof(T), bytes_.size());
    if (at_ + sizeof(T) > bytes_.size()) return value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    std::string result;
    for (char c = take<char>(); c != 0; c = take<char>()) result += c;
    return result;
  }
  void names() {
    EXPECT_EQ(take<int32_t>(), 4);
    for (const char* name : {"R", "G", "B", "A"}) EXPECT_EQ(text(), name);
  }

 private:
  const std::vector<char>& bytes_;
  std::size_t at_ = 0;
};

/// The picture that a viewer shows in the end.
struct Shown {
  int width = 0, height = 0;
  int updates = 0;
  std::vector<float> values;
};

Shown decode(const std::vector<char>& bytes, const std::string& name) {
  Shown shown;
  Reader reader(bytes);
  while (!reader.at_end() && !::testing::Test::HasFailure()) {
    const std::size_t begin = reader.at();
    const auto length = reader.take<uint32_t>();
    const char kind = reader.take<char>();
    const char focus = reader.take<char>();
    EXPECT_EQ(reader.text(), name);
    if (kind == 4) {
      EXPECT_EQ(begin, 0U);
      EXPECT_EQ(focus, 1);
      shown.width = reader.take<int32_t>();
      shown.height = reader.take<int32_t>();
      reader.names();
      shown.values.resize(std::size_t(shown.width) * shown.height * 4);
    } else {
      EXPECT_EQ(kind, 6);
      EXPECT_EQ(focus, 0);
      reader.names();
      const auto x = reader.take<int32_t>();
      const auto y = reader.take<int32_t>();
      const auto width = reader.take<int32_t>();
      const auto height = reader.take<int32_t>();
      for (int64_t c = 0; c < 4; ++c) EXPECT_EQ(reader.take<int64_t>(), c);
      for (int c = 0; c < 4; ++c) EXPECT_EQ(reader.take<int64_t>(), 4);
      EXPECT_LE(x + width, shown.width);
      EXPECT_LE(y + height, shown.height);
      if (x + width > shown.width || y + height > shown.height) return shown;
      for (int row = y; row < y + height; ++row) {
        for (int i = 0; i < width * 4; ++i) {
          shown.values[(std::size_t(row) * shown.width + x) * 4 + i] = reader.take<float>();
        }
      }
      ++shown.updates;
    }
    EXPECT_EQ(reader.at(), begin + length);
  }
  return shown;
}

class DisplayTest : public ProgramTest {
 protected:
  DisplayTest() { write_cube(path("ball.vdb")); }

  Outcome render(const std::string& options) const {
    return run("render ball.vdb --size 24x16 --spp 5 -o picture.exr " + options);
  }
};

TEST_F(DisplayTest, ShowsThePictureAsItGrows) {
  Viewer viewer;
  const Outcome outcome = render("--layers none --display 127.0.0.1:" + viewer.port());
  ASSERT_EQ(outcome.status, 0) << outcome;
  const Shown shown = decode(viewer.finish(), "picture.exr");
  EXPECT_EQ(shown.width, 24);
  EXPECT_EQ(shown.height, 16);
  EXPECT_GE(shown.updates, 3);  // after 1 and 5 samples, and at the end
  EXPECT_EQ(shown.values, read_image(path("picture.exr")).values);
}

TEST_F(DisplayTest, ShowsACropInItsPlace) {
  Viewer viewer;
  const Outcome outcome = render("--crop 6,4,18,8 --layers none --display :" + viewer.port());
  ASSERT_EQ(outcome.status, 0) << outcome;
  const Shown shown = decode(viewer.finish(), "picture.exr");
  ASSERT_EQ(shown.width, 24);
  ASSERT_EQ(shown.height, 16);
  const Image part = read_image(path("picture.exr"));
  EXPECT_EQ(shown.values[(4 * 24 + 6) * 4], part.values[0]);
  EXPECT_EQ(shown.values[(4 * 24 + 5) * 4], 0);
}

TEST_F(DisplayTest, ThatIsNotThereIsWarnedOf) {
  std::string port;
  {
    Viewer viewer;
    port = viewer.port();
  }
  const Outcome outcome = render("--display 127.0.0.1:" + port);
  EXPECT_EQ(outcome.status, 0) << outcome;
  EXPECT_NE(outcome.messages.find("warning: --display: no viewer can be reached (127.0.0.1, port " +
                                  port),
            std::string::npos)
      << outcome;
  EXPECT_EQ(read_image(path("picture.exr")).width, 24);
}

TEST_F(DisplayTest, ThatGoesAwayIsWarnedOfOnce) {
  Viewer viewer(100);
  const Outcome outcome = run(
      "render ball.vdb --size 640x480 --spp 5 -o picture.exr --display 127.0.0.1:" + viewer.port());
  EXPECT_EQ(outcome.status, 0) << outcome;
  const std::size_t first = outcome.messages.find("warning: --display: lost the viewer");
  ASSERT_NE(first, std::string::npos) << outcome;
  EXPECT_EQ(outcome.messages.find("warning: --display", first + 1), std::string::npos) << outcome;
  EXPECT_EQ(read_image(path("picture.exr")).width, 640);
}

// It would take a day to read the picture, and does not end by itself.
TEST_F(DisplayTest, ThatReadsSlowlyIsNotWaitedFor) {
  Viewer viewer(1'000'000, true);
  const Outcome outcome = start(
      "render ball.vdb --size 1280x960 --spp 3 -o picture.exr --layers none --display "
      "127.0.0.1:" +
      viewer.port());
  viewer.give_up();
  EXPECT_EQ(outcome.status, 0) << outcome;
  EXPECT_NE(outcome.messages.find("warning: --display: lost the viewer"), std::string::npos)
      << outcome;
  EXPECT_EQ(read_image(path("picture.exr")).width, 1280);
}

TEST_F(DisplayTest, RefusesWhatIsNoAddress) {
  for (const char* wrong :
       {"host:", "host:0", "host:65536", "host:port", "[::1", "[]:1", "[::1]1"}) {
    const Outcome outcome = render(std::string("--display ") + wrong);
    EXPECT_NE(outcome.status, 0) << wrong;
    EXPECT_NE(outcome.messages.find("HOST:PORT"), std::string::npos) << wrong << '\n' << outcome;
  }
}

}  // namespace
}  // namespace freepath::testing
