// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/control_socket.hpp"

#include <pwd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio.hpp>
#include <mutex>
#include <set>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

namespace asio = boost::asio;
using asio::local::stream_protocol;
using boost::system::error_code;

constexpr std::size_t kConnectionsMax = 16;
constexpr std::size_t kGroupsMax = 65536;  // Linux's
constexpr auto kConnectionLasts = std::chrono::seconds{30};
constexpr auto kAcceptAgain = std::chrono::milliseconds{200};
constexpr auto kLastWords = std::chrono::milliseconds{200};
constexpr std::string_view kDone = "done\n";
constexpr std::string_view kRefused = "refused\n";

/// Who holds the other end.
std::optional<ucred> peer_of(stream_protocol::socket& socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0)
    return std::nullopt;
  return peer;
}

/// The account that the packages' service runs as, whose group is the crew.
struct Account {
  uid_t user;
  gid_t group;
};
std::optional<Account> service_account() {
  std::array<char, 4096> text{};
  passwd account{};
  passwd* found = nullptr;
  if (::getpwnam_r("skein", &account, text.data(), text.size(), &found) != 0 || found == nullptr) {
    return std::nullopt;
  }
  return Account{account.pw_uid, account.pw_gid};
}

bool is_of_group(stream_protocol::socket& socket, const ucred& peer, gid_t group) {
  if (peer.gid == group) return true;
  std::vector<gid_t> groups(kGroupsMax);
  auto size = static_cast<socklen_t>(groups.size() * sizeof(gid_t));
  if (::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERGROUPS, groups.data(), &size) != 0) {
    return false;
  }
  groups.resize(size / sizeof(gid_t));
  return std::ranges::find(groups, group) != groups.end();
}

/// Whose orders are taken: the same user's, root's, and, by the service, those of its group.
bool may_order(stream_protocol::socket& socket) {
  const auto peer = peer_of(socket);
  if (!peer) return false;
  if (peer->uid == ::geteuid() || peer->uid == 0) return true;
  const auto service = service_account();
  return service && service->user == ::geteuid() && is_of_group(socket, *peer, service->group);
}

/// Who is given orders: anybody may take a name, so the same user, root, and the service.
bool may_be_told(stream_protocol::socket& socket) {
  const auto peer = peer_of(socket);
  if (!peer) return false;
  if (peer->uid == ::geteuid() || peer->uid == 0) return true;
  const auto service = service_account();
  return service && service->user == peer->uid;
}

Result<stream_protocol::endpoint> endpoint_of(const std::string& name) {
  constexpr std::size_t kNameMax = sizeof(sockaddr_un::sun_path) - 1;
  if (name.size() > kNameMax) {
    return Error{name + ": longer than a socket's name may be, " + std::to_string(kNameMax) +
                 " bytes; choose a shorter control_socket"};
  }
  return stream_protocol::endpoint{std::string(1, '\0') + name};
}

}  // namespace

std::string control_socket_name(std::uint16_t port) {
  return "skein-ground-" + std::to_string(port);
}

class ControlSocket::Impl {
 public:
  explicit Impl(std::function<void()> on_line) : on_line_{std::move(on_line)} {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
    // What was answered still goes out, as to `quit`.
    io_.restart();
    io_.poll();
    error_code ignored;
    acceptor_.close(ignored);
    again_.cancel(ignored);
    const auto open_ones = connections_;
    for (const auto& connection : open_ones) {
      if (connection->text.empty()) connection->end();
    }
    io_.run_for(kLastWords);
  }

  Result<void> open(const std::string& name) {
    const auto endpoint = endpoint_of(name);
    if (!endpoint) return endpoint.error();
    error_code failed;
    acceptor_.open(endpoint->protocol(), failed);
    if (!failed) acceptor_.bind(*endpoint, failed);
    if (!failed) acceptor_.listen(asio::socket_base::max_listen_connections, failed);
    if (failed) {
      return Error{name + ": " + failed.message() +
                   "; end the ground station that has this name, or choose another control_socket"};
    }
    accept();
    thread_ = std::thread{[this] { io_.run(); }};
    return {};
  }

  std::optional<Request> next() {
    const std::lock_guard lock{mutex_};
    while (auto waiting = requests_.pop()) {
      // Who has gone believes that nothing was done.
      if (!waiting->gone->load()) return std::move(waiting->request);
    }
    return std::nullopt;
  }

 private:
  struct Connection : std::enable_shared_from_this<Connection> {
    Connection(Impl& owner, stream_protocol::socket&& accepted)
        : impl{owner}, socket{std::move(accepted)}, patience{socket.get_executor()} {}

    void start() {
      patience.expires_after(kConnectionLasts);
      patience.async_wait([self = weak_from_this()](const error_code& cancelled) {
        const auto alive = self.lock();
        if (!cancelled && alive) alive->end();
      });
      asio::async_read_until(
          socket, asio::dynamic_buffer(line, kLineMax), '\n',
          [self = shared_from_this()](const error_code& failed, std::size_t size) {
            if (failed) return self->end();
            self->line.resize(size - 1);
            self->impl.offer(self);
            self->watch();
          });
    }

