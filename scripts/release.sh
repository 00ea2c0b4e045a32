#!/bin/sh
# Make what is given away with a release: the wheel, the program with its manual pages, scenes and licences as an archive (the same program,
# with HDF5 in it, for Linux with glibc 2.28 or newer), the list of components (CycloneDX), the section of the changelog, and checksums.
#
# usage: scripts/release.sh [--try] TAG [FOLDER]
#   TAG     such as v0.1.0; it has to be on the checked-out revision, with nothing changed, the version that of Cargo.toml
#   FOLDER  where all of it goes, dist in the checkout unless given
#   --try   also before the tag and the date in CHANGELOG.md are there
set -u

root=$(CDPATH='' cd -P "${0%/*}/.." && pwd -P) || exit 1
. "$root/scripts/say.sh"

trial=
[ "${1:-}" != --try ] || { trial=yes && shift; }
[ $# -ge 1 ] || { say "usage: scripts/release.sh [--try] TAG [FOLDER]" && exit 2; }
tag=$1
version=${tag#v}
folder=${2:-$root/dist}
case $folder in /*) ;; *) folder=$PWD/$folder ;; esac

git_here() {
    git -C "$root" "$@"
}

# Everything that names a version names this one, and it is this revision that is given away.
check_tag() {
    [ "$tag" = "v$version" ] || die "$tag is no tag of a release: expected one such as v0.1.0"
    for file in Cargo.toml CITATION.cff; do
        named=$(sed -n 's/^version *[=:] *"\{0,1\}\([0-9.]*\)"\{0,1\}$/\1/p' "$root/$file" | head -n 1)
        [ "$named" = "$version" ] || die "$file names version $named, the tag $version"
    done
    [ -n "$(section)" ] || die "CHANGELOG.md has no section '## $version'"
    [ -z "$trial" ] || return 0
    ! section | head -n 1 | grep -q unreleased || die "CHANGELOG.md says that $version is unreleased: put the date there"
    [ "$(git_here rev-parse HEAD)" = "$(git_here rev-parse --verify --quiet "$tag^{commit}")" ] || die "$tag is not the checked-out revision"
    [ -z "$(git_here status --porcelain)" ] || die "the checkout has changes: commit or stash them"
}

# The section of this version in the changelog.
section() {
    awk -v version="$version" '/^## / { inside = ($2 == version) } inside' "$root/CHANGELOG.md"
}

# The program, the notices and the list of components out of the wheel, so that there is one build.
archive() {
    python3 -m zipfile -e "$wheel" "$scratch/wheel" || die "$wheel cannot be unpacked"
    program=$scratch/wheel/plateau_brake-$version.data/scripts/plateau
    chmod 755 "$program" || exit 1
    sh "$root/scripts/install.sh" "$scratch/$name" "$program" \
        "$scratch/wheel/plateau_brake-$version.dist-info/licenses/THIRD-PARTY-NOTICES" || exit 1
    # The same bytes from the same revision.
    date=$(git_here log -1 --format=%ct) || exit 1
    (cd "$scratch" && tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$date" -cf - "$name" | gzip -n -9) \
        >"$folder/$name.tar.gz" || die "cannot write $folder/$name.tar.gz"
    cp "$scratch/wheel/plateau_brake-$version.dist-info/sboms/program.cdx.json" "$folder/plateau-$version.cdx.json" ||
        die "the wheel has no list of the components of the program"
}

check_tag
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$folder" || exit 1
wheel=$(sh "$root/scripts/wheel.sh" "$folder" | tail -n 1)
[ -f "$wheel" ] || die "there is no wheel, see above"
name=plateau-$version-$(uname -m)-linux
archive
section | tail -n +3 >"$folder/NOTES.md"
(cd "$folder" && sha256sum -- "${wheel##*/}" "$name.tar.gz" "plateau-$version.cdx.json" >SHA256SUMS) || exit 1
say "in $folder: ${wheel##*/}, $name.tar.gz, plateau-$version.cdx.json, NOTES.md, SHA256SUMS"
