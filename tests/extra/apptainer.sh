#!/bin/sh
# packaging/container/plateau.def built and used with Apptainer, all as an ordinary user. Where Apptainer is installed, it builds the recipe
# as it is, from Docker Hub. Debian 12 has no package of it; there root makes a folder with Debian sid, which has one, and a clean Debian 12
# in place of the image of Docker Hub, with Rust from this machine, read-only.
# What is between single quotes is for other shells.
# shellcheck disable=SC2016
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
. tests/cluster/packages.sh
. tests/cluster/debian.sh

only_when_long 'builds for a quarter of an hour'
if ! command -v apptainer >/dev/null 2>&1 && [ "$(id -u)" -ne 0 ]; then
    echo 'Apptainer is not installed, and only root may make the system with it'
    exit 77
fi
# PLATEAU_CONTAINERS names a folder whose systems are kept.
lab=$(mktemp -d) || exit 1
sid=${PLATEAU_CONTAINERS:-$lab}/sid
clean=$sid/opt/bookworm
clean_up() {
    leave_debian "$clean"
    leave_debian "$sid"
    rm -rf "$lab"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
fail() {
    tail -n 20 "$lab/said"
    echo "$*"
    exit 1
}

# in_sid COMMANDS: as an ordinary user of Debian sid, in the home folder. Apptainer makes a user namespace, which no process in a chroot may:
# the folder becomes the root of a mount namespace, whose mounts end with the last process in it. Of devices there is what a machine
# lets everybody use, with /dev/fuse, by which an ordinary user mounts an image.
in_sid() {
    unshare --mount --propagation private sh -euc '
        mount --bind "$1" "$1"
        mount --bind "$2" "$1/opt/rust"
        mount -o remount,bind,ro "$1/opt/rust"
        cd "$1"
        mount -t proc proc proc
        mount -t sysfs sysfs sys
        mount -t tmpfs -o mode=755 devices dev
        mkdir dev/pts dev/shm
        mount -t tmpfs -o mode=1777 shm dev/shm
        mount -t devpts -o newinstance,ptmxmode=666 devpts dev/pts
        ln -s pts/ptmx dev/ptmx
        ln -s /proc/self/fd dev/fd
        ln -s fd/0 dev/stdin
        ln -s fd/1 dev/stdout
        ln -s fd/2 dev/stderr
        umask 0
        mknod dev/null c 1 3
        mknod dev/zero c 1 5
        mknod dev/full c 1 7
        mknod dev/random c 1 8
        mknod dev/urandom c 1 9
        mknod dev/tty c 5 0
        mknod dev/fuse c 10 229
        umask 022
        pivot_root . mnt
        umount -l /mnt
        exec setpriv --reuid=user --regid=user --init-groups env -i PATH=/usr/bin:/bin HOME=/home/user sh -euc "cd && $3"
    ' sh "$sid" "$(rustc --print sysroot)" "$1"
}

if command -v apptainer >/dev/null 2>&1; then
    as_it_is=yes
    home=$lab
    user_does() { (cd "$home" && sh -euc "$1"); }
else
    as_it_is=
    home=$sid/home/user
    user_does() { in_sid "$1"; }
    make_debian sid "$sid" apptainer squashfuse
    # Apptainer takes it over into the container.
    echo '127.0.0.1 localhost' >"$sid/etc/hosts"
    mkdir -p "$sid/opt/rust"
    in_sid 'unshare --user true' >"$lab/said" 2>&1 || { tail -n 1 "$lab/said" && echo 'an ordinary user can make no user namespace here' && exit 77; }
    # The recipe looks for cargo where rustup puts it.
    make_debian bookworm "$clean"
    mkdir -p "$clean/opt/rust" "$clean/root/.cargo" && ln -sfn /opt/rust/bin "$clean/root/.cargo/bin" || exit 1
    leave_debian "$clean"
    # Some of its files only root can read; of an image everybody reads all.
    [ -f "$sid/opt/bookworm.squashfs" ] || inside "$sid" mksquashfs /opt/bookworm /opt/bookworm.squashfs >"$lab/said" 2>&1 ||
        fail 'no image of Debian 12 can be made'
fi

git clone -q "$root" "$home/plateau" || exit 1
recipe=packaging/container/plateau.def
options=
if [ -z "$as_it_is" ]; then
    sed 's/^Bootstrap: docker$/Bootstrap: localimage/; s|^From: debian:bookworm-slim$|From: /opt/bookworm.squashfs|' "$home/plateau/$recipe" >"$home/local.def"
    ! grep -E '^(Bootstrap|From): ' "$home/local.def" | grep -vE ' (localimage|/opt/bookworm.squashfs)$' ||
        { echo "$recipe does not take debian:bookworm-slim from Docker Hub" && exit 1; }
    recipe=../local.def
    options='--bind /opt/rust'
    inside "$sid" chown -R user: /home/user || exit 1
fi
began=$(date +%s)
if ! user_does "cd plateau && apptainer build $options ../plateau.sif $recipe" >"$lab/said" 2>&1; then
    if grep 'conveyor failed to get' "$lab/said"; then
        echo 'the image of Debian 12 on Docker Hub cannot be had here'
        exit 77
    fi
    fail 'Apptainer does not build the recipe'
fi
echo "$(user_does 'apptainer --version') built the recipe in $(($(date +%s) - began)) s: $(du -m "$home/plateau.sif" | cut -f 1) MB"

user_does 'apptainer test plateau.sif >/dev/null
    apptainer run-help plateau.sif | grep -qF "apptainer run plateau.sif run scene.toml"
    apptainer inspect plateau.sif | grep -qxF "org.opencontainers.image.title: Plateau"
    scene=/opt/plateau/share/plateau/scenes/quick.toml
    apptainer run plateau.sif run $scene -o one.h5 >/dev/null
    apptainer exec plateau.sif mpirun --oversubscribe -n 2 plateau run $scene -o two.h5 >/dev/null
    for run in one two; do
        apptainer run plateau.sif surface $run.h5 --dataset disc/height --at "60 s" --to $run.npy >/dev/null
    done
    cmp one.npy two.npy' >"$lab/said" 2>&1 || fail 'what Apptainer built does not run'
echo 'as an ordinary user: its test, its help and labels, a run, and the same heights from two ranks'
