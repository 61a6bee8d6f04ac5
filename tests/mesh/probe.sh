#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# probe.sh MESH_PROBE ARGUMENT...: runs it beside the machines of network.sh, with their links.
set -euo pipefail

"$@" | "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/links.sh"
