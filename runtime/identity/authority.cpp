// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/authority.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <tuple>
#include <utility>

#include "bytes.hpp"
#include "crypto.hpp"
#include "files.hpp"
#include "key_text.hpp"
#include "skein/base/stations.hpp"
#include "skein/base/text.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/node_key.hpp"
#include "skein/identity/operator_key.hpp"
#include "skein/identity/register.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::int64_t kSecondsOfDay = 86'400;
/// Clocks of a team are not quite equal when it is enrolled.
constexpr std::int64_t kBeforehand_s = 3600;
constexpr TextForm kKeyForm{"SKEIN-AUTHORITY-KEY-1:", "key of an authority", kKeyBytes};
constexpr std::size_t kKeyFileMax = 256;
constexpr std::size_t kChangeTextMax = 2400;
constexpr std::size_t kChangesFileMax = kMembersMax * kChangeTextMax;

/// The role of a node that asks to be enrolled.
Role role_of(VehicleId node) { return is_station(node) ? Role::ground : Role::vehicle; }
/// "vehicle 3", "station 2": as it is named at a command.
std::string name_of(VehicleId node) {
  return is_station(node) ? fmt::format("station {}", station_number(node))
                          : fmt::format("vehicle {}", node.value);
}
/// What makes its keys.
std::string enrols(VehicleId node) {
  return is_station(node) ? fmt::format("skein-ground enrol --station {}", station_number(node))
                          : fmt::format("skein-onboard enrol --id {}", node.value);
}
/// Who is told of a new key: a node that was enrolled here, and is not out.
bool is_told(const Certificate& member, const RevocationList& revoked) {
  const bool is_node = member.role == Role::vehicle ||
                       (member.role == Role::ground && member.node != kGroundStation);
  return is_node && !revoked.contains(member.serial);
}

/// Beside `folder`, so that a rename makes it that.
Result<std::filesystem::path> staging_for(const std::filesystem::path& folder) {
  if (!is_free(folder)) {
    return Error{
        fmt::format("{}: has files in it; a mission has a folder of its own", folder.string())};
  }
  auto whole = std::filesystem::absolute(folder);
  if (!whole.has_filename()) whole = whole.parent_path();  // it was written with a '/' at its end
  std::filesystem::path staging{whole.string() + ".new"};
  if (auto made = make_folder(staging); !made) return made.error();
  return staging;
}

/// What one left that was cut off. Precondition: it is locked, so none is at it.
void empty(const std::filesystem::path& staging) {
  std::error_code ignored;
  for (const auto& left : std::filesystem::directory_iterator{staging, ignored}) {
    std::filesystem::remove_all(left.path(), ignored);
  }
}

Result<void> write_key(const std::filesystem::path& folder, const Secret& key, Durable durable) {
  std::string text = to_text(kKeyForm, key.bytes) + "\n";
  auto kept = write_file(folder / kAuthorityKeyFile, text, durable);
  wipe(text);
  return kept;
}

Result<Secret> read_key(const std::filesystem::path& folder) {
  const auto file = folder / kAuthorityKeyFile;
  if (!is_there(file)) {
    return Error{
        fmt::format("{}: is not there; 'skein-ground mission create NAME --keys {}' makes "
                    "a mission, and its folder is what --keys names",
                    file.string(), folder.string())};
  }
  auto text = read_file(file, kKeyFileMax, Readers::owner);
  if (!text) return text.error();
  auto bytes = bytes_from_text(kKeyForm, *text);
  wipe(*text);
  if (!bytes) return of_file(file, bytes.error());
  if (bytes->size() != kKeyBytes) return of_file(file, Error{"is too short"});
  Secret key;
  std::copy(bytes->begin(), bytes->end(), key.bytes.begin());
  wipe(*bytes);
  return key;
}

}  // namespace

Authority::Authority(std::filesystem::path folder, FolderLock lock, Durable durable)
    : folder_{std::move(folder)}, lock_{std::move(lock)}, durable_{durable} {}

