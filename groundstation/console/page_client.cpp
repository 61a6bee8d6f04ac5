// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <deque>

#include "clients.hpp"
#include "page_text.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

constexpr std::size_t kTextMax = 4096;
constexpr std::size_t kAnswersMax = 256;  ///< that wait for a slow client
constexpr int kTextsPerSecond = 20;

/// A client of the page's socket.
class PageClient final : public Client, public std::enable_shared_from_this<PageClient> {
 public:
  PageClient(Hub& hub, std::unique_ptr<WebSocket> socket, Identity identity, std::string cookies,
             std::shared_ptr<Connections::Place> place)
      : hub_{hub},
        socket_{std::move(socket)},
        identity_{std::move(identity)},
        cookies_{std::move(cookies)},
        place_{std::move(place)} {}
  ~PageClient() override { hub_.leave(*this); }
  PageClient(const PageClient&) = delete;
  PageClient& operator=(const PageClient&) = delete;

  void run() {
    socket_->accept(kPageProtocol, kTextMax, [self = shared_from_this()](bool ok) {
      if (!ok) return;
      self->hub_.join(*self);
      self->say(self->hub_.hello(self->identity_));
      self->read();
    });
  }

  void on_log_out() override {
    if (!has_session()) close();
  }
  void on_news() override { write(); }
  void on_end(const std::string& text, std::shared_ptr<void> sent) override {
    last_words_ = text;
    last_sent_ = std::move(sent);
    write();
  }
  void on_restart(const std::string& history, std::uint64_t next_seq) override {
    if (!resumed_) return;
    seen_.next_seq = std::min(seen_.next_seq, next_seq);
    say(history);
  }

 private:
  void read() {
    socket_->read([self = shared_from_this()](std::optional<WebSocket::Text> text) {
      if (!text) return self->stop();
      if (!self->in_time() || !self->on_text(text->bytes)) return self->close();
      self->read();
    });
  }

  /// Not more than kTextsPerSecond.
  [[nodiscard]] bool in_time() {
    const auto now = std::chrono::steady_clock::now();
    if (now - second_begun_ >= std::chrono::seconds{1}) {
      second_begun_ = now;
      texts_ = 0;
    }
    return ++texts_ <= kTextsPerSecond;
  }

  /// False for what no page of ours says.
  [[nodiscard]] bool on_text(const std::string& text) {
    auto parsed = parse_page_text(text);
    if (!parsed) return false;
    return std::visit([this](auto& said) { return on(said); }, *parsed);
  }

  bool on(const PingText& ping) {
    say(codec::json_text({{"type", "pong"}, {"id", ping.id}, {"time_s", hub_.board().time_s()}}));
    return true;
  }

  bool on(const ResumeText& resume) {
    if (asked_) return false;
    asked_ = true;
    seen_.next_seq = resume.next_seq;
    // From a later time than ours: of another run.
    if (seen_.next_seq > hub_.board().next_seq()) seen_.next_seq = 0;
    return hub_.submit(Server::Join{[hub = &hub_, self = weak()](const std::string& series) {
      hub->post([self, series] {
        if (const auto client = self.lock()) client->begin(series);
      });
    }});
  }

  void begin(const std::string& series) {
    // A replay may have been wound back meanwhile.
    seen_.next_seq = std::min(seen_.next_seq, hub_.board().next_seq());
    say(hub_.board().history(series));
    resumed_ = true;
    write();
  }

  bool on(LineText& text) {
    if (!has_session()) return false;
    Server::Line given;
    given.line = std::move(text.line);
    given.user = identity_.user;
    given.may_order = identity_.role == Role::op;
    given.order = std::move(text.order);
    // Called on other threads: only the server's may be the last to hold a client.
    given.reply = [hub = &hub_, self = weak(), id = text.id](bool done, const std::string& said,
                                                             const std::string& data) {
      hub->post([self, answer = fmt::format(
                           R"({{"type":"answer","id":{},"done":{},"text":{},"data":{}}})", id, done,
                           codec::json_text(said), data.empty() ? "null" : data)] {
        if (const auto client = self.lock()) client->say(answer);
      });
    };
    const auto reply = given.reply;
    if (!hub_.submit(std::move(given))) reply(false, "the ground station is too busy\n", "");
    return true;
  }

  [[nodiscard]] std::weak_ptr<PageClient> weak() { return weak_from_this(); }

  void say(std::string text) {
    if (answers_.size() >= kAnswersMax) return stop();
    answers_.push_back(std::move(text));
    write();
  }

  [[nodiscard]] bool has_session() {
    return hub_.gate().identify(cookies_, std::chrono::steady_clock::now()).has_value();
  }

  /// What was asked for first, then events, then the newest state, then the last words: one text at
  /// a time.
  void write() {
    if (writing_ || stopped_) return;
    if (!has_session()) return close();
    if (!answers_.empty()) {
      text_ = std::move(answers_.front());
      answers_.pop_front();
    } else if (resumed_ && hub_.board().has_events(seen_)) {
      text_ = hub_.board().events(seen_);
    } else if (resumed_ && hub_.board().has_state(seen_)) {
      text_ = hub_.board().state(seen_);
    } else if (!last_words_.empty()) {
      text_ = std::exchange(last_words_, {});
    } else {
      last_sent_.reset();
      return;
    }
    writing_ = true;
    socket_->write(text_, false, [self = shared_from_this()](bool ok) {
      self->writing_ = false;
      if (!ok) return self->stop();
      self->write();
    });
  }

  /// Of whoever breaks a rule.
  void close() {
    if (stopped_) return;
    stopped_ = true;
    last_sent_.reset();
    hub_.leave(*this);
    if (writing_) return socket_->drop();  // a close may not overtake a text
    socket_->close_for_policy([self = shared_from_this()] {});
  }
  void stop() {
    stopped_ = true;
    last_sent_.reset();
    hub_.leave(*this);
    socket_->drop();
  }

  Hub& hub_;
  std::unique_ptr<WebSocket> socket_;
  Identity identity_;
  std::string cookies_;
  std::shared_ptr<Connections::Place> place_;
  std::deque<std::string> answers_;
  std::string text_;  ///< that is being written
  std::string last_words_;
  std::shared_ptr<void> last_sent_;  ///< let go when these are
  Board::Seen seen_;
  bool asked_ = false;    ///< to resume
  bool resumed_ = false;  ///< has its history
  bool writing_ = false;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point second_begun_{};
  int texts_ = 0;
};

}  // namespace

void serve_page(Hub& hub, std::unique_ptr<WebSocket> socket, const Identity& identity,
                std::string cookies, std::shared_ptr<Connections::Place> place) {
  std::make_shared<PageClient>(hub, std::move(socket), identity, std::move(cookies),
                               std::move(place))
      ->run();
}

}  // namespace skein::console
