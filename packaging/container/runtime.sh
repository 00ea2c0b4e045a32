#!/bin/sh
# What the program built with MPI needs to run on Debian or Ubuntu: the second stage of Containerfile and plateau.def. As root.
set -eu
export DEBIAN_FRONTEND=noninteractive
apt-get update
# Ranks on several machines start each other with ssh where there is no batch system.
apt-get install -y --no-install-recommends openmpi-bin openssh-client
rm -rf /var/lib/apt/lists/*