Result<Authority> Authority::create(const std::filesystem::path& folder, const std::string& name,
                                    int days, std::int64_t now_unix_s, Durable durable) {
  if (!is_name(name)) {
    return Error{
        fmt::format("'{}' is no name of a mission: 1 to {} letters, digits, '.', '_' and "
                    "'-', the first a letter or a digit",
                    as_text(name, kNameMax), kNameMax)};
  }
  if (days < 1 || days > kDaysMax) {
    return Error{fmt::format("{} days: a mission has 1 to {}", days, kDaysMax)};
  }
  const auto staging = staging_for(folder);
  if (!staging) return staging.error();
  auto lock = FolderLock::take(*staging);
  if (!lock) return lock.error();
  empty(*staging);
  Authority made{*staging, std::move(lock).value(), durable};
  if (auto begun = made.begin(name, days, now_unix_s); !begun) {
    std::error_code ignored;
    std::filesystem::remove_all(*staging, ignored);
    return begun.error();
  }
  std::error_code failed;
  std::filesystem::rename(*staging, folder, failed);
  if (failed) {
    return Error{fmt::format("cannot make {}: {}", folder.string(), failed.message())};
  }
  made.folder_ = folder;
  return made;
}

Result<void> Authority::begin(const std::string& name, int days, std::int64_t now_unix_s) {
  key_ = random_secret();
  certificate_.role = Role::authority;
  certificate_.name = name;
  fill_random(certificate_.mission.bytes);
  certificate_.sign_key = ed25519_public(key_);
  certificate_.not_before_unix_s = std::max<std::int64_t>(0, now_unix_s - kBeforehand_s);
  certificate_.not_after_unix_s = now_unix_s + days * kSecondsOfDay;
  sign(certificate_, key_);
  revoked_ = {.mission = certificate_.mission, .epoch = 1, .serials = {}, .signature = {}};
  sign(revoked_, key_);
  key_of_epoch_ = {.epoch = 1, .secret = random_secret().bytes};

  const NodeKey ground = make_node_key(kGroundStation);
  Certificate own;
  own.role = Role::ground;
  own.sign_key = ground.sign_key();
  own.agree_key = ground.agree_key();
  members_.push_back(signed_by_us(std::move(own)));

  if (auto kept = keep_node_key(folder_, ground, durable_); !kept) return kept;
  if (auto kept = write_key(folder_, key_, durable_); !kept) return kept;
  return save();
}

Result<Authority> Authority::open(const std::filesystem::path& folder,
                                  std::chrono::milliseconds within) {
  auto key = read_key(folder);  // says it best where the folder is none of a mission
  if (!key) return key.error();
  auto lock = FolderLock::take(folder, within);
  if (!lock) return lock.error();
  Authority made{folder, std::move(lock).value(), Durable::yes};
  made.key_ = *key;
  auto known = read_register(register_file(folder));
  if (!known) return known.error();
  if (known->authority.sign_key != ed25519_public(*key)) {
    return Error{fmt::format("{}: is not of the {} beside it; both are of one folder",
                             register_file(folder).string(), kAuthorityKeyFile)};
  }
  made.certificate_ = std::move(known->authority);
  made.key_of_epoch_ = known->key;
  made.revoked_ = std::move(known->revoked);
  made.members_ = std::move(known->members);
  if (!made.is_published()) {
    if (auto published = made.publish(); !published) return published.error();
  }
  return made;
}

Certificate Authority::signed_by_us(Certificate certificate) const {
  certificate.mission = certificate_.mission;
  certificate.serial.value = static_cast<std::uint32_t>(members_.size() + 1);
  certificate.not_before_unix_s = certificate_.not_before_unix_s;
  certificate.not_after_unix_s = certificate_.not_after_unix_s;
  sign(certificate, key_);
  return certificate;
}

Membership Authority::membership_of(const Certificate& member) const {
  return {certificate_, member, {revoked_, make_grant(key_of_epoch_, member, key_)}};
}

