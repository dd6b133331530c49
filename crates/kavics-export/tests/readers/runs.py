"""Runs of scenes and their exports, made once for all tests."""

import atexit
import functools
import os
import pathlib
import subprocess
import tempfile

import pyarrow.parquet

ROOT = pathlib.Path(__file__).resolve().parents[4]
SCENES = ["block-32", "polygon", "dropped-1000", "stability"]

_room = tempfile.TemporaryDirectory()
atexit.register(_room.cleanup)
PLACE = pathlib.Path(_room.name)


def kavics(*arguments):
    command = [os.environ["KAVICS_BINARY"], *map(str, arguments)]
    subprocess.run(command, cwd=PLACE, check=True, capture_output=True, text=True)


@functools.cache
def results(scene):
    """The results folder of a scene."""
    folder = PLACE / f"{scene}.results"
    kavics("run", ROOT / "scenes" / f"{scene}.toml", "-o", folder)
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
