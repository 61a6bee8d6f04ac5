// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "neighbours.hpp"
#include "skein/air/link.hpp"
#include "skein/base/random.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// Who asked who others are, whom it does not hear itself: told as soon as it is known, unless
/// somebody else does.
class Introductions {
 public:
  void asked(const Author& of, VehicleId by, bool is_known, Instant now, Random& random);
  /// Who that is has become known.
  void known(const Author& author, Instant now, Random& random);
  /// Another has told who that is.
  void told(const Author& author, VehicleId teller, const Neighbours& neighbours);

  [[nodiscard]] std::optional<Instant> due() const;
  /// Who is to be introduced next; none where it is not time.
  [[nodiscard]] std::optional<Author> next(Instant now) const;
  void done(const Author& author);
  void forget(Instant now);

 private:
  static constexpr std::size_t kMax = 256;  ///< the oldest gives way

  struct Asked {
    Author of;
    VehicleId by;
    Instant since;
    std::optional<Instant> at;  ///< none: not known yet
  };
  std::deque<Asked> asked_;
};

}  // namespace skein::air