/// What the mission is, and then what is made of it.
Result<void> Authority::save() const {
  const Register now{certificate_, key_of_epoch_, revoked_, members_};
  if (auto kept = write_register(register_file(folder_), now, durable_); !kept) return kept;
  return publish();
}

Result<void> Authority::publish() const {
  std::string changes;
  for (const Certificate& member : members_) {
    if (!is_told(member, revoked_)) continue;
    changes += fmt::format("{} {}\n", member.node.value, to_text(membership_of(member).keys));
  }
  if (auto kept = write_file(folder_ / kMembershipFile,
                             to_text(membership_of(members_.front())) + "\n", durable_);
      !kept) {
    return kept;
  }
  return write_file(folder_ / kChangesFile, changes, durable_);
}

/// Or did a cut come between?
bool Authority::is_published() const {
  const auto own = read_membership(KeyFolder{folder_, {}});
  const auto changes = read_changes(folder_);
  if (!own || !changes || own->keys.revoked != revoked_) return false;
  std::vector<Serial> told;
  for (const auto& [node, change] : *changes) {
    if (change.revoked != revoked_) return false;
    told.push_back(change.grant.member);
  }
  std::vector<Serial> due;
  for (const Certificate& member : members_) {
    if (is_told(member, revoked_)) due.push_back(member.serial);
  }
  return told == due;
}

std::optional<Certificate> Authority::valid(Role role, VehicleId node,
                                            std::string_view name) const {
  for (const Certificate& member : members_) {
    if (member.role == role && member.node == node && member.name == name &&
        !revoked_.contains(member.serial)) {
      return member;
    }
  }
  return std::nullopt;
}

std::optional<Serial> Authority::serial_of(VehicleId vehicle) const {
  const auto member = valid(role_of(vehicle), vehicle, {});
  return member ? std::optional{member->serial} : std::nullopt;
}

std::optional<Serial> Authority::serial_of(std::string_view op) const {
  const auto member = valid(Role::op, {}, op);
  return member ? std::optional{member->serial} : std::nullopt;
}

Result<void> Authority::room_for_one(std::int64_t now_unix_s) const {
  if (const Trust trust = check_authority(certificate_, now_unix_s); trust != Trust::good) {
    return Error{fmt::format("the mission '{}' takes nobody: {}", certificate_.name,
                             why_not(certificate_, trust, now_unix_s))};
  }
  if (members_.size() >= kMembersMax) {
    return Error{
        fmt::format("the mission '{}' has signed {} certificates, which is all it may; "
                    "create a new one",
                    certificate_.name, kMembersMax)};
  }
  return {};
}

Result<Certificate> Authority::certify(const Request& request, std::int64_t now_unix_s) {
  if (auto room = room_for_one(now_unix_s); !room) return room.error();
  if (!is_proven(request) || !x25519(random_secret(), request.agree_key)) {
    return Error{
        fmt::format("the request of {} is not signed with its own key; have it made again with "
                    "'{}'",
                    name_of(request.vehicle), enrols(request.vehicle))};
  }
  if (const auto known = valid(role_of(request.vehicle), request.vehicle, {})) {
    if (known->sign_key == request.sign_key && known->agree_key == request.agree_key) return *known;
    return Error{
        fmt::format("{0} is a member with the keys {1}, and these are {2}; if they are new, "
                    "'mission revoke {0}' first",
                    name_of(request.vehicle), fingerprint(*known),
                    fingerprint(request.sign_key, request.agree_key))};
  }
  for (const Certificate& member : members_) {
    if (member.sign_key != request.sign_key && member.agree_key != request.agree_key) continue;
    return Error{
        fmt::format("{}: these keys were those of certificate {}, and count no more; make others "
                    "with '{} --new-keys'",
                    name_of(request.vehicle), member.serial.value, enrols(request.vehicle))};
  }
  Certificate own;
  own.role = role_of(request.vehicle);
  own.node = request.vehicle;
  own.sign_key = request.sign_key;
  own.agree_key = request.agree_key;
  members_.push_back(signed_by_us(std::move(own)));
  return members_.back();
}

