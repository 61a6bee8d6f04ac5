// SPDX-License-Identifier: Apache-2.0
#include "fence_words.hpp"

#include <fmt/format.h>

#include <iterator>

#include "prompt_words.hpp"

namespace skein::groundstation {
Result<Input> fence_order(const std::vector<std::string_view>& words, bool preview) {
  if (words.size() == 1 && !preview) return Input{View::fence};
  NewFence order;
  order.preview = preview;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "height" && i + 1 < words.size()) {
      const auto height = number_after("height", words[++i], kFenceHeight_m);
      if (!height) return height.error();
      order.fence.height_max_m = *height;
    } else if (words.size() > 1 && i == 1 && words[i].find(',') == std::string_view::npos) {
      order.file = words[i];
    } else {
      const auto corner = place_of(words[i]);
      if (!corner) return corner.error();
      order.fence.corners.push_back(*corner);
    }
  }
  if (order.file.empty() == order.fence.corners.empty()) {
    return Error{
        "'fence' needs corners EAST,NORTH in metres, or a file, and a height, as in 'fence 0,0 "
        "900,0 900,700 height 100' and 'fence area.geojson height 100'"};
  }
  return Input{order};
}

std::string fence_line(const NewFence& order) {
  std::string line = order.preview ? "preview fence" : "fence";
  if (!order.file.empty()) line += " " + order.file;
  for (const Vec2& corner : order.fence.corners) {
    fmt::format_to(std::back_inserter(line), " {:g},{:g}", corner.x(), corner.y());
  }
  fmt::format_to(std::back_inserter(line), " height {:g}", order.fence.height_max_m);
  return line;
}

}  // namespace skein::groundstation
