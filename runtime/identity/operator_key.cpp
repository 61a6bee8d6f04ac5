// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/operator_key.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bytes.hpp"
#include "crypto.hpp"
#include "files.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr TextForm kForm{"SKEIN-OPERATOR-1:", "key of an operator", kLockedKeyBytesMax};
constexpr std::size_t kFileMax = 1024;

}  // namespace

Bytes to_bytes(const LockedKey& key) {
  const Bytes certificate = to_bytes(key.certificate);
  ByteWriter out;
  out.number(kVersion, 1).add(key.salt).add(key.wrapped);
  return out.number(certificate.size(), 1).add(Span{certificate}).take();
}

Result<LockedKey> locked_key_from(Span bytes) {
  ByteReader in{bytes, "key of an operator"};
  LockedKey key;
  in.require(in.number(1, "version") == kVersion, "version");
  key.salt = in.array<16>("salt");
  key.wrapped = in.array<LockedKey::kWrappedBytes>("key");
  const Span certificate = in.take(in.number(1, "certificate"), "certificate");
  if (auto all = in.finish(); !all) return all.error();
  auto read = certificate_from(certificate);
  if (!read) return read.error();
  key.certificate = std::move(read).value();
  if (key.certificate.role != Role::op) return Error{"key of an operator: it is of somebody else"};
  return key;
}

std::string to_text(const LockedKey& key) { return to_text(kForm, to_bytes(key)); }

Result<LockedKey> locked_key_from_text(std::string_view text) {
  const auto bytes = bytes_from_text(kForm, text);
  if (!bytes) return bytes.error();
  return locked_key_from(*bytes);
}

LockedKey lock(const Secret& sign_key, const Certificate& certificate, std::string_view password) {
  LockedKey key;
  fill_random(key.salt);
  key.certificate = certificate;
  key.wrapped = wrap(scrypt(password, key.salt), to_bytes(certificate), sign_key);
  return key;
}

Result<Signer> unlock(const LockedKey& key, std::string_view password) {
  const auto inside = unwrap(scrypt(password, key.salt), to_bytes(key.certificate), key.wrapped);
  if (!inside || ed25519_public(*inside) != key.certificate.sign_key) {
    return Error{
        fmt::format("the key of operator {} does not open with this password; where it "
                    "was forgotten, revoke it and make another",
                    key.certificate.name)};
  }
  return Signer{key.certificate.mission, *inside};
}

Result<std::string> read_password(const std::filesystem::path& file) {
  auto text = read_file(file, kFileMax, Readers::owner);
  if (text) text->resize(std::min(text->find('\n'), text->size()));
  return text;
}

std::filesystem::path operator_file(const std::filesystem::path& folder, std::string_view name) {
  return folder / kOperatorsFolder / fmt::format("{}.key", name);
}

Result<LockedKey> read_operator_key(const std::filesystem::path& folder, std::string_view name) {
  if (!is_name(name)) return Error{"that is no name of an operator of a mission"};
  const auto file = operator_file(folder, name);
  if (!is_there(file)) {
    return Error{fmt::format("{}: is not there; 'skein-ground mission operator {}' makes it",
                             file.string(), name)};
  }
  const auto text = read_file(file, kFileMax, Readers::owner);
  if (!text) return text.error();
  auto key = locked_key_from_text(*text);
  if (!key) return of_file(file, key.error());
  if (key->certificate.name != name) return of_file(file, Error{"it is of another operator"});
  return key;
}

}  // namespace skein::identity
