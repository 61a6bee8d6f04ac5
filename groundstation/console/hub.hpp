// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "board.hpp"
#include "connections.hpp"
#include "foxglove.hpp"
#include "gate.hpp"
#include "login_waits.hpp"
#include "machine_pages.hpp"
#include "pages.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/console/server.hpp"

namespace skein::console {

/// One that shows the page.
class Client {
 public:
  Client() = default;
  virtual ~Client() = default;
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  /// A session has ended: its own, perhaps.
  virtual void on_log_out() = 0;
  virtual void on_news() = 0;
  /// After all that it has not been sent yet. `sent` is let go when it has gone out.
  virtual void on_end(const std::string& text, std::shared_ptr<void> sent) = 0;
  virtual void on_restart(const std::string& history, std::uint64_t next_seq) = 0;
};

/// One that speaks as Foxglove does.
class LiveClient {
 public:
  LiveClient() = default;
  virtual ~LiveClient() = default;
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;
  virtual void on_log_out() = 0;
  virtual void on_channel(const LiveChannel& channel) = 0;
  virtual void on_record(std::uint32_t channel, const Server::LiveRecord& record) = 0;
};

/// What all connections share. Everything but the requests belongs to the server's thread.
class Hub {
 public:
  /// Has that done later, by some thread.
  using Post = std::function<void(std::function<void()>)>;

  /// `post` is to the server's thread, `post_login` to another. `on_request` as for Server.
  /// `config` must outlive this.
  Hub(const ServerConfig& config, std::function<void()> on_request, Post post, Post post_login);
  /// Reads the files of the pages.
  [[nodiscard]] Result<void> open();

  // --- from any thread ---------------------------------------------------------------------------
  /// False when too many wait.
  bool submit(Server::Request request);
  [[nodiscard]] std::optional<Server::Request> next();
  void post(std::function<void()> work) const { post_(std::move(work)); }
  /// Where the server's thread is behind, a state is left out: a newer one comes.
  void publish_soon(double time_s, Sections sections);
  [[nodiscard]] bool watched() const { return watched_; }
  [[nodiscard]] bool live_watched() const { return live_watched_; }

  // --- from the server's thread ------------------------------------------------------------------
  void append(std::vector<std::string> events);
  void restart(std::uint64_t next_seq, const std::string& series);
  void end(const std::string& text, const std::shared_ptr<void>& sent);
  void live(const Server::LiveRecord& record);
  void report(Server::MachineReport report);

  void join(Client& client);
  void leave(Client& client);
  void join(LiveClient& client);
  void leave(LiveClient& client);

  /// Checks a password on the thread for that. Else why it is not looked at now.
  Result<void> log_in(const std::string& address, std::string user, std::string password,
                      std::function<void(std::optional<Identity>)> done);
  /// Ends the session and what is open by it.
  [[nodiscard]] std::string log_out(std::string_view cookies);
  /// As of Server.
  void expel(const std::string& user);

  [[nodiscard]] std::string hello(const Identity& identity) const;
  [[nodiscard]] Gate& gate() { return gate_; }
  [[nodiscard]] const Pages& pages() const { return *pages_; }
  [[nodiscard]] const MachinePages& machine_pages() const { return machine_pages_; }
  [[nodiscard]] const Board& board() const { return board_; }
  [[nodiscard]] const std::vector<LiveChannel>& channels() const { return channels_; }
  [[nodiscard]] const std::string& run_id() const { return run_; }

  [[nodiscard]] Connections& connections() { return connections_; }

 private:
  void tell_all();
  /// Whoever has no session any more goes.
  void tell_of_log_out();
  void refused_login(const std::string& address, const std::string& user);

  const ServerConfig& config_;
  std::function<void()> on_request_;
  Post post_;
  Post post_login_;
  Gate gate_;
  std::string run_;
  std::optional<Pages> pages_;
  MachinePages machine_pages_{gate_};
  Board board_;
  std::set<std::string> logins_;  ///< that are being looked at: addresses
  LoginWaits login_waits_;
  Connections connections_;
  std::set<Client*> clients_;
  std::atomic<bool> watched_{false};
  std::atomic<int> publications_{0};  ///< that wait for the server's thread
  std::vector<LiveChannel> channels_;
  std::set<LiveClient*> live_clients_;
  std::atomic<bool> live_watched_{false};
  std::mutex requests_mutex_;
  BoundedQueue<Server::Request> requests_;
};

}  // namespace skein::console
