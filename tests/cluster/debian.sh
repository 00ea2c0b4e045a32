# A clean Debian in a folder, to try what users have there. Sourced after packages.sh; only root can make one.
# shellcheck shell=sh

have_debootstrap() { command -v debootstrap >/dev/null 2>&1; }

# make_debian RELEASE DIR [PACKAGE...]: a minimal system with these packages, if it is not in DIR yet, with the names and certificates of this
# machine. Ends the script with 77 where there can be none.
make_debian() {
    release=$1
    debian=$2
    shift 2
    provide debootstrap have_debootstrap debootstrap
    if [ ! -f "$debian/made" ]; then
        packages=$(echo ca-certificates "$@" | tr ' ' ',')
        made=$(debootstrap --variant=minbase --include="$packages" "$release" "$debian" http://deb.debian.org/debian 2>&1) || {
            printf '%s\n' "$made" | tail -n 5
            echo "Debian $release cannot be had here"
            exit 77
        }
        touch "$debian/made"
    fi
    [ -e "$debian/proc/self" ] || mount -t proc proc "$debian/proc" || { echo "no /proc can be mounted for Debian $release" && exit 77; }
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
