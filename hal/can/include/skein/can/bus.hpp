// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/can/frame.hpp"

namespace skein::can {

/// What a controller may do on its bus (ISO 11898-1, fault confinement), and whether there is one.
enum class State : std::uint8_t {
  error_active,   ///< healthy
  error_passive,  ///< many errors; still sends and receives
  bus_off,        ///< too many: out until it is restarted
  gone,           ///< the interface is down or was unplugged
};
[[nodiscard]] std::string_view to_string(State state);

struct Statistics {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t refused = 0;  ///< to be sent: the queue was full, or the bus off or gone
  std::uint64_t discarded =
      0;                      ///< were kept, and forgotten: the bus went off or away, or discard()
  std::uint64_t retries = 0;  ///< times that the kernel had no room for the next frame
  std::uint64_t lost = 0;     ///< received by the kernel, dropped because nobody read them
  std::uint64_t malformed = 0;     ///< datagrams that were no frames
  std::uint64_t error_frames = 0;  ///< received
  std::uint64_t bus_offs = 0;
  std::uint64_t restarts = 0;  ///< came back after bus_off or gone
};

/// Lets a frame through if it is of the same kind and `(frame.id & mask) == (id & mask)`.
struct Filter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
  bool extended = true;
};

/// A CAN bus as one program is on it: what it sends it does not receive. Nothing blocks, nothing
/// allocates after it is opened. One thread at a time.
class Bus {
 public:
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  virtual ~Bus() = default;

  /// Sends the frames, all in this order, or none of them: then false, and counted as refused. What
  /// the kernel has no room for is kept; no frame is ever skipped or overtaken.
  [[nodiscard]] virtual bool send(std::span<const Frame> frames) = 0;
  [[nodiscard]] bool send(const Frame& frame) { return send({&frame, 1}); }
  /// Hands what was kept to the kernel; also notices that an interface has come back. To be called
  /// each millisecond or so while pending() is not 0: the kernel does not tell when it has room.
  virtual void flush() = 0;
  /// Frames kept.
  [[nodiscard]] virtual std::size_t pending() const = 0;
  /// Forgets what was kept: commands that must not arrive late. What the kernel has is sent still
  /// (a queue of 10 frames on most adapters). A receiver drops the transfer that this cuts.
  virtual void discard() = 0;

  /// The next frame, or nothing. Error frames are delivered too.
  [[nodiscard]] virtual std::optional<Frame> receive() = 0;
  /// Readable (POLLIN) when receive() has something; valid as long as the bus.
  [[nodiscard]] virtual int descriptor() const = 0;

  /// Receives what any of them lets through; without any, everything. Error frames always pass.
  [[nodiscard]] virtual Result<void> set_filters(std::span<const Filter> filters) = 0;

  [[nodiscard]] virtual State state() const = 0;
  [[nodiscard]] virtual const Statistics& statistics() const = 0;
  /// As it was opened.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Whether FD frames can be sent.
  [[nodiscard]] virtual bool fd() const = 0;
};

struct BusOptions {
  std::size_t queue_frames = 1024;     ///< that are kept while the kernel has no room
  int receive_buffer_bytes = 1 << 20;  ///< asked of the kernel; it may give less
};

/// Opens a bus by its name:
///   "can0", "vcan0", ...   a SocketCAN interface of this machine, which must be up
///   "mcast:2", "mcast:2@eth0"  bus 2 over UDP multicast in ArduPilot's framing (239.65.82.2, port
///                          57732), on the loopback interface or the one named
/// The reason why not says what to do about it.
[[nodiscard]] Result<std::unique_ptr<Bus>> open(const std::string& name,
                                                const BusOptions& options = {});

}  // namespace skein::can
