#!/bin/sh
# Build the user guide as a site with mdBook 0.5 and check its links.
#
# usage: scripts/site.sh [FOLDER], dist/site in the checkout unless given
#   PLATEAU_REPOSITORY  address under which the files of the repository can be read, for links to them
set -u

root=$(CDPATH='' cd -P "${0%/*}/.." && pwd -P) || exit 1
. "$root/scripts/say.sh"
. "$root/scripts/lock.sh"
. "$root/scripts/python.sh"
. "$root/scripts/tools.sh"

folder=${1:-$root/dist/site}
case $folder in /*) ;; *) folder=$PWD/$folder ;; esac
provide_tool mdbook || die "mdbook is missing and pip cannot install it, see above: cargo install --locked mdbook"
(cd "$root" && run_quietly mdbook build --dest-dir "$folder") || die "the site could not be built, see above"
python3 "$root/site/check.py" "$folder" || exit 1
say "the site is in $folder: open index.html there"
