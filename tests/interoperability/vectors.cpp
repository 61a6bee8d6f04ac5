// SPDX-License-Identifier: Apache-2.0
//
// MAVLink packets and what is in them, as lines that another implementation can be compared with:
//   vectors write SEED COUNT [PASSPHRASE]   COUNT packets of every message: hexadecimal, blank,
//   content vectors read [PASSPHRASE]               from lines of hexadecimal: the content of each,
//   or "refused"
// Content is NAME followed by field=value; an integer in decimal, a float by its bits in
// hexadecimal, characters in hexadecimal, elements of arrays with commas. With a passphrase packets
// are signed.
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <iostream>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::mavlink {
namespace {

constexpr SigningTime kStart = 1'000'000'000'000;

std::string hex(std::uint64_t value, std::size_t digits) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = digits; i-- > 0;) text += kDigits[value >> (4 * i) & 0xFU];
  return text;
}

template <class Element>
std::string text_of_element(Element value) {
  if constexpr (std::is_same_v<Element, float>) {
    return hex(std::bit_cast<std::uint32_t>(value), 8);
  } else if constexpr (std::is_same_v<Element, char>) {
    return hex(static_cast<std::uint8_t>(value), 2);
  } else {
    return std::to_string(value);
  }
}

template <class Message>
std::string content_of(const Message& message) {
  std::string text = Message::kDefinition.name;
  Message::kDefinition.for_each([&]<class V>(const Field<Message, V>& f) {
    text += std::string{" "} + f.name + "=";
    if constexpr (FieldShape<V>::kCount == 0) {
      text += text_of_element(message.*f.member);
    } else {
      constexpr bool kText = std::is_same_v<typename FieldShape<V>::Element, char>;
      bool first = true;
      for (const auto element : message.*f.member) {
        if (kText && element == 0) break;
        if (!kText && !first) text += ',';
        text += text_of_element(element);
        first = false;
      }
    }
  });
  return text;
}

template <class Element>
Element random_element(Random& random) {
  if constexpr (std::is_same_v<Element, float>) {
    return static_cast<float>(random.normal(0, 1000));
  } else if constexpr (std::is_same_v<Element, char>) {
    return static_cast<char>('a' + random.index(26));
  } else {
    // Ends of the range are where signs and sizes go wrong.
    if (random.chance(0.2)) return std::numeric_limits<Element>::max();
    if (random.chance(0.2)) return std::numeric_limits<Element>::min();
    return static_cast<Element>(random.next());
  }
}

template <class Message>
Message random_message(Random& random) {
  Message message;
  Message::kDefinition.for_each([&]<class V>(const Field<Message, V>& f) {
    // Zeros are truncated where they end a payload.
    if (random.chance(0.2)) {
      message.*f.member = V{};
      return;
    }
    if constexpr (FieldShape<V>::kCount == 0) {
      message.*f.member = random_element<V>(random);
    } else {
      for (auto& element : message.*f.member) {
        element = random_element<typename FieldShape<V>::Element>(random);
      }
    }
  });
  return message;
}

template <class... Message>
void write_all(std::tuple<Message...>* /*list*/, Random& random, Encoder& encoder) {
  const auto write = [&](const auto& message) {
    for (const std::uint8_t byte : encoder.encode(message)) std::cout << hex(byte, 2);
    std::cout << ' ' << content_of(message) << '\n';
  };
  (write(random_message<Message>(random)), ...);
}

template <class... Message>
std::string content_of(std::tuple<Message...>* /*list*/, const Packet& packet) {
  std::string text;
  const auto try_one = [&]<class M>(const M* /*type*/) {
    if (const auto message = decode<M>(packet)) text = content_of(*message);
  };
  (try_one(static_cast<const Message*>(nullptr)), ...);
  return text;
}

void read_all(Parser& parser) {
  for (std::string line; std::getline(std::cin, line);) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      std::uint8_t byte = 0;
      std::from_chars(line.data() + i, line.data() + i + 2, byte, 16);
      bytes.push_back(byte);
    }
    std::string answer = "refused";
    parser.parse(bytes, [&](const Packet& packet) {
      answer = content_of(static_cast<Messages*>(nullptr), packet);
    });
    std::cout << answer << '\n';
  }
}

int run(const std::vector<std::string>& arguments) {
  const std::string mode = arguments.empty() ? "" : arguments[0];
  if (mode == "write" && arguments.size() >= 3) {
    Random random{std::stoull(arguments[1])};
    Encoder encoder{1, 191};
    if (arguments.size() > 3) encoder.sign_with(Signer{key_of(arguments[3]), 7, kStart});
    for (unsigned long i = 0; i < std::stoul(arguments[2]); ++i) {
      write_all(static_cast<Messages*>(nullptr), random, encoder);
    }
    return 0;
  }
  if (mode == "read") {
    ParserParams params;
    if (arguments.size() > 1) {
      params.key = key_of(arguments[1]);
      params.accept_unsigned = false;
    }
    Parser parser{params};
    read_all(parser);
    return 0;
  }
  std::cerr << "vectors write SEED COUNT [PASSPHRASE] | vectors read [PASSPHRASE]\n";
  return 2;
}

}  // namespace
}  // namespace skein::mavlink

int main(int argc, char** argv) { return skein::mavlink::run({argv + 1, argv + argc}); }
