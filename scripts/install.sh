#!/bin/sh
# Install the program that is built, with manual pages, completions, scenes, licences and an environment module, as one folder.
#
# usage: scripts/install.sh PREFIX [PROGRAM [NOTICES]]
#   PREFIX   the folder, such as /apps/plateau/0.1.0; what is in it is replaced file by file
#   PROGRAM  the program, unless given that of this checkout
#   NOTICES  the notices of works in it (scripts/notices.py), unless given they are collected anew
set -u

root=$(CDPATH='' cd -P "${0%/*}/.." && pwd -P) || exit 1
. "$root/scripts/paths.sh"
. "$root/scripts/say.sh"
. "$root/scripts/toolchain.sh"

[ $# -ge 1 ] || { say "usage: scripts/install.sh PREFIX [PROGRAM [NOTICES]]" && exit 2; }
prefix=$1
program=${2:-$program}
notices=${3:-}
case $prefix in /*) ;; *) prefix=$PWD/$prefix ;; esac
case $program in /*) ;; *) program=$PWD/$program ;; esac
[ -x "$program" ] || die "$program is no program: build it with ./plateau, or name it"
version=$("$program" --version) || die "$program does not run"
version=${version#plateau }
version=${version%% *}

make_folder() {
    mkdir -p "$1" || die "cannot make $1"
}

put() {
    make_folder "$2"
    cp -R "$1" "$2" || die "cannot write $2"
}

make_folder "$prefix/bin"
cp "$program" "$prefix/bin/plateau" || die "cannot write $prefix/bin/plateau"
chmod 755 "$prefix/bin/plateau"
# It runs as well with what only debuggers need.
! command -v strip >/dev/null 2>&1 || strip "$prefix/bin/plateau" 2>/dev/null

make_folder "$prefix/share/man/man1"
run_quietly "$program" man --force -o "$prefix/share/man/man1" || exit 1
for shell in bash:bash-completion/completions/plateau zsh:zsh/site-functions/_plateau fish:fish/vendor_completions.d/plateau.fish; do
    file=$prefix/share/${shell#*:}
    make_folder "${file%/*}"
    "$program" completions "${shell%%:*}" >"$file" || die "cannot write $file"
done

for text in LICENSE-MIT LICENSE-APACHE CHANGELOG.md README.md; do
    put "$root/$text" "$prefix/share/doc/plateau"
done
if [ -n "$notices" ]; then
    cp "$notices" "$prefix/share/doc/plateau/THIRD-PARTY-NOTICES" || die "cannot read $notices"
else
    # shellcheck disable=SC2086
    python3 "$root/scripts/notices.py" $feature_options >"$prefix/share/doc/plateau/THIRD-PARTY-NOTICES" ||
        die "the notices could not be collected, see above"
fi

# Scenes name surfaces and cycles by their places beside them.
for folder in scenes surfaces cycles; do
    put "$root/data/$folder" "$prefix/share/plateau"
done
put "$root/data/scene.schema.json" "$prefix/share/plateau"
make_folder "$prefix/share/plateau/studies"
cp "$root"/data/studies/*.toml "$root"/data/studies/*.csv "$prefix/share/plateau/studies" || die "cannot write the studies"

make_folder "$prefix/share/modulefiles/plateau"
sed "s|@VERSION@|$version|g" "$root/packaging/modulefiles/plateau.in" >"$prefix/share/modulefiles/plateau/$version" || die "cannot write the module file"
say "plateau $version is in $prefix; module use $prefix/share/modulefiles && module load plateau, or PATH=$prefix/bin:\$PATH"
