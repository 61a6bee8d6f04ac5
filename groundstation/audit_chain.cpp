// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/audit_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "skein/codec/json_text.hpp"

namespace skein::groundstation {
namespace {

constexpr std::string_view kTopic = "audit of the ground station";

std::string hex_of(identity::Span bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

/// False where it is no such many bytes.
bool read_hex(std::string_view text, std::span<std::uint8_t> into) {
  if (text.size() != 2 * into.size()) return false;
  for (std::size_t i = 0; i < into.size(); ++i) {
    const char* const begin = text.data() + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, into[i], 16);
    if (error != std::errc{} || end != begin + 2) return false;
  }
  return true;
}

/// Nothing where `prev` is no hash.
std::optional<identity::Bytes> body_of(std::string_view prev, std::int64_t unix_s) {
  identity::Bytes body(32);
  if (!read_hex(prev, body)) return std::nullopt;
  for (int shift = 56; shift >= 0; shift -= 8) {
    body.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(unix_s) >> shift));
  }
  return body;
}

template <class T>
std::optional<T> number_in(const codec::ParsedJson& line, const char* name) {
  const auto found = line.find(name);
  if (found == line.end() || !found->is_number_integer()) return std::nullopt;
  return found->get<T>();
}

std::string text_in(const codec::ParsedJson& line, const char* name) {
  const auto found = line.find(name);
  return found != line.end() && found->is_string() ? found->get<std::string>() : "";
}

struct SignatureLook {
  enum class Is : std::uint8_t { good, bad, of_another_mission };
  Is is = Is::bad;
  std::string why = {};  ///< it is bad
};

SignatureLook look_at_signature(const codec::ParsedJson& line,
                                const identity::Certificate& authority) {
  const auto own = identity::certificate_from_text(text_in(line, "signed_by"));
  const auto seq = number_in<std::uint64_t>(line, "seq");
  const auto instance = number_in<std::uint64_t>(line, "instance");
  const auto time_ns = number_in<std::int64_t>(line, "time_ns");
  const auto unix_s = number_in<std::int64_t>(line, "unix_s");
  identity::Signature signature{};
  const auto body = unix_s ? body_of(text_in(line, "prev"), *unix_s) : std::nullopt;
  if (!own || !seq || !instance || !time_ns || !body ||
      !read_hex(text_in(line, "signature"), signature)) {
    return {.why = "the signature cannot be read"};
  }
  if (own->mission != authority.mission) return {SignatureLook::Is::of_another_mission};
  if (own->role != identity::Role::ground) return {.why = "it is not signed by a ground station"};
  identity::Verifier verifier{authority};
  // A date does not end a flight, and the clock of that machine may have been wrong.
  const auto learnt_s = std::clamp(*unix_s, own->not_before_unix_s,
                                   std::max(own->not_before_unix_s, own->not_after_unix_s));
  if (const auto trust = verifier.learn(*own, learnt_s); trust != identity::Trust::good) {
    return {.why = "whose signature it is: " + identity::why_not(*own, trust, learnt_s)};
  }
  const identity::Statement statement{
      kTopic, own->node, {*instance}, *seq, Instant{Duration{*time_ns}}, *body};
  if (verifier.verify(statement, signature) == identity::Trust::good) {
    return {SignatureLook::Is::good};
  }
  return {.why = "what was signed was changed since"};
}

/// Goes through the lines.
class Chain {
 public:
  Chain(const identity::Certificate* authority, AuditFindings& findings)
      : authority_{authority}, findings_{findings} {}

  void take(std::string_view text) {
    ++number_;
    const auto line = codec::parse_json(text);
    if (torn_) {  // the next line says that it stood there as it is
      findings_.remarks.push_back(
          fmt::format("line {} was cut short when the program or the machine ended", number_ - 1));
    }
    torn_ = line.is_discarded() || !line.is_object();
    if (!torn_) look_at(line);
    before_ = hash_of_line(text);
  }

