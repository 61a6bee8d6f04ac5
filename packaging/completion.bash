# shellcheck shell=bash
# Bash completion of Skein's programs, from what they say of themselves: options and commands are
# those that the --help of the words typed so far lists, and otherwise files.

_skein_complete() {
  local program=$1 word=$2 before=$3 help given=() typed words=
  for typed in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $typed =~ ^[a-z][a-z-]*$ ]] && given+=("$typed")
  done
  # What follows the command may be an argument of it.
  help=$("$program" "${given[@]}" --help 2>/dev/null) ||
    help=$("$program" "${given[@]:0:1}" --help 2>/dev/null) || help=$("$program" --help 2>/dev/null)
  if [[ $word == -* ]]; then
    words=$(awk '{ for (i = 1; i <= 2 && i <= NF; ++i) if ($i ~ /^--?[a-z]/) { sub(/[,:].*/, "", $i); print $i } }' <<<"$help")
  elif [[ $before != --* ]] || ! grep -qE "^  (-.,)?$before [A-Z]" <<<"$help"; then # not an option's value
    words=$(awk '/^Subcommands:/ { on = 1; next } /^[^ ]/ { on = 0 } on && /^  [a-z]/ { print $1 }' <<<"$help")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  ((${#COMPREPLY[@]})) || mapfile -t COMPREPLY < <(compgen -f -- "$word")
}
complete -o filenames -F _skein_complete skein skein-onboard skein-ground skein-ros2 skein-hil skein-fc
