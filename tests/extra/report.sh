#!/bin/sh
# The page of plateau report in headless Chromium. Installs Chromium and its driver where they are missing and may be installed.
set -u
cd "$(dirname "$0")/../.." || exit 1
# shellcheck disable=SC2034
root=$PWD
. tests/cluster/packages.sh

have_browser() {
    command -v chromium >/dev/null 2>&1 && command -v chromedriver >/dev/null 2>&1
}

provide 'Chromium or chromedriver' have_browser chromium chromium-driver

. scripts/paths.sh
sh scripts/build.sh || exit 1
PATH=$root/python/bin:$PATH PLATEAU_PROGRAM=$program python3 -B -m unittest discover -s tests/browser -p 'test_*.py'