  void end() {
    if (torn_) {
      findings_.remarks.push_back(
          fmt::format("line {}, the last, is cut short or was written by nobody", number_));
    }
    if (findings_.after_signature > 0) {
      findings_.remarks.push_back(fmt::format(
          "no signature follows the last {} entries: the ground station runs, did not end by "
          "itself or has no keys; who can write the file can have changed them or cut some off",
          findings_.after_signature));
    }
  }

 private:
  void fault(const std::string& what) {
    findings_.faults.push_back(fmt::format("line {}: {}", number_, what));
  }

  void look_at(const codec::ParsedJson& line) {
    const std::string prev = text_in(line, "prev");
    if (prev.empty() && !chained_) {
      if (unchained_++ == 0) {
        findings_.remarks.push_back("the first lines are of 0.1.0, which did not chain them");
      }
    } else if (prev != before_) {
      fault(number_ == 1 ? "lines before it are gone"
                         : "the line before it was changed, or lines between them are gone");
    }
    chained_ = chained_ || !prev.empty();
    const auto seq = number_in<std::uint64_t>(line, "seq");
    if (chained_ && next_seq_ && seq != next_seq_) number_is_not(*next_seq_, seq);
    if (seq && chained_) next_seq_ = *seq + 1;
    if (line.contains("signed_by")) {
      look_at_seal(line);
    } else {
      ++findings_.entries;
      ++findings_.after_signature;
    }
  }

  void number_is_not(std::uint64_t expected, std::optional<std::uint64_t> seq) {
    if (!seq || *seq < expected) return fault(fmt::format("its number should be {}", expected));
    findings_.remarks.push_back(fmt::format("line {}: {} entries before it could not be written",
                                            number_, *seq - expected));
  }

  void look_at_seal(const codec::ParsedJson& line) {
    ++findings_.signatures;
    if (authority_ == nullptr) {
      findings_.after_signature = 0;
      return;
    }
    const auto [is, why] = look_at_signature(line, *authority_);
    if (is == SignatureLook::Is::bad) fault(why);
    if (is == SignatureLook::Is::of_another_mission) {
      findings_.remarks.push_back(fmt::format(
          "line {} was signed in another mission: its signature is not checked", number_));
    }
    if (is != SignatureLook::Is::good) return;
    ++findings_.good_signatures;
    findings_.after_signature = 0;
  }

  const identity::Certificate* authority_;
  AuditFindings& findings_;
  std::size_t number_ = 0;
  std::size_t unchained_ = 0;
  bool chained_ = false;
  bool torn_ = false;
  std::string before_ = kNoLineBefore;
  std::optional<std::uint64_t> next_seq_;
};

}  // namespace

std::string hash_of_line(std::string_view line) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(line.data());
  return hex_of(identity::digest({begin, line.size()}));
}

std::string seal_line(const AuditKey& key, std::uint64_t seq, const std::string& prev, Instant now,
                      std::int64_t unix_s) {
  const identity::Bytes body = body_of(prev, unix_s).value_or(identity::Bytes{});
  const auto signature =
      key.signer.sign(identity::Statement{kTopic, key.own.node, key.instance, seq, now, body});
  return codec::json_text(codec::Json{{"seq", seq},
                                      {"time_ns", now.time_since_epoch().count()},
                                      {"unix_s", unix_s},
                                      {"instance", key.instance.value},
                                      {"signed_by", identity::to_text(key.own)},
                                      {"signature", hex_of(signature)},
                                      {"prev", prev}});
}

AuditFindings verify_audit(std::string_view text, const identity::Certificate* authority) {
  AuditFindings findings;
  Chain chain{authority, findings};
  while (!text.empty()) {
    const auto end = text.find('\n');
    chain.take(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  chain.end();
  if (authority == nullptr && findings.signatures > 0) {
    findings.remarks.push_back(
        fmt::format("{} signatures are not checked: --keys names the folder of the mission's keys",
                    findings.signatures));
  }
  return findings;
}

}  // namespace skein::groundstation
