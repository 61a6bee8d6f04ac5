// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/request.hpp"

#include "bytes.hpp"
#include "crypto.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::string_view kPurpose = "skein request 1";
constexpr TextForm kForm{"SKEIN-REQUEST-1:", "request", kRequestBytes};

ByteWriter unsigned_part(const Request& request) {
  ByteWriter out;
  out.number(kVersion, 1).number(request.vehicle.value, 2);
  out.add(request.sign_key).add(request.agree_key);
  return out;
}

Bytes what_is_signed(const Request& request) {
  const Bytes part = unsigned_part(request).take();
  return ByteWriter{}.add(kPurpose).add(Span{part}).take();
}

}  // namespace

Bytes to_bytes(const Request& request) { return unsigned_part(request).add(request.proof).take(); }

Result<Request> request_from(Span bytes) {
  ByteReader in{bytes, "request"};
  Request request;
  in.require(in.number(1, "version") == kVersion, "version");
  request.vehicle.value = static_cast<std::uint16_t>(in.number(2, "vehicle"));
  in.require(request.vehicle != kGroundStation, "vehicle");
  request.sign_key = in.array<kKeyBytes>("sign_key");
  request.agree_key = in.array<kKeyBytes>("agree_key");
  request.proof = in.array<64>("proof");
  return in.finish(request);
}

std::string to_text(const Request& request) { return to_text(kForm, to_bytes(request)); }

Result<Request> request_from_text(std::string_view text) {
  const auto bytes = bytes_from_text(kForm, text);
  if (!bytes) return bytes.error();
  return request_from(*bytes);
}

void sign(Request& request, const Secret& sign_key) {
  request.proof = ed25519_sign(sign_key, what_is_signed(request));
}

bool is_proven(const Request& request) {
  return ed25519_verify(request.sign_key, what_is_signed(request), request.proof);
}

}  // namespace skein::identity
