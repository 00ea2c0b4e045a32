"""What somebody does who has just installed the wheel: a scene, its run, a figure, all in the present folder."""

import pathlib
import shutil
import subprocess
import sys
import sysconfig

import plateau

program = plateau.find_program()
# It is the one of the wheel, in this environment.
assert pathlib.Path(program).parent == pathlib.Path(sysconfig.get_path("scripts")), program
assert sys.prefix in plateau.__file__, plateau.__file__
assert plateau.__version__ == subprocess.check_output([program, "--version"], text=True).split()[1]
assert shutil.which("cargo") is None and shutil.which("rustc") is None
assert plateau.check("quick.toml", set={"output.file": "checked.h5"})["steps"] == 29325

made = plateau.run("quick.toml", "quick.h5", workers=2, force=True)
run = plateau.open_run("quick.h5")
area = run.plateau.mean("contact_area")
assert area.value == made.attrs["summary"]["contact_area_last_tenth"]["mean"] > area.error > 0
assert run["disc/height"].plateau.area_mean().shape == (2,)
run["disc/height"].plateau.plot().figure.savefig("disc.png")
assert pathlib.Path("disc.png").stat().st_size > 10000
print(f"contact area {area.value * 1e6:.3f} ± {area.error * 1e6:.3f} mm2")
