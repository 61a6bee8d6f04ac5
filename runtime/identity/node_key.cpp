// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/node_key.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "bytes.hpp"
#include "crypto.hpp"
#include "files.hpp"
#include "key_text.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kBytes = 1 + 2 + 2 * kKeyBytes;
constexpr TextForm kForm{"SKEIN-NODE-KEY-1:", "key of a node", kBytes};
constexpr std::size_t kFileMax = 512;

Result<NodeKey> from_bytes(Span bytes) {
  ByteReader in{bytes, "key of a node"};
  NodeKey key;
  in.require(in.number(1, "version") == kVersion, "version");
  key.node.value = static_cast<std::uint16_t>(in.number(2, "node"));
  key.sign.bytes = in.array<kKeyBytes>("key to sign with");
  key.agree.bytes = in.array<kKeyBytes>("key to agree with");
  return in.finish(std::move(key));
}

bool is_handed(const KeyFolder& keys) {
  return !keys.credentials.empty() && is_there(keys.credentials / kNodeKeyFile);
}

}  // namespace

PublicKey NodeKey::sign_key() const { return ed25519_public(sign); }
PublicKey NodeKey::agree_key() const { return x25519_public(agree); }

NodeKey make_node_key(VehicleId node) { return {node, random_secret(), random_secret()}; }

Request request_of(const NodeKey& key) {
  Request request{key.node, key.sign_key(), key.agree_key(), {}};
  sign(request, key.sign);
  return request;
}

std::string fingerprint(const NodeKey& key) { return fingerprint(key.sign_key(), key.agree_key()); }

std::string to_text(const NodeKey& key) {
  ByteWriter out;
  out.number(kVersion, 1).number(key.node.value, 2).add(key.sign.bytes).add(key.agree.bytes);
  Bytes bytes = out.take();
  std::string text = to_text(kForm, bytes);
  wipe(bytes);
  return text;
}

KeyFolder KeyFolder::of(std::filesystem::path folder) {
  // Nobody changes the environment. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* credentials = std::getenv("CREDENTIALS_DIRECTORY");
  return {std::move(folder), credentials != nullptr ? credentials : ""};
}

Result<NodeKey> read_node_key(const KeyFolder& keys) {
  const bool handed = is_handed(keys);
  const auto file = (handed ? keys.credentials : keys.folder) / kNodeKeyFile;
  if (!is_there(file)) {
    return Error{
        fmt::format("{}: is not there; make keys with 'skein-onboard enrol --id N --keys "
                    "{}', for a ground station with 'skein-ground mission create'",
                    file.string(), keys.folder.string())};
  }
  auto text = read_file(file, kFileMax, handed ? Readers::anybody : Readers::owner);
  if (!text) return text.error();
  auto bytes = bytes_from_text(kForm, *text);
  wipe(*text);
  if (!bytes) return of_file(file, bytes.error());
  auto key = from_bytes(*bytes);
  wipe(*bytes);
  if (!key) return of_file(file, key.error());
  return key;
}

Result<NodeKey> make_new_node_key(const KeyFolder& keys, VehicleId node) {
  if (is_handed(keys)) {
    return Error{
        fmt::format("{}: its keys are handed over by the service manager; change them "
                    "where it has them from",
                    keys.credentials.string())};
  }
  if (auto made = make_folder(keys.folder); !made) return made.error();
  NodeKey key = make_node_key(node);
  if (auto kept = keep_node_key(keys.folder, key, Durable::yes); !kept) return kept.error();
  return key;
}

Result<NodeKey> read_or_make_node_key(const KeyFolder& keys, VehicleId node) {
  if (!is_handed(keys) && !is_there(keys.folder / kNodeKeyFile)) {
    return make_new_node_key(keys, node);
  }
  auto known = read_node_key(keys);
  if (known && known->node != node) {
    return Error{fmt::format("{}: has the keys of node {}, not of {}; give it another folder",
                             keys.folder.string(), known->node.value, node.value)};
  }
  return known;
}

Result<void> keep_node_key(const std::filesystem::path& folder, const NodeKey& key,
                           Durable durable) {
  // The count is there before the keys that it counts for, and outlasts them.
  if (const auto file = folder / kStartsFile; !is_there(file)) {
    if (auto kept = write_file(file, "0\n", durable); !kept) return kept;
  }
  std::string text = to_text(key) + "\n";
  auto kept = write_file(folder / kNodeKeyFile, text, durable);
  wipe(text);
  return kept;
}

}  // namespace skein::identity
