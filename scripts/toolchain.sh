# Everything cargo needs to build the workspace. Sourced after say.sh with `root` and `features` set.
# shellcheck shell=sh disable=SC2034,SC2154

. "$root/scripts/rust.sh"
. "$root/scripts/python.sh"
. "$root/scripts/cmake.sh"

# Ends the script with one line about what to install, where something is missing.
prepare_toolchain() {
    need_rust
    need_c_compiler
    case ,$features, in
        ,, | *,static-hdf5,*) provide_cmake ;;
    esac
}

# Options for cargo. Unquoted on purpose where it is used.
feature_options=${features:+--no-default-features --features $features}