    /// Notices that the other end closes while it waits.
    void watch() {
      asio::async_read(socket, asio::buffer(more),
                       [self = shared_from_this()](const error_code&, std::size_t) {
                         if (self->text.empty()) self->end();
                       });
    }

    void answer(const Answer& given) {
      text = (given.done ? kDone : kRefused);
      text += given.text;
      asio::async_write(
          socket, asio::buffer(text),
          [self = shared_from_this()](const error_code&, std::size_t) { self->end(); });
    }

    void end() {
      gone->store(true);
      error_code ignored;
      patience.cancel(ignored);
      socket.close(ignored);
      impl.connections_.erase(shared_from_this());
    }

    Impl& impl;
    stream_protocol::socket socket;
    asio::steady_timer patience;
    std::string line;
    std::string text;
    std::array<char, 1> more{};
    std::shared_ptr<std::atomic<bool>> gone = std::make_shared<std::atomic<bool>>(false);
  };
  struct Waiting {
    Request request;
    std::shared_ptr<std::atomic<bool>> gone;
  };

  void accept() {
    acceptor_.async_accept([this](const error_code& failed, stream_protocol::socket accepted) {
      if (failed == asio::error::operation_aborted) return;
      if (failed) {  // no descriptor is free, say
        again_.expires_after(kAcceptAgain);
        again_.async_wait([this](const error_code& cancelled) {
          if (!cancelled) accept();
        });
        return;
      }
      if (connections_.size() < kConnectionsMax && may_order(accepted)) {
        const auto connection = std::make_shared<Connection>(*this, std::move(accepted));
        connections_.insert(connection);
        connection->start();
      }
      accept();
    });
  }

  void offer(const std::shared_ptr<Connection>& connection) {
    Request request{connection->line,
                    [this, from = std::weak_ptr{connection}](const Answer& answer) {
                      asio::post(io_, [from, answer] {
                        const auto waiting = from.lock();
                        if (waiting && waiting->socket.is_open()) waiting->answer(answer);
                      });
                    }};
    {
      const std::lock_guard lock{mutex_};
      requests_.push({std::move(request), connection->gone});
    }
    on_line_();
  }

  std::function<void()> on_line_;
  asio::io_context io_{1};
  stream_protocol::acceptor acceptor_{io_};
  asio::steady_timer again_{io_};
  std::set<std::shared_ptr<Connection>> connections_;  ///< of the thread only
  std::mutex mutex_;
  BoundedQueue<Waiting> requests_{kConnectionsMax};  ///< under mutex_
  std::thread thread_;
};

Result<std::unique_ptr<ControlSocket>> ControlSocket::open(const std::string& name,
                                                           std::function<void()> on_line) {
  auto impl = std::make_unique<Impl>(std::move(on_line));
  if (auto opened = impl->open(name); !opened) return opened.error();
  return std::unique_ptr<ControlSocket>{new ControlSocket{std::move(impl)}};
}

ControlSocket::ControlSocket(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
ControlSocket::~ControlSocket() = default;

std::optional<ControlSocket::Request> ControlSocket::next() { return impl_->next(); }

Result<Answer> ask(const std::string& name, const std::string& line,
                   std::chrono::milliseconds at_most) {
  const auto endpoint = endpoint_of(name);
  if (!endpoint) return endpoint.error();
  asio::io_context io{1};
  stream_protocol::socket socket{io};
  error_code failed;
  socket.connect(*endpoint, failed);
  if (failed) {
    return Error{"no ground station has the control socket " + name + " (" + failed.message() +
                 "); start one, or give its configuration with --config"};
  }
  if (!may_be_told(socket)) {
    return Error{"the program that has the control socket " + name + " is of another user"};
  }
  const std::string request = line + "\n";
  std::string reply;
  bool ended = false;
  bool closed = false;
  asio::async_write(socket, asio::buffer(request), [&](const error_code& error, std::size_t) {
    closed = error.failed();
    if (closed) return;
    asio::async_read(socket, asio::dynamic_buffer(reply), [&](const error_code& end, std::size_t) {
      ended = end == asio::error::eof;
      closed = true;
    });
  });
  io.run_for(at_most);
  if (closed && reply.empty()) {
    return Error{"the ground station at the control socket " + name +
                 " takes no order from you: it does from its user, from root and, as a service, "
                 "from the group skein, 16 at a time"};
  }
  const bool done = reply.starts_with(kDone);
  if (!ended || !(done || reply.starts_with(kRefused))) {
    return Error{"the ground station at the control socket " + name + " does not answer"};
  }
  return Answer{done, reply.substr((done ? kDone : kRefused).size())};
}

}  // namespace skein::groundstation
