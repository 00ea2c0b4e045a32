#!/bin/sh
# The program in a folder of its own, as an environment module, and through EasyBuild. Installs Environment Modules where they are missing
# and may be installed; EasyBuild comes with pip into a folder that goes with the check. PLATEAU_PROGRAM names a program that is built.
# What is between single quotes is for the shell of the modules.
# shellcheck disable=SC2016
set -u
cd "$(dirname "$0")/../.." || exit 1
# shellcheck disable=SC2034
root=$PWD
. tests/cluster/packages.sh
. scripts/paths.sh
. scripts/say.sh
. scripts/python.sh

only_when_long 'takes some minutes'

have_modules() { [ -f /usr/share/modules/init/sh ]; }
provide 'Environment Modules' have_modules environment-modules
if [ -n "${PLATEAU_PROGRAM:-}" ]; then program=$PLATEAU_PROGRAM; else sh scripts/build.sh || exit 1; fi

lab=$(mktemp -d) || exit 1
trap 'rm -rf "$lab"' EXIT
fail() {
    echo "$*"
    exit 1
}

version=$("$program" --version) && version=${version#plateau } && version=${version%% *}
name=plateau-$version-$(uname -m)-linux
sh scripts/install.sh "$lab/$name" "$program" || exit 1
grep -q hdf5-metno-src "$lab/$name/share/doc/plateau/THIRD-PARTY-NOTICES" || fail 'the notices do not name HDF5'

# A shell of its own, so that nothing of the modules is left here.
modules() {
    env -u PLATEAU_PROGRAM sh -c '. /usr/share/modules/init/sh; module use "$1"; module load plateau || exit 1; eval "$2"' sh "$@"
}
found=$(modules "$lab/$name/share/modulefiles" 'command -v plateau; plateau --version | cut -d " " -f 1,2; echo "$PLATEAU_PROGRAM"')
[ "$found" = "$lab/$name/bin/plateau
plateau $version
$lab/$name/bin/plateau" ] || fail "the module gives: $found"
# Scenes find their surfaces, and this one the scene that it extends.
modules "$lab/$name/share/modulefiles" 'plateau check "$PLATEAU_SCENES/measured.toml" && plateau check "$PLATEAU_SCENES/drive.toml"' >/dev/null ||
    fail 'the scenes in the folder are not whole'
manual=$(modules "$lab/$name/share/modulefiles" 'printf "%s\n" "$MANPATH"')
case :$manual: in *":$lab/$name/share/man:"*) ;; *) fail "the manual pages are not in MANPATH: $manual" ;; esac
echo "plateau $version in a folder, as a module"

make_venv "$lab/venv"
"$lab/venv/bin/python" -m pip install --quiet easybuild pycodestyle || { echo 'EasyBuild cannot be had here; all else is right' && exit 77; }
# Where EasyBuild looks for the modules tool.
mkdir -p "$lab/modules/libexec" "$lab/sources"
ln -s /usr/lib/*/modulecmd.tcl "$lab/modules/libexec/modulecmd.tcl"
tar -czf "$lab/sources/$name.tar.gz" -C "$lab" "$name"
easybuild() (
    # shellcheck disable=SC1091
    . /usr/share/modules/init/sh
    MODULESHOME=$lab/modules
    PATH=$lab/venv/bin:$PATH
    EB_PYTHON=$lab/venv/bin/python
    # Where CI is root.
    EASYBUILD_ALLOW_USE_AS_ROOT_AND_ACCEPT_CONSEQUENCES=1
    export MODULESHOME PATH EB_PYTHON EASYBUILD_ALLOW_USE_AS_ROOT_AND_ACCEPT_CONSEQUENCES
    eb --modules-tool=EnvironmentModules --module-syntax=Tcl --prefix="$lab/easybuild" "$@"
)
easybuild --check-style packaging/easybuild/*.eb >"$lab/log" 2>&1 || fail "$(cat "$lab/log")"
# All that the other one depends on is among the recipes of EasyBuild; to build it all takes hours.
easybuild "packaging/easybuild/plateau-$version-foss-2026.1.eb" --robot --dry-run >"$lab/log" 2>&1 || fail "$(cat "$lab/log")"
easybuild "packaging/easybuild/plateau-$version.eb" --sourcepath="$lab/sources" >"$lab/log" 2>&1 || fail "$(cat "$lab/log")"
found=$(modules "$lab/easybuild/modules/all" 'command -v plateau')
[ "$found" = "$lab/easybuild/software/plateau/$version/bin/plateau" ] || fail "the module of EasyBuild gives: $found"
echo 'the same through EasyBuild'
