from pathlib import Path

from spack.package import *
from spack_repo.builtin.build_systems.cargo import CargoPackage


class Plateau(CargoPackage):
    """Contact area, contact pressure, topography and secondary plateaus of a brake pin on a rough, coated disc, by a cellular automaton."""

    # The clone that has this recipe: the source comes from it, wherever it is.
    git = f"file://{Path(__file__).resolve().parents[6]}"

    license("MIT OR Apache-2.0")

    version("main", branch="main")
    version("0.1.0", tag="v0.1.0")

    variant("mpi", default=True, description="Runs on several machines")
    variant("system_hdf5", default=True, description="Links the HDF5 of Spack in place of one of its own")

    depends_on("c", type="build")
    # Not `master` and `nightly`, which are above all numbers.
    depends_on("rust@1.94:1", type="build")
    depends_on("hdf5~mpi", when="+system_hdf5")
    depends_on("pkgconfig", type="build", when="+system_hdf5")
    depends_on("cmake@3.26:", type="build", when="~system_hdf5")
    depends_on("mpi", when="+mpi")
    # It reads the headers of the MPI library.
    depends_on("llvm+clang", type="build", when="+mpi")

    # The manifest of the program; that of the workspace names no package.
    build_directory = "crates/cli"

    @property
    def build_args(self):
        args = ["--locked"]
        if self.spec.satisfies("+system_hdf5"):
            args += ["--no-default-features", "--features", "system-hdf5"]
        if self.spec.satisfies("+mpi"):
            args += ["--features", "mpi"]
        return args

    def setup_build_environment(self, env: EnvironmentModifications) -> None:
        # The folder that Spack makes in the source, `out`, is no change of it: `plateau --version` tells of changes.
        env.set("GIT_CONFIG_COUNT", "1")
        env.set("GIT_CONFIG_KEY_0", "status.showUntrackedFiles")
        env.set("GIT_CONFIG_VALUE_0", "no")
        if self.spec.satisfies("+system_hdf5"):
            env.set("HDF5_DIR", self.spec["hdf5"].prefix)
        if self.spec.satisfies("+mpi"):
            env.set("MPICC", self.spec["mpi"].mpicc)
            env.set("LIBCLANG_PATH", self.spec["llvm"].prefix.lib)

    def check(self):
        """The tests of the workspace are for its developers."""

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def check_install(self):
        Executable(self.prefix.bin.plateau)("--version")