Result<std::vector<Membership>> Authority::enrol(std::span<const Request> requests,
                                                 std::int64_t now_unix_s) {
  const std::size_t before = members_.size();
  std::vector<Membership> answers;
  for (const Request& request : requests) {
    const auto certificate = certify(request, now_unix_s);
    if (!certificate) {
      members_.resize(before);
      return certificate.error();
    }
    answers.push_back(membership_of(*certificate));
  }
  if (members_.size() == before) return answers;
  if (auto kept = save(); !kept) {
    members_.resize(before);
    return kept.error();
  }
  return answers;
}

Result<Certificate> Authority::enrol_operator(const std::string& name, std::string_view password,
                                              std::int64_t now_unix_s) {
  if (!is_name(name)) {
    return Error{
        fmt::format("'{}' is no name of an operator: 1 to {} letters, digits, '.', '_' and "
                    "'-', the first a letter or a digit",
                    as_text(name, kNameMax), kNameMax)};
  }
  if (auto room = room_for_one(now_unix_s); !room) return room.error();
  if (serial_of(name)) {
    return Error{
        fmt::format("{0} is an operator of this mission already; for a new password "
                    "'mission revoke operator {0}' first",
                    name)};
  }
  const Secret key = random_secret();
  Certificate own;
  own.role = Role::op;
  own.name = name;
  own.sign_key = ed25519_public(key);
  members_.push_back(signed_by_us(std::move(own)));
  const Certificate made = members_.back();
  if (auto kept = save(); !kept) {
    members_.pop_back();
    return kept.error();
  }
  const auto file = operator_file(folder_, name);
  if (auto there = make_folder(file.parent_path()); !there) return there.error();
  if (auto kept = write_file(file, to_text(lock(key, made, password)) + "\n", durable_); !kept) {
    return kept.error();
  }
  return made;
}

Result<void> Authority::revoke(Serial serial) {
  if (serial.value == 0 || serial.value > members_.size()) {
    return Error{fmt::format("there is no certificate {} in this mission", serial.value)};
  }
  if (serial == members_.front().serial) {
    return Error{"the ground station holds the authority; if it was lost, create a new mission"};
  }
  if (revoked_.contains(serial)) {
    return Error{fmt::format("certificate {} was revoked before", serial.value)};
  }
  if (key_of_epoch_.epoch == kEpochMax) {
    return Error{fmt::format("this mission has had {} keys, which is all it may; create a new one",
                             kEpochMax)};
  }
  const auto before = std::pair{key_of_epoch_, revoked_};
  auto& serials = revoked_.serials;
  serials.insert(std::upper_bound(serials.begin(), serials.end(), serial), serial);
  ++revoked_.epoch;
  sign(revoked_, key_);
  key_of_epoch_ = {.epoch = revoked_.epoch, .secret = random_secret().bytes};
  if (auto kept = save(); !kept) {
    std::tie(key_of_epoch_, revoked_) = before;
    return kept;
  }
  return {};
}

Result<std::vector<MemberChange>> read_changes(const std::filesystem::path& folder) {
  const auto file = folder / kChangesFile;
  const auto text = read_file(file, kChangesFileMax, Readers::anybody);
  if (!text) return text.error();
  std::vector<MemberChange> changes;
  for (const std::string_view line : lines_of(*text)) {
    const std::size_t space = std::min(line.find(' '), line.size());
    const auto node = whole_number(line.substr(0, space));
    if (!node)
      return of_file(file, Error{"a line names no vehicle; any 'mission' command mends it"});
    auto change = key_change_from_text(line.substr(space));
    if (!change) return of_file(file, change.error());
    changes.push_back({VehicleId{*node}, std::move(change).value()});
  }
  return changes;
}

}  // namespace skein::identity
