"""What somebody does who has just installed the wheel: a scene, its run, a figure, a study of eight runs, all in the present folder."""

import pathlib
import shutil
import subprocess
import sys
import sysconfig
import time

start = time.monotonic()
import plateau  # noqa: E402

imported = time.monotonic()

program = plateau.find_program()
# It is the one of the wheel, in this environment.
assert pathlib.Path(program).parent == pathlib.Path(sysconfig.get_path("scripts")), program
assert sys.prefix in plateau.__file__, plateau.__file__
assert plateau.__version__ == subprocess.check_output([program, "--version"], text=True).split()[1]
assert shutil.which("cargo") is None and shutil.which("rustc") is None
assert plateau.check("quick.toml", set={"output.file": "checked.h5"})["steps"] == 29325

simulation = plateau.Simulation("quick.toml", workers=2)
assert sys.prefix in sys.modules["plateau._native"].__file__
simulation.advance(690)
assert simulation.pin_height.shape == (40, 20) and simulation.sample()["contact_area"] > 0

begun = time.monotonic()
made = plateau.run("quick.toml", "quick.h5", workers=2, force=True)
ran = time.monotonic()
run = plateau.open_run("quick.h5")
area = run.plateau.mean("contact_area")
assert area.value == made.attrs["summary"]["contact_area_last_tenth"]["mean"] > area.error > 0
assert run["disc/height"].plateau.area_mean().shape == (2,)
run["disc/height"].plateau.plot().figure.savefig("disc.png")
assert pathlib.Path("disc.png").stat().st_size > 10000
drawn = time.monotonic()

pathlib.Path("study.toml").write_text("""version = 1
title = "Load, speed and fibres"
base = "quick.toml"
set = ["operation.duration = '20 s'", "output.sample_every = '1 s'"]
design = "full-factorial"
directory = "study"
[[factor]]
name = "load"
key = "operation.normal_force"
levels = ["5 N", "10 N"]
[[factor]]
name = "speed"
key = "operation.rotational_speed"
levels = ["400 rpm", "800 rpm"]
[[factor]]
name = "fibres"
key = "pin.base.synthetic.fibre_fraction"
levels = [0.2, 0.4]
[[response]]
name = "worn"
dataset = "/series/worn_pin"
at = "end"
""")
study = plateau.sweep("study.toml")
assert len(study.table) == 8 and (study.table["state"] == "finished").all()
# Archard: wear goes with load and distance, so twice as much of each gives twice as much.
worn = study.table.groupby(["load [N]", "fibres"])["worn [m3]"].sum()
assert abs(worn[10.0, 0.2] / worn[5.0, 0.2] - 2) < 0.2, worn
found = plateau.study.effects("study.toml").table.set_index(["response", "term"])
assert found.loc[("worn", "load"), "effect"] > 0
# The program finds the word beside it.
subprocess.run([program, "sweep", "effects", "study.toml", "-q"], check=True, stdout=subprocess.DEVNULL)
assert any(pathlib.Path("study/effects").glob("*.png"))
ended = time.monotonic()
seconds = {"import": imported - start, "run": ran - begun, "open and draw": drawn - ran, "study of 8 runs with figures": ended - drawn}
print("; ".join(f"{what} {time:.1f} s" for what, time in seconds.items()))
print(f"contact area {area.value * 1e6:.3f} ± {area.error * 1e6:.3f} mm2")
