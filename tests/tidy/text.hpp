// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace skein::tidy {

/// C++ text with its comments blanked out, and its string and character literals too where asked.
/// Every line keeps its number and every character its column. Raw strings and digit separators are
/// understood; trigraphs and line splices inside a token are not.
enum class Literals { keep, blank };
[[nodiscard]] std::string without_comments(std::string_view cpp, Literals literals);

/// The same for a CMake file; bracket comments are not understood.
[[nodiscard]] std::string without_cmake_comments(std::string_view cmake);

[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

/// The words of an identifier, in lower case: "releasePayload_2" gives "release payload 2".
[[nodiscard]] std::string words_of(std::string_view identifier);

}  // namespace skein::tidy
