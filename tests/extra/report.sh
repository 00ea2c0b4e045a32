#!/bin/sh
# The page of plateau report in headless Chromium. Installs Chromium and its driver where they are missing and may be installed.
set -u
cd "$(dirname "$0")/../.." || exit 1
# shellcheck disable=SC2034
root=$PWD

have_browser() {
    command -v chromium >/dev/null 2>&1 && command -v chromedriver >/dev/null 2>&1
}

if ! have_browser; then
    if [ "$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null 2>&1; then
        echo 'Chromium or chromedriver is not installed, and only root may install them'
        exit 77
    fi
    if ! { apt-get update && apt-get install -y --no-install-recommends chromium chromium-driver && have_browser; }; then
        echo 'Chromium or chromedriver is not installed, and apt-get could not install them'
        exit 77
    fi
fi

. scripts/paths.sh
sh scripts/build.sh || exit 1
PATH=$root/python/bin:$PATH PLATEAU_PROGRAM=$program python3 -B -m unittest discover -s tests/browser -p 'test_*.py'
