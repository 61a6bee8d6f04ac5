// SPDX-License-Identifier: Apache-2.0
#include "skein/console/server.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "clients.hpp"
#include "json_text.hpp"

namespace skein::console {
namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using asio::ip::tcp;
using boost::system::error_code;
using Json = nlohmann::json;

constexpr std::size_t kConnectionsMax = 64;
constexpr auto kAcceptAgain = std::chrono::milliseconds{200};

bool is_loopback(const std::string& address) {
  error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

}  // namespace

Result<void> Server::Impl::open() {
  if (!is_loopback(config_.address)) {
    if (!gate_.asks_for_password() || config_.certificate.empty() || config_.key.empty()) {
      return Error{"a console on " + config_.address +
                   " needs passwords, a certificate and its key; without them it is served on "
                   "127.0.0.1 only"};
    }
  }
  hello_ = Json::parse(config_.hello, nullptr, false);
  auto pages = Pages::open(config_, gate_);
  if (!pages) return pages.error();
  pages_.emplace(std::move(*pages));
  error_code error;
  if (!config_.certificate.empty()) {
    tls_.emplace(ssl::context::tls_server);
    tls_->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                      ssl::context::no_tlsv1_1);
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
    if (connections_ < kConnectionsMax) serve(std::move(socket));
    accept();
  });
}

void Server::Impl::serve(tcp::socket socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay{true}, ignored);
  serve_http(*this, open_stream(std::move(socket), tls_ ? &*tls_ : nullptr));
}

std::string Server::Impl::hello(const Identity& identity) const {
  Json hello = hello_;
  hello["type"] = "hello";
  hello["run"] = run_;
  hello["role"] = to_string(identity.role);
  hello["user"] = identity.user;
  hello["tiles"] = pages_->tiles() ? Json::parse(pages_->tiles()->description()) : Json(nullptr);
  hello["overlays"] = Json::array();
  for (const Overlay& overlay : config_.overlays) {
    hello["overlays"].push_back({{"name", overlay.name}, {"url", "/overlays/" + overlay.name}});
  }
  return text_of(hello);
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

std::optional<Server::Request> Server::next() { return impl_->next(); }
void Server::publish(double time_s, Sections sections) {
  impl_->publish_soon(time_s, std::move(sections));
}
void Server::append(std::vector<std::string> events) {
  impl_->post([impl = impl_.get(), events = std::move(events)]() mutable {
    impl->append(std::move(events));
  });
}
void Server::restart(std::uint64_t next_seq, const std::string& series) {
  impl_->post([impl = impl_.get(), next_seq, series] { impl->restart(next_seq, series); });
}
void Server::live(LiveRecord record) {
  impl_->post([impl = impl_.get(), record = std::move(record)] { impl->live(record); });
}
bool Server::live_watched() const { return impl_->live_watched(); }
bool Server::watched() const { return impl_->watched(); }
std::string Server::url() const { return impl_->url(); }

}  // namespace skein::console
