# SPDX-License-Identifier: Apache-2.0
# roff of a command's --help: options and what they mean as a list, examples as they stand. `program`
# is how it was called, `name` what it is called.
function plain(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  if (text ~ /^[.']/) text = "\\&" text
  return text
}
/^Usage:/ {
  at = index($0, program)
  if (at) $0 = substr($0, 1, at - 1) name substr($0, at + length(program))
}
/^Examples?:/ {
  verbatim = 1
  print ".PP\n" plain($0) "\n.nf"
  next
}
verbatim && !NF {
  verbatim = 0
  print ".fi"
  next
}
verbatim {
  print plain($0)
  next
}
/^  [^ ]/ {
  sub(/^  /, "")
  at = match($0, /   */)
  print ".TP\n.B " plain(at ? substr($0, 1, at - 1) : $0)
  if (at) print plain(substr($0, at + RLENGTH))
  next
}
/^[A-Z][a-z]*:/ || !NF { print ".PP" }
NF {
  sub(/^ +/, "")
  print plain($0)
}
END { if (verbatim) print ".fi" }
