# Python environments inside the checkout, without root and without Debian's python3-venv. Sourced after say.sh.
# shellcheck shell=sh disable=SC2154

# make_venv DIR: a virtual environment with pip in it; pip comes from wherever this machine has one.
make_venv() {
    venv=$1
    if [ -x "$venv/bin/python" ] && "$venv/bin/python" -m pip --version >/dev/null 2>&1; then
        return 0
    fi
    command -v python3 >/dev/null 2>&1 || die "python3 is missing: install python3"
    rm -rf "$venv"
    run_quietly python3 -m venv --without-pip "$venv" || die "python3 -m venv failed: install python3-venv"
    pip_from_ensurepip || pip_from_system || pip_from_wheel ||
        die "no pip for Python: install python3-venv or python3-pip"
}

# fill_venv DIR LIST...: a virtual environment with the packages of the lists, which are installed when the lists are others than before.
# To be called with a lock.
fill_venv() {
    make_venv "$1"
    folder=$1
    shift
    cat "$@" | cmp -s - "$folder/installed.txt" && return 0
    say "installing the packages of $* into $folder"
    for list; do
        run_quietly "$folder/bin/python" -m pip install --quiet -r "$list" || return 1
    done
    cat "$@" >"$folder/installed.txt"
}

# What the package needs for all that it answers.
answers=python/requirements.txt

# Whether the environment .venv of the checkout, `root`, has these packages, and maybe more.
has_answers() {
    [ -x "$root/.venv/bin/python" ] && [ -f "$root/.venv/installed.txt" ] && head -c "$(($(wc -c <"$root/$answers")))" "$root/.venv/installed.txt" | cmp -s - "$root/$answers"
}

# Those packages, in .venv. To be called with its lock, .venv.lock.
install_answers() {
    has_answers || (cd "$root" && fill_venv "$root/.venv" "$answers")
}

# The same with what the checks read run files and surfaces with. To be called with that lock.
install_readers() {
    (cd "$root" && fill_venv "$root/.venv" "$answers" tests/python/requirements.txt)
}

pip_from_ensurepip() {
    "$venv/bin/python" -m ensurepip >/dev/null 2>&1 </dev/null
}

# Debian forbids its own pip to install anything beside its packages, but not into a named folder.
pip_from_system() {
    python3 -m pip --version >/dev/null 2>&1 || return 1
    site_packages=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))') || return 1
    run_quietly python3 -m pip install --quiet --target "$site_packages" pip
}

# Debian and Ubuntu package pip as a wheel, which Python runs as it is. A user may download and unpack a package;
# apt then needs folders of its own.
pip_from_wheel() {
    for wheel in /usr/share/python-wheels/pip-*.whl; do
        [ ! -f "$wheel" ] || { run_wheel_to_install_pip "$wheel" && return 0; }
    done
    command -v apt-get >/dev/null 2>&1 && command -v dpkg-deb >/dev/null 2>&1 || return 1
    say "getting pip out of the distribution's package python3-pip-whl"
    unpacked=$(mktemp -d) || return 1
    unpack_pip_package "$unpacked"
    unpacked_status=$?
    rm -rf "$unpacked"
    return $unpacked_status
}

unpack_pip_package() (
    cd "$1" || exit 1
    mkdir -p state/lists/partial cache/archives/partial || exit 1
    set -- -o "Dir::State=$1/state" -o "Dir::State::Lists=$1/state/lists" -o "Dir::Cache=$1/cache" \
        -o Dir::State::status=/var/lib/dpkg/status
    apt-get download python3-pip-whl >/dev/null 2>&1 </dev/null ||
        { run_quietly apt-get "$@" update && run_quietly apt-get "$@" download python3-pip-whl; } || exit 1
    for package in python3-pip-whl_*.deb; do
        dpkg-deb -x "$package" . || exit 1
    done
    for wheel in usr/share/python-wheels/pip-*.whl; do
        run_wheel_to_install_pip "$PWD/$wheel" || exit 1
    done
)

run_wheel_to_install_pip() {
    run_quietly "$venv/bin/python" "$1/pip" install --quiet pip
}
