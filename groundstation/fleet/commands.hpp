// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace skein::fleet {

inline constexpr int kExitAsTheFile = 0;
inline constexpr int kExitDiffers = 1;  ///< something is not as the file says, or could not be done
inline constexpr int kExitBadInput = 2;  ///< nothing was done

struct FleetArguments {
  std::filesystem::path file;
  std::filesystem::path folder;  ///< empty: runs/fleet-NAME
  std::string epoch;             ///< empty: the file's, or the one that is kept in the folder
  std::string only;              ///< ids; empty: all
  bool force = false;
  bool json = false;
};

int check(const FleetArguments& arguments);
int render_files(const FleetArguments& arguments);
int push_all(const FleetArguments& arguments);
int start_all(const FleetArguments& arguments);
int stop_all(const FleetArguments& arguments);
int show_status(const FleetArguments& arguments);

}  // namespace skein::fleet
