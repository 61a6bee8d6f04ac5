// SPDX-License-Identifier: Apache-2.0
//
// Any bytes, and any text, as what people and the air bring of certificates, enrolment and keys.
// What is read has one form only, and nobody is believed who has not the authority's key.
#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "fuzz_input.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/identity/membership.hpp"
#include "skein/identity/operator_key.hpp"
#include "skein/identity/request.hpp"

namespace skein::fuzz {
namespace {

constexpr std::int64_t kNow_unix_s = 1'777'000'000;

template <class T>
void in_one_form(std::span<const std::uint8_t> bytes, const Result<T>& read) {
  if (!read) {
    SKEIN_ASSERT(!read.error().message.empty());
    return;
  }
  const identity::Bytes again = to_bytes(*read);
  SKEIN_ASSERT(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
}

template <class T>
void in_one_text(std::string_view text, const Result<T>& read) {
  if (read) SKEIN_ASSERT(text.find(to_text(*read)) != std::string_view::npos);
}

void run_bytes(std::span<const std::uint8_t> bytes) {
  in_one_form(bytes, identity::certificate_from(bytes));
  in_one_form(bytes, identity::request_from(bytes));
  in_one_form(bytes, identity::revocation_list_from(bytes));
  in_one_form(bytes, identity::grant_from(bytes));
  in_one_form(bytes, identity::key_change_from(bytes));
  in_one_form(bytes, identity::locked_key_from(bytes));
  const auto membership = identity::membership_from(bytes);
  in_one_form(bytes, membership);
  if (membership) static_cast<void>(check(*membership, kNow_unix_s));
}

void run_text(std::string_view text) {
  in_one_text(text, identity::certificate_from_text(text));
  in_one_text(text, identity::request_from_text(text));
  in_one_text(text, identity::revocation_list_from_text(text));
  in_one_text(text, identity::key_change_from_text(text));
  in_one_text(text, identity::locked_key_from_text(text));
  in_one_text(text, identity::membership_from_text(text));
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run_bytes({data, size});
  skein::fuzz::run_text({reinterpret_cast<const char*>(data), size});
  return 0;
}
