# SPDX-License-Identifier: Apache-2.0
# cmake -D DIST=folder -D OUTPUT=assets.cpp -P embed.cmake: the page's files, compressed, as a source.
set(types html "text/html" js "text/javascript" css "text/css" svg "image/svg+xml" png "image/png" ico "image/x-icon")
get_filename_component(folder ${OUTPUT} DIRECTORY)
file(GLOB_RECURSE files RELATIVE ${DIST} ${DIST}/*)
list(SORT files)
set(blobs "")
set(table "")
set(number 0)
foreach(file IN LISTS files)
  string(REGEX REPLACE ".*\\." "" extension ${file})
  list(FIND types ${extension} at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${file}: of which MIME type is it? Add it to embed.cmake")
  endif()
  math(EXPR at "${at} + 1")
  list(GET types ${at} type)
  set(path /${file})
  if(file STREQUAL index.html)
    set(path /)
  endif()
  set(packed ${folder}/asset-${number}.gz)
  execute_process(COMMAND gzip -9 -n -c ${DIST}/${file} OUTPUT_FILE ${packed} COMMAND_ERROR_IS_FATAL ANY)
  string(APPEND blobs "asm(\".section .rodata\\nskein_asset_${number}:\\n.incbin \\\"${packed}\\\"\\n"
    "skein_asset_${number}_end:\\n.byte 0\\n.text\\n\");\n"
    "extern \"C\" const char skein_asset_${number}[];\nextern \"C\" const char skein_asset_${number}_end[];\n")
  string(APPEND table "    {\"${path}\", \"${type}\", {skein_asset_${number}, "
    "static_cast<std::size_t>(skein_asset_${number}_end - skein_asset_${number})}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include <array>\n#include <cstddef>\n#include \"assets.hpp\"\n${blobs}
namespace skein::console {
std::span<const Asset> assets() {
  static const std::array<Asset, ${number}> kAssets{{\n${table}  }};
  return kAssets;
}
}  // namespace skein::console\n")
