#!/bin/sh
# Build the program with MPI on Debian or Ubuntu and install it into a folder: the first stage of Containerfile and plateau.def. As root,
# in the checkout: it installs compilers, Open MPI, libclang and Rust.
#
# usage: packaging/container/build.sh PREFIX
set -eu
cd "$(dirname "$0")/../.."

export DEBIAN_FRONTEND=noninteractive
apt-get update
apt-get install -y --no-install-recommends \
    ca-certificates curl gcc git libc6-dev libclang-dev libopenmpi-dev make openmpi-bin python3 python3-venv
if ! command -v cargo >/dev/null 2>&1 && [ ! -x "$HOME/.cargo/bin/cargo" ]; then
    version=$(sed -n 's/^rust-version *= *"\(.*\)"/\1/p' Cargo.toml)
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile minimal --default-toolchain "$version"
fi
PATH=$HOME/.cargo/bin:$PATH
# The checkout may belong to somebody else than root.
git config --global --add safe.directory "$PWD"

PLATEAU_FEATURES=mpi
export PATH PLATEAU_FEATURES
sh scripts/build.sh
sh scripts/install.sh "$1"
