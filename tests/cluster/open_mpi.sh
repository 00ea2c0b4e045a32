# Open MPI, and the program built with it. Sourced in the root of the checkout, after packages.sh.
# shellcheck shell=sh disable=SC2154

have_mpi() {
    command -v mpirun >/dev/null 2>&1 && command -v mpicc >/dev/null 2>&1 && have_libclang
}

have_libclang() {
    [ -z "${LIBCLANG_PATH:-}" ] || return 0
    for library in /usr/lib/llvm-*/lib/libclang.so* /usr/lib64/libclang.so* /usr/lib/*/libclang*.so*; do
        [ ! -e "$library" ] || return 0
    done
    return 1
}

# Sets `mpirun`. Ends the script with 77 where there is no Open MPI.
provide_mpi() {
    provide 'Open MPI (mpirun, mpicc) or libclang' have_mpi openmpi-bin libopenmpi-dev libclang-dev
    case $(mpirun --version 2>&1) in
        *'Open MPI'* | *OpenRTE*) ;;
        *) echo 'mpirun is not that of Open MPI, whose options this check uses' && exit 77 ;;
    esac
    # More ranks than cores, and root where CI is root: both only here, on one machine and for seconds.
    mpirun='mpirun --oversubscribe'
    [ "$(id -u)" -ne 0 ] || mpirun="$mpirun --allow-run-as-root"
}

# Builds the program with feature mpi as $target/plateau-mpi. The one in the usual place, which others may run meanwhile, is there again
# afterwards. Called with PLATEAU_FEATURES=mpi and after paths.sh.
build_with_mpi() {
    for file in "$program" "$stamp"; do
        [ ! -f "$file" ] || ln -f "$file" "$file.before" || return 1
    done
    sh scripts/build.sh || return 1
    # cargo may have put there the very file that this one is.
    rm -f "$target/plateau-mpi"
    mv -f "$program" "$target/plateau-mpi" && mv -f "$stamp" "$target/plateau-mpi.stamp" || return 1
    for file in "$program" "$stamp"; do
        [ ! -f "$file.before" ] || mv -f "$file.before" "$file" || return 1
    done
}

# The same only if the copy is not up to date, and in the environment of a program without MPI.
need_program_with_mpi() (
    PLATEAU_FEATURES=mpi
    export PLATEAU_FEATURES
    . scripts/paths.sh
    (program=$target/plateau-mpi && stamp=$target/plateau-mpi.stamp && is_fresh) || build_with_mpi
)
