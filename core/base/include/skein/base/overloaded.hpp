// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein {

/// One callable of several, for std::visit.
template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

}  // namespace skein
