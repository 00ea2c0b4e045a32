#!/bin/sh
# Lints of the shell scripts. Installs shellcheck where it is missing and may be installed.
cd "$(dirname "$0")/../.." || exit 1
. tests/cluster/packages.sh

have_shellcheck() { command -v shellcheck >/dev/null 2>&1; }
provide shellcheck have_shellcheck shellcheck
shellcheck -x plateau check .ci/run scripts/*.sh tests/scripts/*.sh tests/extra/*.sh tests/cluster/*.sh data/studies/*/*.sh packaging/*/*.sh
