// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/outlet.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace skein::agencies {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using boost::system::error_code;
using std::chrono::steady_clock;

constexpr std::size_t kWaitingMax = 1'000'000;  // bytes that a connection has not taken yet
constexpr int kDroppedAtOnce = 100;             // so that a flood cannot keep the loop

std::string place_text(const std::string& address, std::uint16_t port) {
  return address + ":" + std::to_string(port);
}

class UdpOutlet final : public Outlet {
 public:
  [[nodiscard]] Result<void> open(const std::string& address, std::uint16_t port,
                                  const std::string& interface) {
    place_ = place_text(address, port);
    error_code error;
    const auto to = asio::ip::make_address_v4(address, error);
    if (!error) socket_.open(udp::v4(), error);
    if (!error && to.is_multicast() && !interface.empty()) {
      const auto by = asio::ip::make_address_v4(interface, error);
      if (!error) socket_.set_option(asio::ip::multicast::outbound_interface{by}, error);
    }
    if (!error) socket_.connect({to, port}, error);
    if (!error) socket_.non_blocking(true, error);
    if (error) return Error{place_ + ": " + error.message()};
    return {};
  }

  void send(std::string_view bytes) override {
    error_code error;
    socket_.send(asio::buffer(bytes.data(), bytes.size()), 0, error);
    // Of an earlier datagram: nobody listened there. This one goes out all the same.
    if (error == asio::error::connection_refused) {
      socket_.send(asio::buffer(bytes.data(), bytes.size()), 0, error);
    }
    if (!error || error == asio::error::connection_refused) return;
    if (lost_++ == 0) news_ = place_ + ": " + error.message();
  }

  void poll(steady_clock::time_point /*now*/) override {
    std::array<char, 64> dropped{};
    for (int i = 0; i < kDroppedAtOnce; ++i) {
      error_code error;
      socket_.receive(asio::buffer(dropped), 0, error);
      if (error) return;
    }
  }
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }
  [[nodiscard]] std::optional<std::string> poll_news() override { return std::exchange(news_, {}); }

 private:
  asio::io_context io_;
  udp::socket socket_{io_};
  std::string place_;
  std::uint64_t lost_ = 0;
  std::optional<std::string> news_;
};

class TcpOutlet final : public Outlet {
 public:
  TcpOutlet(const std::string& address, std::uint16_t port) : place_{place_text(address, port)} {
    error_code error;
    to_ = {asio::ip::make_address_v4(address, error), port};
  }

  void send(std::string_view bytes) override {
    if (state_ != State::connected || waiting_.size() + bytes.size() > kWaitingMax) {
      ++lost_;
      return;
    }
    waiting_ += bytes;
    write();
  }

  void poll(steady_clock::time_point now) override {
    now_ = now;
    if (state_ == State::off && now >= retry_at_) connect();
    io_.restart();
    io_.poll();
  }
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }
  [[nodiscard]] std::optional<std::string> poll_news() override { return std::exchange(news_, {}); }

 private:
  enum class State : std::uint8_t { off, connecting, connected };

  void connect() {
    state_ = State::connecting;
    socket_ = tcp::socket{io_};
    socket_.async_connect(to_, [this](const error_code& error) {
      if (error) return end(error);
      state_ = State::connected;
      news_ = place_ + ": connected";
      told_ = false;
      read();
    });
  }
  void read() {
    socket_.async_read_some(asio::buffer(dropped_), [this](const error_code& error, std::size_t) {
      if (error) return end(error);
      read();
    });
  }
  void write() {
    if (!writing_.empty() || waiting_.empty()) return;
    std::swap(writing_, waiting_);
    asio::async_write(socket_, asio::buffer(writing_),
                      [this](const error_code& error, std::size_t) {
                        if (error) return end(error);
                        writing_.clear();
                        write();
                      });
  }
  /// What was on its way is lost; the next connection begins with a whole event.
  void end(const error_code& error) {
    if (error == asio::error::operation_aborted || state_ == State::off) return;
    if (!told_) news_ = place_ + ": " + error.message() + "; it is tried again";
    told_ = true;
    state_ = State::off;
    retry_at_ = now_ + kTcpRetry;
    error_code ignored;
    socket_.close(ignored);
    waiting_.clear();
    writing_.clear();
  }

  asio::io_context io_;
  tcp::socket socket_{io_};
  tcp::endpoint to_;
  std::string place_;
  State state_ = State::off;
  steady_clock::time_point now_;
  steady_clock::time_point retry_at_ = steady_clock::time_point::min();
  std::string waiting_;
  std::string writing_;  ///< the system has its address
  std::array<char, 1024> dropped_{};
  bool told_ = false;  ///< of this failure
  std::uint64_t lost_ = 0;
  std::optional<std::string> news_;
};

}  // namespace

Result<std::unique_ptr<Outlet>> open_udp(const std::string& address, std::uint16_t port,
                                         const std::string& interface) {
  auto outlet = std::make_unique<UdpOutlet>();
  if (const auto opened = outlet->open(address, port, interface); !opened) return opened.error();
  return std::unique_ptr<Outlet>{std::move(outlet)};
}

std::unique_ptr<Outlet> open_tcp(const std::string& address, std::uint16_t port) {
  return std::make_unique<TcpOutlet>(address, port);
}

struct Inlet::Socket {
  asio::io_context io{};
  udp::socket socket{io};
};

Inlet::Inlet(std::unique_ptr<Socket> socket) : socket_{std::move(socket)} {}
Inlet::Inlet(Inlet&&) noexcept = default;
Inlet& Inlet::operator=(Inlet&&) noexcept = default;
Inlet::~Inlet() = default;

Result<Inlet> Inlet::open(const std::string& address, std::uint16_t port,
                          const std::string& group) {
  auto made = std::make_unique<Socket>();
  udp::socket& socket = made->socket;
  error_code error;
  const auto own = asio::ip::make_address_v4(address, error);
  const auto joined = group.empty() ? own : asio::ip::make_address_v4(group, error);
  if (!error) socket.open(udp::v4(), error);
  // TAK programs on this machine listen to the same multicast.
  if (!error && !group.empty()) socket.set_option(udp::socket::reuse_address{true}, error);
  if (!error) socket.bind({joined, port}, error);
  if (!error && !group.empty()) {
    socket.set_option(asio::ip::multicast::join_group{joined, own}, error);
  }
  if (!error) socket.non_blocking(true, error);
  if (error) return Error{place_text(joined.to_string(), port) + ": " + error.message()};
  return Inlet{std::move(made)};
}

std::optional<std::string> Inlet::poll(std::size_t size_max) {
  std::string datagram(size_max + 1, '\0');
  error_code error;
  datagram.resize(socket_->socket.receive(asio::buffer(datagram), 0, error));
  if (error) return std::nullopt;
  return datagram;
}

std::uint16_t Inlet::port() const {
  error_code error;
  return socket_->socket.local_endpoint(error).port();
}

}  // namespace skein::agencies
