#!/bin/sh
# What plateau.study says of effects, levels, powers and polynomials, computed again by R from the same tables. Installs R with car, lme4,
# lmerTest, emmeans and MASS where they are missing and may be installed.
set -u
cd "$(dirname "$0")/../.." || exit 1
# shellcheck disable=SC2034
root=$PWD
. tests/cluster/packages.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh

# R and its packages are some 500 MB.
only_when_long 'installs R'

have_r() {
    Rscript -e 'for (one in c("car", "emmeans", "jsonlite", "lme4", "lmerTest", "MASS", "mvtnorm")) loadNamespace(one)' >/dev/null 2>&1
}
provide 'R, or one of its packages,' have_r r-base-core r-cran-car r-cran-emmeans r-cran-jsonlite r-cran-lme4 r-cran-lmertest \
    r-cran-mass r-cran-mvtnorm
with_lock .venv.lock install_readers || exit 1

lab=$(mktemp -d) || exit 1
trap 'rm -rf "$lab"' EXIT
.venv/bin/python -B tests/extra/r/tables.py "$lab/tables.json" && Rscript tests/extra/r/compare.R "$lab/tables.json"
