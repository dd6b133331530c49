"""Runs of scenes and their exports, made once for all tests."""

import atexit
import functools
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import pyarrow.parquet

ROOT = pathlib.Path(__file__).resolve().parents[4]
SCENES = ["block-32", "polygon", "dropped-1000", "stability"]
# Its load falls to nothing where the last fibre breaks.
STATUS = {"fibre-bundle": 3}

_room = tempfile.TemporaryDirectory()
atexit.register(_room.cleanup)
PLACE = pathlib.Path(_room.name)


def command(*arguments):
    return [os.environ["KAVICS_BINARY"], *map(str, arguments)]


def kavics(*arguments, status=0):
    done = subprocess.run(command(*arguments), cwd=PLACE, capture_output=True, text=True)
    if done.returncode != status:
        raise RuntimeError(f"{done.args}: status {done.returncode}\n{done.stderr}")


@functools.cache
def results(scene):
    """The results folder of a scene."""
    folder = PLACE / f"{scene}.results"
    kavics("run", ROOT / "scenes" / f"{scene}.toml", "-o", folder, status=STATUS.get(scene, 0))
    return folder


def stopped(scene, name):
    """The results folder of a run that is stopped at its first checkpoint."""
    folder = PLACE / f"{name}.results"
    scene = ROOT / "scenes" / f"{scene}.toml"
    run = command("run", scene, "-o", folder, "--checkpoint", 0)
    with subprocess.Popen(run, cwd=PLACE, stderr=subprocess.DEVNULL) as child:
        while child.poll() is None and not list(folder.glob("checkpoint/*.arrow")):
            time.sleep(0.01)
        child.send_signal(signal.SIGTERM)
    if child.returncode != 75:
        raise RuntimeError(f"{child.args}: status {child.returncode}")
    return folder


@functools.cache
def exported(scene, form):
    """The folder of an export."""
    folder = PLACE / f"{scene}-{form}"
    kavics("export", results(scene), "--to", form, "-o", folder)
    return folder


def steps(scene):
    """The recorded load steps."""
    return sorted(int(file.stem) for file in (results(scene) / "grains").iterdir())


def table(scene, name, step):
    """Columns of a recorded table as Arrow has them."""
    return pyarrow.parquet.read_table(results(scene) / name / f"{step:06}.parquet")


def load_factor(scene, step):
    """Load factor of a load step, 0 before loading."""
    rows = pyarrow.parquet.read_table(results(scene) / "steps.parquet")
    factors = dict(zip(rows["step"].to_pylist(), rows["load_factor"].to_pylist()))
    return factors.get(step, 0.0)


def words(folder):
    """What the numbers of words mean: (table, column) to a list."""
    import csv

    found = {}
    with open(folder / "words.csv", newline="") as file:
        for row in csv.DictReader(file):
            found.setdefault((row["table"], row["column"]), []).append(row["word"])
    return found
