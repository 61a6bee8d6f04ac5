// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/control_socket.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <future>
#include <semaphore>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;
constexpr std::chrono::seconds kPatience{60};

/// A socket of this process, and who waits for its lines.
class ControlSockets : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<ControlSocket> open() {
    auto opened = ControlSocket::open(name_, [this] { told_.release(); });
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    return std::move(opened).value();
  }
  [[nodiscard]] std::future<Result<Answer>> asked(const std::string& line) const {
    return std::async(std::launch::async, [this, line] { return ask(name_, line, kPatience); });
  }
  /// A connection that says what it is given, and nothing more.
  [[nodiscard]] int connect_and_say(const std::string& text) const {
    const int peer = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name_.copy(&address.sun_path[1], sizeof address.sun_path - 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name_.size());
    EXPECT_EQ(::connect(peer, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(::send(peer, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
    return peer;
  }

  const std::string name_ = "skein-control-test-" + std::to_string(::getpid());
  std::counting_semaphore<> told_{0};
};

TEST_F(ControlSockets, CarryALineAndItsAnswer) {
  const auto socket = open();
  auto answer = asked("form wedge spacing 5");
  told_.acquire();
  const auto request = socket->next();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->line, "form wedge spacing 5");
  request->reply({true, "begun\nin 12 s\n"});
  const auto given = answer.get();
  ASSERT_TRUE(given.ok()) << given.error().message;
  EXPECT_TRUE(given->done);
  EXPECT_EQ(given->text, "begun\nin 12 s\n");

  auto refused = asked("land");
  told_.acquire();
  socket->next()->reply({false, "no vehicle is heard\n"});
  const auto reason = refused.get();
  ASSERT_TRUE(reason.ok());
  EXPECT_FALSE(reason->done);
  EXPECT_EQ(reason->text, "no vehicle is heard\n");
}

TEST_F(ControlSockets, AnswerEvenIfTheyEndAtOnce) {
  auto socket = open();
  auto answer = asked("quit");
  told_.acquire();
  socket->next()->reply({true, ""});
  socket.reset();
  const auto given = answer.get();
  ASSERT_TRUE(given.ok()) << given.error().message;
  EXPECT_TRUE(given->done);
}

TEST_F(ControlSockets, HaveANameEach) {
  const auto socket = open();
  const auto second = ControlSocket::open(name_, [] {});
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, HasSubstr(name_ + ": Address already in use"));
}

TEST_F(ControlSockets, SurviveConnectionsThatSayTooMuchOrNothing) {
  const auto socket = open();
  std::vector<int> peers;
  peers.reserve(4);
  for (int i = 0; i < 4; ++i) peers.push_back(connect_and_say(""));
  const int long_winded = connect_and_say(std::string(5000, 'x'));
  std::array<char, 8> end{};
  EXPECT_LE(::recv(long_winded, end.data(), end.size(), 0), 0);  // closed, and told nobody
  ::close(connect_and_say("half a li"));
  auto answer = asked("status");
  told_.acquire();
  const auto request = socket->next();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->line, "status");
  request->reply({true, ""});
  EXPECT_TRUE(answer.get().ok());
  peers.push_back(long_winded);
  for (const int peer : peers) ::close(peer);
}

TEST_F(ControlSockets, WithNobodyThereSaysSo) {
  const auto nobody = ask(name_, "status", kPatience);
  ASSERT_FALSE(nobody.ok());
  EXPECT_THAT(nobody.error().message, HasSubstr("no ground station has the control socket"));
  const auto too_long = ask(std::string(200, 'x'), "status", kPatience);
  ASSERT_FALSE(too_long.ok());
  EXPECT_THAT(too_long.error().message, HasSubstr("longer than a socket's name"));
}

TEST_F(ControlSockets, DoNotWaitForEverAndWhatNobodyWaitsForIsNotDone) {
  const auto socket = open();
  const auto silent = ask(name_, "take-off", std::chrono::milliseconds{50});
  ASSERT_FALSE(silent.ok());
  EXPECT_THAT(silent.error().message, HasSubstr("does not answer"));
  // The socket's thread has seen the one leave once it serves the next.
  auto answer = asked("status");
  told_.acquire();  // of take-off
  told_.acquire();
  const auto request = socket->next();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->line, "status");
  request->reply({true, ""});
  EXPECT_TRUE(answer.get().ok());
}

}  // namespace
}  // namespace skein::groundstation
