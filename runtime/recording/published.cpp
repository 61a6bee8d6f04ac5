// SPDX-License-Identifier: Apache-2.0
#include "skein/recording/published.hpp"

#include <utility>

#include "channel_book.hpp"
#include "records.hpp"

namespace skein::recording {

std::optional<Published> published(const mission::Message& message, VehicleId sender) {
  auto encoded = encode(message);
  if (!encoded) return std::nullopt;
  const schemas::Schema& schema = *encoded->kind->schema;
  return Published{topic_of(sender, *encoded->kind), schema.name, schema.text,
                   std::move(encoded->bytes)};
}

}  // namespace skein::recording
