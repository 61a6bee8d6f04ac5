// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <boost/asio.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstdint>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "board.hpp"
#include "foxglove.hpp"
#include "gate.hpp"
#include "pages.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/console/server.hpp"

namespace skein::console {

inline constexpr std::size_t kRequestsMax = 256;
inline constexpr int kPublicationsMax = 4;
inline constexpr std::size_t kLoginsMax = 4;  ///< that wait; each takes some 0.1 s

/// One that shows the page.
class Client {
 public:
  Client() = default;
  virtual ~Client() = default;
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  virtual void on_news() = 0;
  virtual void on_restart(const std::string& history, std::uint64_t next_seq) = 0;
};

/// One that speaks as Foxglove does.
class LiveClient {
 public:
  LiveClient() = default;
  virtual ~LiveClient() = default;
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;
  virtual void on_channel(const LiveChannel& channel) = 0;
  virtual void on_record(std::uint32_t channel, const Server::LiveRecord& record) = 0;
};

/// What all connections share. Everything but the requests belongs to the server's thread.
class Server::Impl {
 public:
  Impl(ServerConfig config, std::function<void()> on_request)
      : config_{std::move(config)},
        on_request_{std::move(on_request)},
        gate_{std::move(config_.users), !config_.certificate.empty()},
        run_{random_hex(8)} {}
  ~Impl() {
    logins_.stop();
    context_.stop();
    if (thread_.joinable()) thread_.join();
    logins_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<void> open();

  [[nodiscard]] std::string hello(const Identity& identity) const;
  /// False when too many wait.
  bool submit(Request request) {
    {
      const std::lock_guard lock{requests_mutex_};
      if (!requests_.push(std::move(request))) return false;
    }
    on_request_();
    return true;
  }
  std::optional<Request> next() {
    const std::lock_guard lock{requests_mutex_};
    return requests_.pop();
  }
  /// Work for the server's thread.
  template <class F>
  void post(F work) {
    boost::asio::post(context_, std::move(work));
  }
  /// From another thread. Where the server's is behind, a state is left out: a newer one comes.
  void publish_soon(double time_s, Sections sections) {
    if (publications_ >= kPublicationsMax) return;
    ++publications_;
    post([this, time_s, sections = std::move(sections)]() mutable {
      --publications_;
      publish(time_s, std::move(sections));
    });
  }
  void publish(double time_s, Sections sections) {
    board_.publish(time_s, std::move(sections));
    tell_all();
  }
  void append(std::vector<std::string> events) {
    board_.append(std::move(events));
    tell_all();
  }
  void restart(std::uint64_t next_seq, const std::string& series) {
    board_.truncate(next_seq);
    const std::string history = board_.history(series);
    for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) {
      client->on_restart(history, next_seq);
    }
  }
  void join(Client& client) {
    clients_.insert(&client);
    watched_ = true;
  }
  void leave(Client& client) {
    clients_.erase(&client);
    watched_ = !clients_.empty();
  }
  void live(const LiveRecord& record) {
    auto channel = std::find_if(channels_.begin(), channels_.end(),
                                [&](const auto& known) { return known.topic == record.topic; });
    const std::vector<LiveClient*> all{live_clients_.begin(), live_clients_.end()};
    if (channel == channels_.end()) {
      channels_.push_back({static_cast<std::uint32_t>(channels_.size() + 1), record.topic,
                           std::string{record.schema_name}, std::string{record.schema}});
      channel = std::prev(channels_.end());
      for (LiveClient* client : all) client->on_channel(*channel);
    }
    for (LiveClient* client : all) client->on_record(channel->id, record);
  }
  void join(LiveClient& client) {
    live_clients_.insert(&client);
    live_watched_ = true;
  }
  void leave(LiveClient& client) {
    live_clients_.erase(&client);
    live_watched_ = !live_clients_.empty();
  }
  [[nodiscard]] const std::vector<LiveChannel>& channels() const { return channels_; }
  [[nodiscard]] const std::string& run_id() const { return run_; }
  [[nodiscard]] bool live_watched() const { return live_watched_; }

  /// Checks a password on a thread of its own. False when too many wait.
  bool log_in(std::string user, std::string password,
              std::function<void(std::optional<Identity>)> done) {
    if (logins_waiting_ >= kLoginsMax) return false;
    ++logins_waiting_;
    boost::asio::post(logins_, [this, user = std::move(user), password = std::move(password),
                                done = std::move(done)]() mutable {
      auto identity = gate_.check(user, password);
      post([this, identity = std::move(identity), done = std::move(done)] {
        --logins_waiting_;
        done(identity);
      });
    });
    return true;
  }

  [[nodiscard]] Gate& gate() { return gate_; }
  [[nodiscard]] const Pages& pages() const { return *pages_; }
  [[nodiscard]] const Board& board() const { return board_; }
  [[nodiscard]] bool watched() const { return watched_; }
  [[nodiscard]] std::string url() const;

  /// Counts a connection as long as it lives.
  class Place {
   public:
    explicit Place(Impl& impl) : impl_{&impl} { ++impl.connections_; }
    ~Place() { --impl_->connections_; }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    Impl* impl_;
  };

 private:
  void tell_all() {
    for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) client->on_news();
  }
  void run();
  void accept();
  void serve(boost::asio::ip::tcp::socket socket);

  ServerConfig config_;
  std::function<void()> on_request_;
  Gate gate_;
  std::string run_;
  nlohmann::json hello_;
  std::optional<Pages> pages_;
  Board board_;
  std::optional<boost::asio::ssl::context> tls_;
  std::uint16_t port_ = 0;
  std::size_t logins_waiting_ = 0;
  std::size_t connections_ = 0;
  std::set<Client*> clients_;
  std::atomic<bool> watched_{false};
  std::atomic<int> publications_{0};  ///< that wait for the server's thread
  std::vector<LiveChannel> channels_;
  std::set<LiveClient*> live_clients_;
  std::atomic<bool> live_watched_{false};
  std::mutex requests_mutex_;
  BoundedQueue<Request> requests_{kRequestsMax};
  boost::asio::io_context context_{1};  // last but one: its connections use what stands above
  boost::asio::ip::tcp::acceptor acceptor_{context_};
  boost::asio::steady_timer accept_again_{context_};
  boost::asio::thread_pool logins_{1};
  std::thread thread_;
};

}  // namespace skein::console
