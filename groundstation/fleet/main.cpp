// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.hpp"
#include "skein/command_line/read.hpp"
#include "skein/version/version.hpp"

namespace skein::fleet {
namespace {

void add_file(CLI::App& command, FleetArguments& arguments) {
  command.add_option("file", arguments.file, "The fleet's file: a scenario with hosts (YAML)")
      ->required();
  command.add_option("--out", arguments.folder,
                     "Folder of what is rendered, where the epoch is kept, too (default: "
                     "runs/fleet-NAME)");
  command.add_flag("--json", arguments.json, "Answer in JSON");
}
void add_epoch(CLI::App& command, FleetArguments& arguments) {
  command.add_option("--epoch", arguments.epoch,
                     "Mission time zero: now, or UTC such as 2026-11-23T08:00:00Z; push and "
                     "render keep it for the commands that follow");
}
void add_only(CLI::App& command, FleetArguments& arguments) {
  command.add_option("--only", arguments.only,
                     "These vehicles' hosts, such as 1-3,7; 0 is the ground station's");
}

constexpr const char* kHelpAll = "The same of every command";

class CommandLine {
 public:
  CommandLine() {
    app_.set_version_flag("--version", "skein " + skein::version());
    app_.set_help_all_flag("--help-all", kHelpAll);
    app_.require_subcommand(1);
    app_.footer("Example:\n  skein fleet check fleet.yaml");
    fleet_.require_subcommand(1);
    fleet_.footer(
        "Ends with status 0 if all is as the file says, 1 if something is not, 2 for bad input.\n"
        "Examples:\n"
        "  skein fleet check fleet.yaml\n"
        "  skein fleet push fleet.yaml --epoch now\n"
        "  skein fleet start fleet.yaml\n"
        "  skein fleet status fleet.yaml --only 3");
    add("check", "Renders in memory, and tells what does not fit together", check, add_epoch);
    add("render", "Writes the configuration of every host into a folder", render_files, add_epoch);
    auto& push = add("push", "Renders, and puts every host's configuration in place over ssh",
                     push_all, add_epoch, add_only);
    push.add_flag("--force", arguments_->force,
                  "Also where the program runs, which heeds it at its next start");
    add("start", "Starts the programs whose configuration is as the file says", start_all,
        add_only);
    auto& stop =
        add("stop", "Asks the programs to end, and waits until they have", stop_all, add_only);
    stop.add_flag("--force", arguments_->force, "Also of vehicles that fly");
    add("status", "Shows hosts, programs and clocks, and every key that differs from the file",
        show_status, add_only);
  }

  int run(int argc, char** argv) { return command_line::read(app_, argc, argv).value_or(status_); }

 private:
  template <class... Adders>
  CLI::App& add(const char* name, const char* description, int (*command)(const FleetArguments&),
                Adders... more) {
    // Made here: in CLI11's own way of it Clang's analyser sees a null pointer that is none.
    const auto made = std::make_shared<CLI::App>(description, name);
    CLI::App& added = *fleet_.add_subcommand(made);
    added.set_help_all_flag("--help-all", kHelpAll);
    add_file(added, *arguments_);
    (more(added, *arguments_), ...);
    added.callback([this, command] { status_ = command(*arguments_); });
    return added;
  }

  CLI::App app_{"What is done with a whole Skein fleet, from one file (docs/fleet.md)."};
  CLI::App& fleet_{*app_.add_subcommand("fleet", "The hosts of a fleet and their programs")};
  std::shared_ptr<FleetArguments> arguments_ = std::make_shared<FleetArguments>();
  int status_ = kExitAsTheFile;
};

}  // namespace
}  // namespace skein::fleet

int main(int argc, char** argv) { return skein::fleet::CommandLine{}.run(argc, argv); }
