// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace skein::console {

/// Who is connected. A stranger, who has not shown a session, gives way when another needs the
/// place: so nobody who only connects, however often, keeps an operator out.
class Connections {
 public:
  static constexpr std::size_t kMax = 64;
  static constexpr std::size_t kStrangersOfOneAddress = 16;

  /// A place for as long as it lives. The connections must outlive it.
  class Place {
   public:
    ~Place() { all_->places_.erase(number_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    /// It gives way to nobody from now on.
    void has_session();

   private:
    friend class Connections;
    Place(Connections& all, std::uint64_t number) : all_{&all}, number_{number} {}
    Connections* all_;
    std::uint64_t number_;
  };

  /// `drop` ends that connection, at once or soon; it is called where it gives way. Null: all
  /// places are of those who have sessions.
  [[nodiscard]] std::shared_ptr<Place> enter(std::string address, std::function<void()> drop);
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  struct Entry {
    std::string address;
    std::function<void()> drop;  ///< empty: has a session
  };
  using Entries = std::map<std::uint64_t, Entry>;  // the oldest first
  [[nodiscard]] Entries::iterator who_gives_way(const std::string& address);

  Entries places_;
  std::uint64_t next_ = 0;
};

}  // namespace skein::console
