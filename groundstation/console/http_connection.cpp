// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>

#include "clients.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

/// "/?token=TOKEN"; empty where there is none.
std::string_view token_in(std::string_view target) {
  constexpr std::string_view kToken = "?token=";
  const auto at = target.find(kToken);
  return at == std::string_view::npos ? std::string_view{} : target.substr(at + kToken.size());
}

bool offers(const HttpRequest& request, std::string_view protocol) {
  const auto& offered = request.subprotocols;
  return std::find(offered.begin(), offered.end(), protocol) != offered.end();
}

HttpResponse refusal(HttpStatus status, const char* why) {
  return {status, media::kJson, codec::json_text({{"error", why}})};
}

/// A connection that speaks HTTP, until it asks for the socket.
class HttpConnection final : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Hub& hub, std::unique_ptr<HttpStream> stream, std::string address, bool local)
      : hub_{hub}, stream_{std::move(stream)}, address_{std::move(address)}, local_{local} {}

  void run() {
    place_ = hub_.connections().enter(address_, [self = weak_from_this()] {
      const auto connection = self.lock();
      if (connection && connection->stream_) connection->stream_->drop();
    });
    if (!place_) return;
    stream_->handshake([self = shared_from_this()](bool ok) {
      if (ok) self->read();
    });
  }

 private:
  void read() {
    stream_->read([self = shared_from_this()](std::optional<HttpRequest> request) {
      if (!request) return self->stream_->close();
      request->local = self->local_;
      self->handle(*request);
    });
  }

  void handle(const HttpRequest& request) {
    if (request.wants_socket) return upgrade(request);
    if (request.target == "/session" && request.method == HttpMethod::post) return log_in(request);
    if (request.target == "/session" && request.method == HttpMethod::remove) {
      return send(
          {HttpStatus::ok, media::kJson, "{}", {{"Set-Cookie", hub_.log_out(request.cookie)}}});
    }
    auto told = hub_.machine_pages().respond(request, std::chrono::steady_clock::now());
    send(told ? *std::move(told) : hub_.pages().respond(request));
  }

  void upgrade(const HttpRequest& request) {
    const Gate& gate = hub_.gate();
    const auto refuse = [this](HttpStatus status, const char* why) {
      send({status, media::kText, std::string{why} + "\n"});
    };
    if (!gate.is_own_host(request.host) || !gate.is_own_origin(request.origin, request.host)) {
      return refuse(HttpStatus::forbidden, "the socket is for this server's own page");
    }
    const auto now = std::chrono::steady_clock::now();
    std::string cookie = request.cookie;
    auto identity = gate.identify(cookie, now);
    if (!identity && gate.asks_for_token()) {
      // Of programs that keep no cookies: ws://127.0.0.1:7460/?token=...
      identity = gate.check(token_in(request.target));
      if (identity) cookie = hub_.gate().admit(*identity, now);
    }
    if (!identity) return refuse(HttpStatus::unauthorized, "log in first");
    place_->has_session();
    for (const std::string_view protocol : kFoxgloveProtocols) {
      if (!offers(request, protocol)) continue;
      return serve_foxglove(hub_, stream_->upgrade(), protocol, cookie, place_);
    }
    if (request.target != "/socket" || !offers(request, kPageProtocol)) {
      return refuse(HttpStatus::bad_request, "the socket is at /socket and speaks skein.console.1");
    }
    serve_page(hub_, stream_->upgrade(), *identity, request.cookie, place_);
  }

  void log_in(const HttpRequest& request) {
    if (!hub_.gate().is_own_origin(request.origin, request.host)) {
      return send(refusal(HttpStatus::forbidden, "the login is for this server's own page"));
    }
    if (!hub_.gate().asks_for_password() && !hub_.gate().asks_for_token()) {
      return send(refusal(HttpStatus::bad_request, "nobody needs to log in here"));
    }
    const auto json = codec::parse_json(request.body);
    if (!json.is_object() || !json.contains("user") || !json.contains("password") ||
        !json["user"].is_string() || !json["password"].is_string()) {
      return send(refusal(HttpStatus::bad_request, "a login has a user and a password"));
    }
    const auto taken = hub_.log_in(
        address_, json["user"], json["password"],
        [self = shared_from_this()](const std::optional<Identity>& identity) {
          if (!identity) {
            return self->send(refusal(HttpStatus::unauthorized, "wrong user or password"));
          }
          const auto now = std::chrono::steady_clock::now();
          self->send(
              {HttpStatus::ok,
               media::kJson,
               codec::json_text({{"user", identity->user}, {"role", to_string(identity->role)}}),
               {{"Set-Cookie", self->hub_.gate().admit(*identity, now)}}});
        });
    if (!taken) send(refusal(HttpStatus::too_many_requests, taken.error().message.c_str()));
  }

  void send(HttpResponse response) {
    response.last = ++answers_ >= kAnswersMax;
    stream_->write(std::move(response), [self = shared_from_this()](bool more) {
      if (!more) return self->stream_->close();
      self->read();
    });
  }

  static constexpr int kAnswersMax = 1000;

  Hub& hub_;
  std::unique_ptr<HttpStream> stream_;
  std::string address_;
  bool local_;
  std::shared_ptr<Connections::Place> place_;
  int answers_ = 0;
};

}  // namespace

void serve_http(Hub& hub, std::unique_ptr<HttpStream> stream, std::string address, bool local) {
  std::make_shared<HttpConnection>(hub, std::move(stream), std::move(address), local)->run();
}

}  // namespace skein::console
