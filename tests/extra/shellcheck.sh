#!/bin/sh
# Lints of the shell scripts. Installs shellcheck where it is missing and may be installed.
cd "$(dirname "$0")/../.." || exit 1
if ! command -v shellcheck >/dev/null 2>&1; then
    if [ "$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null 2>&1; then
        echo 'shellcheck is not installed, and only root may install it'
        exit 77
    fi
    if ! { apt-get update && apt-get install -y --no-install-recommends shellcheck; }; then
        echo 'shellcheck is not installed, and apt-get could not install it'
        exit 77
    fi
fi
shellcheck -x plateau check .ci/run scripts/*.sh tests/scripts/*.sh tests/extra/*.sh tests/cluster/*.sh data/studies/*/*.sh packaging/*/*.sh
