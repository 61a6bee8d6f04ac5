#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# man_page.sh HELP2MAN OUTPUT.gz ABOUT PROGRAM...: a man page from what PROGRAM (of another machine:
# under its emulator) says of itself. The date is SOURCE_DATE_EPOCH's where that is set.
set -eu
help2man=$1 output=$2 about=$3
shift 3
for program in "$@"; do :; done # the last
name=$(basename "$program")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$@" --help-all >"$folder/help"
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
"$help2man" --no-info --section=1 --name="$about" --source=Skein \
  --manual='User Commands' "$folder/$name" >"$folder/page"
gzip -9n <"$folder/page" >"$output"
