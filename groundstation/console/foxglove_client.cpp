// SPDX-License-Identifier: Apache-2.0
#include <deque>

#include "clients.hpp"

namespace skein::console {
namespace {

constexpr std::size_t kTextMax = 1U << 18U;     ///< a subscription to every topic
constexpr std::size_t kTextsMax = 65'536;       ///< that wait
constexpr std::size_t kBacklogMax = 4U << 20U;  ///< bytes that wait; then records are left out

/// A client that speaks as Foxglove does. Records that it does not take in time are left out.
class FoxgloveClient final : public LiveClient,
                             public std::enable_shared_from_this<FoxgloveClient> {
 public:
  FoxgloveClient(Hub& hub, std::unique_ptr<WebSocket> socket, std::string cookies,
                 std::shared_ptr<Connections::Place> place)
      : hub_{hub},
        socket_{std::move(socket)},
        cookies_{std::move(cookies)},
        place_{std::move(place)} {}
  ~FoxgloveClient() override { hub_.leave(*this); }
  FoxgloveClient(const FoxgloveClient&) = delete;
  FoxgloveClient& operator=(const FoxgloveClient&) = delete;

  void run(std::string_view protocol) {
    socket_->accept(protocol, kTextMax, [self = shared_from_this()](bool ok) {
      if (!ok) return;
      self->hub_.join(*self);
      self->say(FoxgloveSession::server_info("skein-ground", self->hub_.run_id()));
      self->say(FoxgloveSession::advertise(self->hub_.channels()));
      self->read();
    });
  }

  void on_log_out() override {
    if (!has_session()) stop();
  }
  void on_channel(const LiveChannel& channel) override {
    say(FoxgloveSession::advertise({&channel, 1}));
  }
  void on_record(std::uint32_t channel, const Server::LiveRecord& record) override {
    if (waiting_bytes_ > kBacklogMax) return;
    if (auto message = session_.record(channel, record.time_ns, record.bytes)) {
      push({true, std::move(*message)});
    }
  }

 private:
  void read() {
    socket_->read([self = shared_from_this()](const std::optional<WebSocket::Text>& text) {
      if (!text) return self->stop();
      if (!text->binary && !self->session_.on_text(text->bytes)) return self->stop();
      self->read();
    });
  }
  void say(std::string text) {
    if (texts_.size() > kTextsMax) return stop();
    push({false, std::move(text)});
  }
  void push(WebSocket::Text text) {
    waiting_bytes_ += text.bytes.size();
    texts_.push_back(std::move(text));
    write();
  }
  void write() {
    if (writing_ || stopped_ || texts_.empty()) return;
    if (!has_session()) return stop();
    writing_ = true;
    const WebSocket::Text& text = texts_.front();
    socket_->write(text.bytes, text.binary, [self = shared_from_this()](bool ok) {
      self->writing_ = false;
      self->waiting_bytes_ -= self->texts_.front().bytes.size();
      self->texts_.pop_front();
      if (!ok) return self->stop();
      self->write();
    });
  }
  [[nodiscard]] bool has_session() {
    return hub_.gate().identify(cookies_, std::chrono::steady_clock::now()).has_value();
  }
  void stop() {
    stopped_ = true;
    hub_.leave(*this);
    socket_->drop();
  }

  Hub& hub_;
  std::unique_ptr<WebSocket> socket_;
  std::string cookies_;
  std::shared_ptr<Connections::Place> place_;
  FoxgloveSession session_;
  std::deque<WebSocket::Text> texts_;
  std::size_t waiting_bytes_ = 0;
  bool writing_ = false;
  bool stopped_ = false;
};

}  // namespace

void serve_foxglove(Hub& hub, std::unique_ptr<WebSocket> socket, std::string_view protocol,
                    std::string cookies, std::shared_ptr<Connections::Place> place) {
  std::make_shared<FoxgloveClient>(hub, std::move(socket), std::move(cookies), std::move(place))
      ->run(protocol);
}

}  // namespace skein::console
