// SPDX-License-Identifier: Apache-2.0
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "clients.hpp"
#include "json_text.hpp"

namespace skein::console {
namespace {

namespace http = boost::beast::http;
using Json = nlohmann::json;

/// Does the request offer this subprotocol?
bool offers(const HttpRequest& request, std::string_view protocol) {
  http::token_list offered{request[http::field::sec_websocket_protocol]};
  return offered.exists({protocol.data(), protocol.size()});
}

/// A connection that speaks HTTP, until it asks for the socket.
class HttpConnection final : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Server::Impl& server, std::unique_ptr<HttpStream> stream)
      : server_{server},
        stream_{std::move(stream)},
        place_{std::make_shared<Server::Impl::Place>(server)} {}

  void run() {
    stream_->handshake([self = shared_from_this()](bool ok) {
      if (ok) self->read();
    });
  }

 private:
  void read() {
    stream_->read([self = shared_from_this()](std::optional<HttpRequest> request) {
      if (!request) return self->stream_->close();
      self->handle(*request);
    });
  }

  void handle(const HttpRequest& request) {
    if (boost::beast::websocket::is_upgrade(request)) return upgrade(request);
    if (request.target() == "/session" && request.method() == http::verb::post) {
      return log_in(request);
    }
    if (request.target() == "/session" && request.method() == http::verb::delete_) {
      HttpResponse response = answer(request, http::status::ok, "application/json", "{}");
      response.set(http::field::set_cookie,
                   server_.gate().dismiss(view(request[http::field::cookie])));
      return send(std::move(response));
    }
    send(server_.pages().respond(request));
  }

  void upgrade(const HttpRequest& request) {
    const Gate& gate = server_.gate();
    const auto host = view(request[http::field::host]);
    const auto refuse = [&](http::status status, const char* why) {
      send(answer(request, status, "text/plain; charset=utf-8", std::string{why} + "\n"));
    };
    if (!gate.is_own_host(host) || !gate.is_own_origin(view(request[http::field::origin]), host)) {
      return refuse(http::status::forbidden, "the socket is for this server's own page");
    }
    const auto identity =
        gate.identify(view(request[http::field::cookie]), std::chrono::steady_clock::now());
    if (!identity) return refuse(http::status::unauthorized, "log in first");
    for (const std::string_view protocol : kFoxgloveProtocols) {
      if (!offers(request, protocol)) continue;
      return serve_foxglove(server_, stream_->upgrade(), protocol, place_, request);
    }
    if (request.target() != "/socket" || !offers(request, kPageProtocol)) {
      return refuse(http::status::bad_request,
                    "the socket is at /socket and speaks skein.console.1");
    }
    serve_page(server_, stream_->upgrade(), *identity, place_, request);
  }

  void log_in(const HttpRequest& request) {
    const auto refuse = [this, request](http::status status, const char* why) {
      send(answer(request, status, "application/json", text_of({{"error", why}})));
    };
    const auto host = view(request[http::field::host]);
    if (!server_.gate().is_own_origin(view(request[http::field::origin]), host)) {
      return refuse(http::status::forbidden, "the login is for this server's own page");
    }
    if (!server_.gate().asks_for_password()) {
      return refuse(http::status::bad_request, "nobody needs to log in here");
    }
    const Json json = Json::parse(request.body(), nullptr, false);
    if (!json.is_object() || !json.contains("user") || !json.contains("password") ||
        !json["user"].is_string() || !json["password"].is_string()) {
      return refuse(http::status::bad_request, "a login has a user and a password");
    }
    const bool taken = server_.log_in(
        json["user"], json["password"],
        [self = shared_from_this(), request, refuse](std::optional<Identity> identity) {
          if (!identity) return refuse(http::status::unauthorized, "wrong user or password");
          HttpResponse response =
              answer(request, http::status::ok, "application/json",
                     text_of({{"user", identity->user}, {"role", to_string(identity->role)}}));
          response.set(http::field::set_cookie,
                       self->server_.gate().admit(*identity, std::chrono::steady_clock::now()));
          self->send(std::move(response));
        });
    if (!taken) refuse(http::status::too_many_requests, "too many log in at once; try again");
  }

  void send(HttpResponse response) {
    stream_->write(std::move(response), [self = shared_from_this()](bool more) {
      if (!more) return self->stream_->close();
      self->read();
    });
  }

  Server::Impl& server_;
  std::unique_ptr<HttpStream> stream_;
  std::shared_ptr<Server::Impl::Place> place_;
};

}  // namespace

void serve_http(Server::Impl& server, std::unique_ptr<HttpStream> stream) {
  std::make_shared<HttpConnection>(server, std::move(stream))->run();
}

}  // namespace skein::console
