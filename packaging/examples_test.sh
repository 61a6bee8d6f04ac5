#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# examples_test.sh FOLDER ONBOARD GROUND: the configurations that are installed as examples are good.
set -eu
for file in "$1"/onboard-*.yaml; do "$2" --check-config --config "$file"; done
"$3" --check-config --config "$1/ground.yaml"
