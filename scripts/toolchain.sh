# Everything cargo needs to build the workspace. Sourced after say.sh with `root` and `features` set.
# shellcheck shell=sh disable=SC2034,SC2154

. "$root/scripts/rust.sh"
. "$root/scripts/python.sh"
. "$root/scripts/cmake.sh"

# Ends the script with one line about what to install, where something is missing.
prepare_toolchain() {
    need_rust
    need_c_compiler
    case ,$features, in *,mpi,*) need_mpi ;; esac
    case ,$features, in *,system-hdf5,*) ;; *) provide_cmake ;; esac
}

# What the crate mpi cannot do without; it also looks where these two variables of its own point to.
need_mpi() {
    [ -z "${MPI_PKG_CONFIG:-}${CRAY_MPICH_DIR:-}" ] || return 0
    command -v "${MPICC:-mpicc}" >/dev/null 2>&1 ||
        die "feature mpi: the compiler '${MPICC:-mpicc}' is missing: install libopenmpi-dev and libclang-dev," \
            "load your cluster's MPI module, or set MPICC"
}

# Options for cargo. Unquoted on purpose where it is used. The default features are those of the HDF5 that is built.
feature_options=${features:+--features $features}
case ,$features, in *,system-hdf5,*) feature_options="--no-default-features $feature_options" ;; esac
# The module of Python hands its simulations from thread to thread, which one on ranks does not allow.
workspace=--workspace module='-p plateau-python'
case ,$features, in *,mpi,*) workspace='--workspace --exclude plateau-python' module= ;; esac
