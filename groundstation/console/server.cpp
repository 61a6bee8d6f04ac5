// SPDX-License-Identifier: Apache-2.0
#include "skein/console/server.hpp"

#include <fmt/format.h>

#include <boost/asio.hpp>
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "byte_stream.hpp"
#include "clients.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using asio::ip::tcp;
using boost::system::error_code;

/// A client that takes longer does without.
constexpr auto kLastWordsTake = std::chrono::milliseconds{500};
constexpr auto kAcceptAgain = std::chrono::milliseconds{200};

bool is_loopback(const std::string& address) {
  error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

}  // namespace

/// The threads and sockets below the hub.
class Server::Impl {
 public:
  Impl(ServerConfig config, std::function<void()> on_request)
      : config_{std::move(config)},
        hub_{config_, std::move(on_request),
             [this](auto work) { asio::post(context_, std::move(work)); },
             [this](auto work) { asio::post(logins_, std::move(work)); }} {}
  ~Impl() {
    logins_.stop();
    context_.stop();
    if (thread_.joinable()) thread_.join();
    logins_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<void> open();
  [[nodiscard]] Hub& hub() { return hub_; }
  [[nodiscard]] std::string url() const;

 private:
  void run();
  void accept();
  void serve(tcp::socket socket);

  ServerConfig config_;
  Hub hub_;
  std::optional<ssl::context> tls_;
  std::uint16_t port_ = 0;
  asio::io_context context_{1};  // last but few: its connections use what stands above
  tcp::acceptor acceptor_{context_};
  asio::steady_timer accept_again_{context_};
  asio::thread_pool logins_{1};
  std::thread thread_;
};

Result<void> Server::Impl::open() {
  if (!is_loopback(config_.address)) {
    if (!config_.log_in || config_.certificate.empty() || config_.key.empty()) {
      return Error{"a console on " + config_.address +
                   " needs passwords, a certificate and its key; without them it is served on "
                   "127.0.0.1 only"};
    }
  }
  if (auto opened = hub_.open(); !opened) return opened.error();
  error_code error;
  if (!config_.certificate.empty()) {
    tls_.emplace(ssl::context::tls_server);
    tls_->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                      ssl::context::no_tlsv1_1);
    // Of TLS 1.2 what keeps its secrets and is authenticated encryption; TLS 1.3 has no other.
    if (SSL_CTX_set_cipher_list(tls_->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20") != 1) {
      return Error{"this OpenSSL has no modern cipher suites for TLS 1.2"};
    }
    tls_->use_certificate_chain_file(config_.certificate, error);
    if (error) return Error{config_.certificate + ": no certificate: " + error.message()};
    tls_->use_private_key_file(config_.key, ssl::context::pem, error);
    if (error) return Error{config_.key + ": not the certificate's key: " + error.message()};
  }
  const auto address = asio::ip::make_address(config_.address, error);
  if (error)
    return Error{"'" + config_.address +
                 "' is no address; the console wants one such as 127.0.0.1"};
  const tcp::endpoint endpoint{address, config_.port};
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address{true}, error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    return Error{fmt::format("the console cannot listen on {} port {}: {}", config_.address,
                             config_.port, error.message())};
  }
  port_ = acceptor_.local_endpoint(error).port();
  accept();
  thread_ = std::thread{[this] { run(); }};
  return {};
}

void Server::Impl::run() {
  while (true) {
    try {
      context_.run();
      return;
      // NOLINTNEXTLINE(bugprone-empty-catch)
    } catch (const std::exception&) {
      // A file that cannot be read, say: it ends one connection, not the ground station.
    }
  }
}

void Server::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // no descriptors, for instance
      accept_again_.expires_after(kAcceptAgain);
      accept_again_.async_wait([this](error_code stopped) {
        if (!stopped) accept();
      });
      return;
    }
    serve(std::move(socket));
    accept();
  });
}

void Server::Impl::serve(tcp::socket socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay{true}, ignored);
  const auto peer = socket.remote_endpoint(ignored);
  if (ignored) return;  // it has gone already
  auto bytes = tls_ ? open_tls(std::move(socket), *tls_) : open_plain(std::move(socket));
  serve_http(hub_, open_http(std::move(bytes), tls_.has_value()), peer.address().to_string(),
             peer.address().is_loopback());
}

std::string Server::Impl::url() const {
  const bool six = config_.address.find(':') != std::string::npos;
  return fmt::format("{}://{}{}{}:{}/", tls_ ? "https" : "http", six ? "[" : "", config_.address,
                     six ? "]" : "", port_);
}

Server::Server(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::open(ServerConfig config,
                                             std::function<void()> on_request) {
  auto impl = std::make_unique<Impl>(std::move(config), std::move(on_request));
  if (auto opened = impl->open(); !opened) return opened.error();
  return std::unique_ptr<Server>{new Server{std::move(impl)}};
}

std::optional<Server::Request> Server::next() { return impl_->hub().next(); }
void Server::publish(double time_s, Sections sections) {
  impl_->hub().publish_soon(time_s, std::move(sections));
}
void Server::append(std::vector<std::string> events) {
  Hub& hub = impl_->hub();
  hub.post([&hub, events = std::move(events)]() mutable { hub.append(std::move(events)); });
}
void Server::report(MachineReport report) {
  Hub& hub = impl_->hub();
  hub.post([&hub, report = std::move(report)]() mutable { hub.report(std::move(report)); });
}
void Server::expel(const std::string& user) {
  Hub& hub = impl_->hub();
  hub.post([&hub, user] { hub.expel(user); });
}
void Server::end(double time_s, const std::string& text) {
  Hub& hub = impl_->hub();
  const auto promise = std::make_shared<std::promise<void>>();
  auto all_sent = promise->get_future();
  auto sent = std::shared_ptr<void>{nullptr, [promise](void*) { promise->set_value(); }};
  hub.post([&hub, sent = std::move(sent),
            said = fmt::format(R"({{"type":"ended","time_s":{:.3f},"text":{}}})", time_s,
                               codec::json_text(text))] { hub.end(said, sent); });
  all_sent.wait_for(kLastWordsTake);
}
void Server::restart(std::uint64_t next_seq, const std::string& series) {
  Hub& hub = impl_->hub();
  hub.post([&hub, next_seq, series] { hub.restart(next_seq, series); });
}
void Server::live(LiveRecord record) {
  Hub& hub = impl_->hub();
  hub.post([&hub, record = std::move(record)] { hub.live(record); });
}
bool Server::live_watched() const { return impl_->hub().live_watched(); }
bool Server::watched() const { return impl_->hub().watched(); }
std::string Server::url() const { return impl_->url(); }

}  // namespace skein::console
