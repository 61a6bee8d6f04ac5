// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/console/sections.hpp"
#include "skein/console/users.hpp"

namespace skein::console {

struct Overlay {
  std::string name;
  std::string file;  ///< GeoJSON
};

/// Vehicles that every operator can select by a name.
struct VehicleGroup {
  std::string name;
  std::vector<std::uint16_t> vehicles;
};

/// Somebody has named a user and a password that do not belong together.
struct RefusedLogin {
  std::string user;  ///< as it was given, without control characters
  std::string address;
  int in_a_row = 0;              ///< of this address
  std::chrono::seconds wait{0};  ///< until another of this address is looked at
};

struct ServerConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = 7460;  ///< 0: any that is free
  /// What somebody may do who gives this name and password; none: nothing. On a thread where it may
  /// take a while; as long for a name that is not known. Empty: whoever has the token is the
  /// operator; on loopback only.
  std::function<std::optional<Role>(const std::string& user, std::string_view password)> log_in;
  std::string token;           ///< empty: whoever reaches it, as of a recording
  std::string observer_token;  ///< beside it: whoever has that one may look only; empty: none
  std::string certificate;     ///< PEM files; both: HTTPS, which any other address needs
  std::string key;
  std::string tiles;  ///< a folder z/x/y.png or an MBTiles file; empty: none
  std::vector<Overlay> overlays;
  std::vector<VehicleGroup> groups;
  /// Fields of the hello message that the server does not know itself, as a JSON object.
  std::string hello = "{}";
  /// On the server's thread; must be short. Empty: none.
  std::function<void(const RefusedLogin&)> on_refused_login;
  /// The last session of that user has ended by a logout; on the server's thread. Empty: none.
  std::function<void(const std::string& user)> on_logout;
};

/// The page and its socket (docs/console-socket.md) on one address, in a thread of its own from
/// open() to destruction. Slow, silent and hostile clients cost it bounded memory and nobody else
/// anything: at most 64 connections, of which those without a session give way; states give way to
/// newer ones; a client whose answers pile up is let go. All functions may be called from any
/// thread.
class Server {
 public:
  /// A client has given a line or an order.
  struct Line {
    std::string line;   ///< of the prompt; or
    std::string order;  ///< as JSON
    std::string user;
    bool may_order = false;  ///< otherwise an observer's: it may look only
    /// `data` is JSON, or empty.
    std::function<void(bool done, const std::string& text, const std::string& data)> reply;
  };
  /// A client has come and wants the `series` of its history message.
  struct Join {
    std::function<void(const std::string& series)> reply;
  };
  using Request = std::variant<Line, Join>;

  /// `on_request` is called on the server's thread when next() has something. Fails where the
  /// address is taken, or is not loopback and has no passwords or no certificate, or a file cannot
  /// be read.
  [[nodiscard]] static Result<std::unique_ptr<Server>> open(ServerConfig config,
                                                            std::function<void()> on_request);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::optional<Request> next();

  /// The picture of this moment, to all that are connected.
  void publish(double time_s, Sections sections);
  /// Events as event_json() gives them, with seq 0, 1, 2...
  void append(std::vector<std::string> events);
  /// A replay has jumped: clients get a new history, and the events from `next_seq` on (at most as
  /// many as there were) again when append() brings them.
  void restart(std::uint64_t next_seq, const std::string& series);

  /// What /health and /metrics answer from now on; not for long, or whoever reports is stuck.
  struct MachineReport {
    bool healthy = false;
    std::string health;   ///< JSON
    std::string metrics;  ///< Prometheus's text
  };
  void report(MachineReport report);

  /// The last words, to every page, after all that was published before; it waits until they have
  /// gone out, for a moment at most.
  void end(double time_s, const std::string& text);

  /// Ends all that this user has open here.
  void expel(const std::string& user);

  /// A record for clients that speak as Foxglove does, CDR by a ros2msg schema. A topic is told to
  /// them with its first record.
  struct LiveRecord {
    std::string topic;
    std::string_view schema_name;
    std::string_view schema;  ///< both good as long as the server
    std::uint64_t time_ns = 0;
    std::vector<std::uint8_t> bytes;
  };
  void live(LiveRecord record);
  /// Whether any such client is connected: else there is no need for records.
  [[nodiscard]] bool live_watched() const;

  /// Whether anybody is connected: else there is no need to publish.
  [[nodiscard]] bool watched() const;
  /// "http://127.0.0.1:7460/".
  [[nodiscard]] std::string url() const;

 private:
  class Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::console
