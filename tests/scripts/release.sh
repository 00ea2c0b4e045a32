#!/bin/sh
# scripts/release.sh with a stand-in for the build of the wheel: what it refuses, and what it makes of a wheel.
set -u

repository=$(CDPATH='' cd -P "${0%/*}/../.." && pwd -P) || exit 1
sandbox=$(mktemp -d) || exit 1
trap 'rm -rf "$sandbox"' EXIT
checkout="$sandbox/check out"
failures=0
unset CARGO_TARGET_DIR PLATEAU_FEATURES
# No settings of the user's.
HOME=$sandbox
GIT_CONFIG_NOSYSTEM=1
export HOME GIT_CONFIG_NOSYSTEM

expect() {
    if [ "$2" != "$3" ]; then
        failures=$((failures + 1))
        printf 'FAILED %s\n  expected: %s\n  found:    %s\n' "$1" "$3" "$2"
    fi
}

# refused WHAT MESSAGE ARGUMENT...
refused() {
    what=$1
    message=$2
    shift 2
    found=$(sh "$checkout/scripts/release.sh" "$@" 2>&1 >/dev/null)
    expect "$what: exit status" $? 1
    expect "$what: message" "$found" "plateau: $message"
}

commit() {
    git -C "$checkout" -c user.name=x -c user.email=x@x commit -qam "$1"
}

mkdir -p "$checkout/data/studies" || exit 1
for part in scripts packaging data/scenes data/surfaces data/cycles data/scene.schema.json LICENSE-MIT LICENSE-APACHE README.md; do
    cp -R "$repository/$part" "$checkout/$part"
done
cp "$repository"/data/studies/*.toml "$repository"/data/studies/*.csv "$checkout/data/studies"
printf '[workspace.package]\nversion = "1.2.3"\nrust-version = "1.95"\n' >"$checkout/Cargo.toml"
printf 'cff-version: 1.2.0\nversion: 1.2.3\n' >"$checkout/CITATION.cff"
printf '# Changelog\n\n## 1.2.3 (unreleased)\n\n- New.\n\nUse:\n\n- Old.\n\n## 1.2.2\n\n- Older.\n' >"$checkout/CHANGELOG.md"
# The wheel: a program that is a script, its notices, and a list of components.
cat >"$checkout/scripts/wheel.sh" <<'END'
#!/bin/sh
python3 - "$1/plateau_brake-1.2.3-cp311-abi3-manylinux_2_28_x86_64.whl" <<'PYTHON'
import sys, zipfile
program = '''#!/bin/sh
case $1 in
    --version) echo plateau 1.2.3 ;;
    man) : >"$4/plateau.1" ;;
    completions) echo "completions of $2" ;;
esac
'''
with zipfile.ZipFile(sys.argv[1], "w") as wheel:
    wheel.writestr("plateau_brake-1.2.3.data/scripts/plateau", program)
    wheel.writestr("plateau_brake-1.2.3.dist-info/licenses/THIRD-PARTY-NOTICES", "notices")
    wheel.writestr("plateau_brake-1.2.3.dist-info/sboms/program.cdx.json", "{}")
print(sys.argv[1])
PYTHON
END
git -C "$checkout" init -q
git -C "$checkout" add .
commit first

refused 'no tag of a release' '1.2.3 is no tag of a release: expected one such as v0.1.0' 1.2.3
refused 'another version' 'Cargo.toml names version 1.2.3, the tag 1.2.4' v1.2.4
refused 'no date' 'CHANGELOG.md says that 1.2.3 is unreleased: put the date there' v1.2.3
sed -i 's/ (unreleased)/ (2026-01-02)/' "$checkout/CHANGELOG.md"
refused 'no such tag' 'v1.2.3 is not the checked-out revision' v1.2.3
git -C "$checkout" tag v1.2.3
refused 'changes' 'the checkout has changes: commit or stash them' v1.2.3
commit date
refused 'a tag elsewhere' 'v1.2.3 is not the checked-out revision' v1.2.3
git -C "$checkout" tag -f v1.2.3 >/dev/null
sed -i 's/1.2.3/1.2.0/' "$checkout/CITATION.cff"
refused 'another version in the citation' 'CITATION.cff names version 1.2.0, the tag 1.2.3' v1.2.3
git -C "$checkout" checkout -q CITATION.cff

dist=$sandbox/dist
sh "$checkout/scripts/release.sh" v1.2.3 "$dist" 2>"$sandbox/said" || { cat "$sandbox/said" && exit 1; }
expect 'the files' "$(cd "$dist" && echo ./*)" "./NOTES.md ./SHA256SUMS ./plateau-1.2.3-$(uname -m)-linux.tar.gz \
./plateau-1.2.3.cdx.json ./plateau_brake-1.2.3-cp311-abi3-manylinux_2_28_x86_64.whl"
expect 'the checksums' "$(cd "$dist" && sha256sum --check --quiet SHA256SUMS 2>&1)" ''
expect 'files with checksums' "$(wc -l <"$dist/SHA256SUMS")" 3
expect 'the notes' "$(cat "$dist/NOTES.md")" '- New.

Use:

- Old.'
tar -xzf "$dist"/plateau-1.2.3-*.tar.gz -C "$sandbox"
installed=$sandbox/plateau-1.2.3-$(uname -m)-linux
expect 'the program in the archive' "$("$installed/bin/plateau" --version)" 'plateau 1.2.3'
expect 'its completions' "$(cat "$installed/share/zsh/site-functions/_plateau")" 'completions of zsh'
expect 'the notices' "$(cat "$installed/share/doc/plateau/THIRD-PARTY-NOTICES")" notices
expect 'the module' "$(grep -c 'Plateau 1.2.3' "$installed/share/modulefiles/plateau/1.2.3")" 1
expect 'the manual page' "$(ls "$installed/share/man/man1")" plateau.1
expect 'a scene' "$(cmp "$repository/data/scenes/quick.toml" "$installed/share/plateau/scenes/quick.toml")" ''
before=$(sha256sum <"$dist/plateau-1.2.3-$(uname -m)-linux.tar.gz")
sleep 1
sh "$checkout/scripts/release.sh" v1.2.3 "$dist" 2>/dev/null
expect 'the same bytes again' "$(sha256sum <"$dist/plateau-1.2.3-$(uname -m)-linux.tar.gz")" "$before"

printf '#!/bin/sh\nexit 1\n' >"$checkout/scripts/wheel.sh"
commit 'no wheel'
git -C "$checkout" tag -f v1.2.3 >/dev/null
refused 'a wheel that cannot be built' 'there is no wheel, see above' v1.2.3 "$sandbox/none"

[ $failures -eq 0 ] || exit 1
echo 'a release is what it should be'
