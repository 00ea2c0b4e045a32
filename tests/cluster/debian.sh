# A clean Debian or Ubuntu in a folder, to try what users have there. Sourced after packages.sh; only root can make one.
# shellcheck shell=sh

# The keys of Ubuntu's archive: Debian has no package of them. What they are is known by the digest.
UBUNTU=http://archive.ubuntu.com/ubuntu
UBUNTU_KEYS=$UBUNTU/pool/main/u/ubuntu-keyring/ubuntu-keyring_2021.03.26_all.deb
UBUNTU_KEYS_SHA256=0d0e7ed6b112f5d03eabf3c7eb01ebdacf9c57714b279e90495cfc58c8c4520f

have_debootstrap() { command -v debootstrap >/dev/null 2>&1; }

# make_debian RELEASE DIR [PACKAGE...]: a minimal system with these packages, if it is not in DIR yet, with the names and certificates of this
# machine. Ends the script with 77 where there can be none.
make_debian() {
    keys=
    make_system "$@"
}

# make_ubuntu RELEASE DIR [PACKAGE...]: the same of Ubuntu. Needs curl and dpkg-deb.
make_ubuntu() {
    keys=$(mktemp -d) || exit 1
    curl -sSf -o "$keys/keys.deb" "$UBUNTU_KEYS" || { echo 'the archive of Ubuntu cannot be reached' && exit 77; }
    echo "$UBUNTU_KEYS_SHA256  $keys/keys.deb" | sha256sum --check --quiet && dpkg-deb -x "$keys/keys.deb" "$keys" || exit 1
    make_system "$@"
    rm -rf "$keys"
}

# make_system RELEASE DIR [PACKAGE...]: that of Ubuntu if its keys are in the folder $keys, of Debian if that is empty.
make_system() {
    release=$1
    debian=$2
    shift 2
    provide debootstrap have_debootstrap debootstrap
    if [ ! -f "$debian/made" ]; then
        set -- --variant=minbase --include="$(echo ca-certificates "$@" | tr ' ' ',')"
        if [ -n "$keys" ]; then
            # All releases are made alike; debootstrap may be older than this one and not know its name.
            set -- "$@" --keyring="$keys/usr/share/keyrings/ubuntu-archive-keyring.gpg" --components=main,universe "$release" "$debian" \
                "$UBUNTU" /usr/share/debootstrap/scripts/gutsy
        else
            set -- "$@" "$release" "$debian" http://deb.debian.org/debian
        fi
        made=$(debootstrap "$@" 2>&1) || {
            printf '%s\n' "$made" | tail -n 5
            echo "$release cannot be had here"
            exit 77
        }
        touch "$debian/made"
    fi
    [ -e "$debian/proc/self" ] || mount -t proc proc "$debian/proc" || { echo "no /proc can be mounted in $debian" && exit 77; }
    cp /etc/resolv.conf "$debian/etc/resolv.conf"
    cp /etc/ssl/certs/ca-certificates.crt "$debian/etc/ssl/certs/ca-certificates.crt"
    inside "$debian" sh -ec 'id user >/dev/null 2>&1 || useradd -m user; rm -rf /home/user/*'
}

# inside DIR COMMAND...: as root, in that system.
inside() {
    debian=$1
    shift
    chroot "$debian" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root "$@"
}

# as_user DIR COMMANDS: as an ordinary user in the home folder.
as_user() {
    chroot --userspec=user:user "$1" env -i PATH=/usr/local/bin:/usr/bin:/bin HOME=/home/user PIP_CERT=/etc/ssl/certs/ca-certificates.crt \
        sh -ec "cd && $2"
}

# leave_debian DIR: nothing of this machine is mounted there any more.
leave_debian() {
    umount "$1/proc"
} 2>/dev/null
