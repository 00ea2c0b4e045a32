#!/bin/sh
# The guide as a site: it is built, every link within it leads somewhere, and KaTeX understands every formula. Needs node and npm
# for the formulas.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
. scripts/say.sh
. scripts/lock.sh
. scripts/python.sh
. scripts/tools.sh
provide_tool mdbook || { echo 'mdbook is missing, and pip cannot install it: cargo install --locked mdbook' && exit 77; }
lab=$(mktemp -d) || exit 1
trap 'rm -rf "$lab"' EXIT
sh scripts/site.sh "$lab/site" || exit 1

katex=$(sed -n 's|.*/npm/\(katex@[0-9.]*\)/.*css.*|\1|p' site/theme/head.hbs)
have_katex() { command -v node >/dev/null 2>&1 && (cd "$lab" && npm pack --silent "$katex" && tar -xzf katex-*.tgz) >/dev/null 2>&1; }
have_katex || { echo "the links are right; the formulas were not tried: node or $katex cannot be had here" && exit 77; }
# Browsers refuse files that are not these.
for file in katex.min.css katex.min.js; do
    digest=$(openssl dgst -sha384 -binary "$lab/package/dist/$file" | base64 -w 0)
    grep -q "dist/$file\" integrity=\"sha384-$digest\"" site/theme/head.hbs || { echo "the digest of $file is another one" && exit 1; }
done
node tests/extra/formulas.js "$lab/package/dist/katex.js" "$lab"/site/*.html "$lab"/site/evidence/*.html
