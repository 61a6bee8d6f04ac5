#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# man_page.sh HELP2MAN OUTPUT.gz ABOUT PROGRAM...: a man page from what PROGRAM (of another machine:
# under its emulator) says of itself and of each of its commands. The date is SOURCE_DATE_EPOCH's
# where that is set.
set -eu
here=$(dirname "$0")
help2man=$1 output=$2 about=$3
shift 3
for program in "$@"; do :; done # the last
name=$(basename "$program")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# help2man makes one paragraph of examples that have no line between them.
"$@" --help | awk '{ print } /^Examples?:/ { on = 1; next } !NF { on = 0 } on { print "" }' >"$folder/help"
"$@" --version >"$folder/version"
# help2man wants one program that answers.
cat >"$folder/$name" <<END
#!/bin/sh
case "\$1" in
  --version) cat '$folder/version' ;;
  *) cat '$folder/help' ;;
esac
END
chmod +x "$folder/$name"

commands_in() {
  awk '/^Subcommands:/ { on = 1; next } /^[^ ]/ { on = 0 } on && /^  [a-z]/ { print $1 }' "$1"
}
# describe FILE COMMAND...: a section of the page, from the command's help in FILE
describe() {
  file=$1
  shift
  printf '.SS "%s"\n' "$name $*"
  awk -v program="$program" -v name="$name" -f "$here/man_command.awk" "$file"
}
for command in $(commands_in "$folder/help"); do
  [ -s "$folder/commands" ] || echo '[COMMANDS]' >"$folder/commands"
  "$@" "$command" --help >"$folder/of-command"
  describe "$folder/of-command" "$command" >>"$folder/commands"
  for inner in $(commands_in "$folder/of-command"); do
    "$@" "$command" "$inner" --help >"$folder/of-inner"
    describe "$folder/of-inner" "$command" "$inner" >>"$folder/commands"
  done
done
"$help2man" --no-info --section=1 --name="$about" --source=Skein --manual='User Commands' \
  --opt-include="$folder/commands" "$folder/$name" >"$folder/page"
gzip -9n <"$folder/page" >"$output"
