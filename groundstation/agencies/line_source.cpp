// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/line_source.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <utility>

#include "skein/agencies/outlet.hpp"

namespace skein::agencies {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

constexpr std::size_t kWaitingMax = 65'536;  // bytes of lines that nobody has taken yet

}  // namespace

class LineSource::Connection {
 public:
  Connection(const std::string& address, std::uint16_t port, std::size_t line_max)
      : place_{address + ":" + std::to_string(port)}, line_max_{line_max} {
    error_code error;
    to_ = {asio::ip::make_address_v4(address, error), port};
  }

  void poll(steady_clock::time_point now) {
    now_ = now;
    if (state_ == State::off && now >= retry_at_) connect();
    if (state_ == State::connected && !reads_ && waiting_.size() < kWaitingMax) read();
    io_.restart();
    io_.poll();
  }
  std::optional<std::string> next() {
    for (;;) {
      const std::size_t end = waiting_.find('\n', taken_);
      if (end == std::string::npos) {
        waiting_.erase(0, std::exchange(taken_, 0));
        if (waiting_.size() > line_max_) {  // its end is not waited for
          waiting_.clear();
          skips_ = true;
        }
        return std::nullopt;
      }
      std::string line = waiting_.substr(taken_, end - taken_);
      taken_ = end + 1;
      const bool was_cut = std::exchange(skips_, false);
      if (!was_cut && line.size() <= line_max_) return line;
      ++dropped_;
    }
  }
  [[nodiscard]] bool connected() const { return state_ == State::connected; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  std::optional<std::string> poll_news() { return std::exchange(news_, {}); }

 private:
  enum class State : std::uint8_t { off, connecting, connected };

  void connect() {
    state_ = State::connecting;
    socket_ = tcp::socket{io_};
    socket_.async_connect(to_, [this](const error_code& error) {
      if (error) return end(error);
      state_ = State::connected;
      error_code ignored;
      socket_.set_option(asio::socket_base::keep_alive{true}, ignored);
      news_ = place_ + ": connected";
      told_ = false;
      read();
    });
  }
  void read() {
    reads_ = true;
    socket_.async_read_some(asio::buffer(buffer_),
                            [this](const error_code& error, std::size_t size) {
                              reads_ = false;
                              if (error) return end(error);
                              waiting_.append(buffer_.data(), size);
                              if (waiting_.size() < kWaitingMax) read();
                            });
  }
  void end(const error_code& error) {
    if (error == asio::error::operation_aborted || state_ == State::off) return;
    if (!told_) news_ = place_ + ": " + error.message() + "; it is tried again";
    told_ = true;
    state_ = State::off;
    retry_at_ = now_ + kTcpRetry;
    error_code ignored;
    socket_.close(ignored);
    // The rest of a line that was cut is no line.
    waiting_.resize(std::max(taken_, waiting_.rfind('\n') + 1));
    skips_ = false;
  }

  asio::io_context io_;
  tcp::socket socket_{io_};
  tcp::endpoint to_;
  std::string place_;
  std::size_t line_max_;
  State state_ = State::off;
  bool reads_ = false;
  steady_clock::time_point now_;
  steady_clock::time_point retry_at_ = steady_clock::time_point::min();
  std::array<char, 4096> buffer_{};
  std::string waiting_;
  std::size_t taken_ = 0;  ///< of that
  bool skips_ = false;     ///< to the next end of a line
  std::uint64_t dropped_ = 0;
  bool told_ = false;  ///< of this failure
  std::optional<std::string> news_;
};

LineSource::LineSource(const std::string& address, std::uint16_t port, std::size_t line_max)
    : connection_{std::make_unique<Connection>(address, port, line_max)} {}
LineSource::LineSource(LineSource&&) noexcept = default;
LineSource& LineSource::operator=(LineSource&&) noexcept = default;
LineSource::~LineSource() = default;

void LineSource::poll(steady_clock::time_point now) { connection_->poll(now); }
std::optional<std::string> LineSource::next() { return connection_->next(); }
bool LineSource::connected() const { return connection_->connected(); }
std::uint64_t LineSource::dropped() const { return connection_->dropped(); }
std::optional<std::string> LineSource::poll_news() { return connection_->poll_news(); }

}  // namespace skein::agencies
