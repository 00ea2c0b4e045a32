# What building HDF5 needs: cmake 3.26 or newer, and make or ninja. Sourced after say.sh, rust.sh, python.sh, lock.sh.
# shellcheck shell=sh disable=SC2154

# Sets and exports CMAKE, CMAKE_GENERATOR and PATH for cargo where this machine has no such tools.
provide_cmake() {
    build_tools=
    if [ -n "${CMAKE:-}" ]; then
        cmake_suffices "$CMAKE" || die "CMAKE is '$CMAKE', which is no cmake 3.26 or newer: correct it or unset it"
    elif ! cmake_suffices cmake; then
        build_tools=cmake
    fi
    if [ -z "${CMAKE_GENERATOR:-}" ] && ! command -v make >/dev/null 2>&1; then
        CMAKE_GENERATOR=Ninja
        export CMAKE_GENERATOR
        command -v ninja >/dev/null 2>&1 || build_tools="${build_tools:+$build_tools }ninja"
    fi
    [ -n "$build_tools" ] || return 0

    build_venv=$root/.venv-build
    [ -w "$root" ] || build_venv=$target/venv-build
    with_lock "$build_venv.lock" install_build_tools || exit 1
    PATH=$build_venv/bin:$PATH
    case $build_tools in
        *cmake*) CMAKE=$build_venv/bin/cmake && export CMAKE ;;
    esac
}

cmake_suffices() {
    cmake_version=$("$1" --version 2>/dev/null) || return 1
    cmake_version=${cmake_version#cmake version }
    version_at_least "${cmake_version%%[!0-9.]*}" 3.26
}

install_build_tools() {
    ! build_tools_installed || return 0
    say "getting $build_tools, which the build asks for even where HDF5 is built, into $build_venv"
    make_venv "$build_venv"
    run_quietly "$build_venv/bin/python" -m pip install --quiet -r "$root/scripts/build-requirements.txt" ||
        die "pip could not install $build_tools: install cmake 3.26 or newer and make, or set CMAKE"
}

build_tools_installed() {
    case $build_tools in *cmake*) cmake_suffices "$build_venv/bin/cmake" || return 1 ;; esac
    case $build_tools in *ninja*) "$build_venv/bin/ninja" --version >/dev/null 2>&1 || return 1 ;; esac
}
