#!/bin/sh
# The files of `plateau export --to vtk` in VTK's own readers, which are ParaView's, and through pyvista, which reads .pvd.
# Installs the Python package vtk (800 MB with what it needs) into a folder of its own.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
. tests/cluster/packages.sh
. scripts/paths.sh
. scripts/say.sh
. scripts/lock.sh
. scripts/toolchain.sh

# What the files hold is read by tests/python/test_export.py at every push.
only_when_long 'installs vtk, 800 MB'

venv=$root/.venv-paraview
if ! with_lock .venv-paraview.lock fill_venv "$venv" tests/extra/paraview-requirements.txt; then
    echo 'the Python package vtk could not be installed'
    exit 77
fi
prepare_toolchain
sh scripts/build.sh || exit 1
PATH=$root/python/bin:$PATH PLATEAU_PROGRAM=$program "$venv/bin/python" -B tests/extra/paraview.py
