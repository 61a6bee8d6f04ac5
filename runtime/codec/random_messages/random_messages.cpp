// SPDX-License-Identifier: Apache-2.0
#include "skein/random_messages/random_messages.hpp"

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/idl/formation_fields.hpp"
#include "skein/idl/mission_fields.hpp"

namespace skein::codec {
namespace {

/// Makes every field random within its limits. One call of `random` a statement: the order in which
/// arguments are evaluated differs between compilers, and the golden encodings must not.
class RandomMaker {
 public:
  explicit RandomMaker(Random& random) : random_{random} {}

  static constexpr bool at_end() { return false; }

  void operator()(const char*, bool& value, Flag) { value = random_.chance(0.5); }
  void operator()(const char*, double& value, Real limits) {
    value = random_.uniform(limits.min, limits.max);
  }
  template <class T, class Wire>
  void operator()(const char*, T& value, Whole<Wire> limits) {
    const auto span =
        static_cast<std::uint64_t>(limits.max) - static_cast<std::uint64_t>(limits.min);
    const std::uint64_t step = span == std::numeric_limits<std::uint64_t>::max()
                                   ? random_.next()
                                   : random_.index(span + 1);
    value = from_number<T>(static_cast<Wire>(static_cast<std::uint64_t>(limits.min) + step));
  }
  template <class E>
  void operator()(const char*, E& value, Name) {
    value = static_cast<E>(random_.index(static_cast<std::uint64_t>(E::count)));
  }
  void operator()(const char*, std::string& value, Text limits) {
    static constexpr std::array<std::string_view, 8> kCharacters{"a",  "Z", " ", "<",
                                                                 "\"", "ä", "→", "🛩"};
    const std::size_t wanted = random_.index(limits.bytes_max + 1);
    while (true) {
      const std::string_view next = kCharacters.at(random_.index(kCharacters.size()));
      if (value.size() + next.size() > wanted) return;
      value += next;
    }
  }
  template <class T>
  void operator()(const char*, T& value, Part) {
    fields(value, *this);
  }
  template <Union T>
  void operator()(const char*, T& value, Choice) {
    with_alternative<T>(random_.index(std::variant_size_v<VariantOf<T>>),
                        [&]<class Branch>() { fields(value.template emplace<Branch>(), *this); });
  }
  template <class T, class Element>
  void operator()(const char* name, std::optional<T>& value, Maybe<Element> maybe) {
    if (random_.chance(0.5)) (*this)(name, value.emplace(), maybe.element);
  }
  template <class Range, class Element>
  void operator()(const char* name, Range& values, Many<Element> many) {
    for (std::size_t count = random_.index(many.count_max + 1); count > 0; --count) {
      typename Range::value_type value{};
      (*this)(name, value, many.element);
      values.push_back(value);
    }
  }

 private:
  Random& random_;
};

struct Kind {
  std::string_view name;
  mission::Message (*make)(Random&);
};

template <class T, class Topic>
mission::Message made(Random& random) {
  T value{};
  RandomMaker maker{random};
  fields(value, maker);
  return mission::Message{Topic{std::move(value)}};
}

template <class T>
void add_kinds(std::vector<Kind>& kinds, const T*) {
  kinds.push_back({Type<T>::kName, &made<T, T>});
}
template <Union T>
void add_kinds(std::vector<Kind>& kinds, const T*) {
  for (std::size_t i = 0; i < std::variant_size_v<VariantOf<T>>; ++i) {
    with_alternative<T>(i, [&]<class Branch>() {
      kinds.push_back({Type<Branch>::kName, &made<Branch, T>});
    });
  }
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> every = [] {
    std::vector<Kind> all;
    for (std::size_t i = 0; i < std::variant_size_v<mission::Message::variant>; ++i) {
      with_alternative<mission::Message>(
          i, [&]<class T>() { add_kinds(all, static_cast<const T*>(nullptr)); });
    }
    return all;
  }();
  return every;
}

}  // namespace

std::string name_of_kind(std::size_t kind) {
  std::string snake;
  for (const char c : kinds().at(kind).name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital && !snake.empty()) snake += '_';
    snake += capital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return snake;
}

mission::Message random_message(std::size_t kind, Random& random) {
  return kinds().at(kind % kinds().size()).make(random);
}

}  // namespace skein::codec
