// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/team.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "crypto.hpp"
#include "files.hpp"
#include "key_text.hpp"
#include "skein/base/stations.hpp"
#include "skein/identity/authority.hpp"
#include "skein/identity/node_key.hpp"

namespace skein::identity {
namespace {

constexpr int kDays = 30;

Result<void> make_operator(Authority& authority, const std::filesystem::path& folder,
                           std::int64_t now_unix_s) {
  std::array<std::uint8_t, 16> random{};
  fill_random(random);
  std::string password;
  for (const std::uint8_t byte : random) password += fmt::format("{:02x}", byte);
  const auto made = authority.enrol_operator(kBenchOperator, password, now_unix_s);
  if (!made) return made.error();
  return write_file(node_folder(folder, kGroundStation) / kBenchPasswordFile, password + "\n",
                    Durable::no);
}

}  // namespace

std::filesystem::path node_folder(const std::filesystem::path& folder, VehicleId node) {
  if (is_station(node)) return folder / fmt::format("ground-{}", station_number(node));
  return folder / (node == kGroundStation ? "ground" : fmt::format("vehicle-{}", node.value));
}

Result<void> make_team(const std::filesystem::path& folder, std::span<const VehicleId> vehicles,
                       std::int64_t now_unix_s) {
  if (!is_free(folder)) {
    return Error{
        fmt::format("{}: has files in it; give the team a folder of its own", folder.string())};
  }
  if (auto made = make_folder(folder); !made) return made;
  auto authority = Authority::create(node_folder(folder, kGroundStation), "bench", kDays,
                                     now_unix_s, Durable::no);
  if (!authority) return authority.error();
  if (auto made = make_operator(*authority, folder, now_unix_s); !made) return made;
  std::vector<Request> requests;
  for (const VehicleId vehicle : vehicles) {
    const NodeKey key = make_node_key(vehicle);
    const auto own = node_folder(folder, vehicle);
    if (auto made = make_folder(own); !made) return made;
    if (auto kept = keep_node_key(own, key, Durable::no); !kept) return kept;
    requests.push_back(request_of(key));
  }
  const auto answers = authority->enrol(requests, now_unix_s);
  if (!answers) return answers.error();
  for (const Membership& answer : *answers) {
    const auto file = node_folder(folder, answer.own.node) / kMembershipFile;
    if (auto kept = write_file(file, to_text(answer) + "\n", Durable::no); !kept) return kept;
  }
  return {};
}

}  // namespace skein::identity
