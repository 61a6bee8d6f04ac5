// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "skein/base/bounded_queue.hpp"

namespace skein::groundstation {

/// Reads lines from a file descriptor in a thread of its own, from construction to destruction. At
/// the end of the input it only stops reading: a ground station runs without a terminal too.
class LineReader {
 public:
  /// `on_line` is called from the reading thread when a line can be taken.
  LineReader(int file_descriptor, std::function<void()> on_line);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// The next line without its end, or nothing. Lines beyond 64 waiting ones are dropped.
  [[nodiscard]] std::optional<std::string> next();

 private:
  void read_all();
  void take(const char* data, std::size_t size);

  int input_;
  int stop_;  ///< eventfd
  std::function<void()> on_line_;
  std::string partial_;
  std::mutex mutex_;
  BoundedQueue<std::string> lines_{64};  ///< under mutex_
  std::thread thread_;
};

}  // namespace skein::groundstation
