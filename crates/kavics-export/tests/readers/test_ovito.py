"""OVITO reads every format as it stands in the tables."""

import unittest

import numpy as np
from ovito.io import import_file
from ovito.modifiers import LoadTrajectoryModifier

import runs

SCENES = ["block-32", "polygon", "dropped-1000"]


class Ovito(unittest.TestCase):
    def assert_text(self, found, expected):
        # OVITO reads decimals to within a unit in the last place.
        np.testing.assert_allclose(found, expected, rtol=2e-15, atol=1e-300)

    def check_grains(self, scene, step, data, first_id):
        table = runs.table(scene, "grains", step).to_pandas()
        particles = data.particles
        self.assertEqual(particles.count, len(table))
        self.assert_text(particles.positions[:, 0], table["x"] + table["ux"])
        self.assert_text(particles.positions[:, 1], table["y"] + table["uy"])
        np.testing.assert_allclose(particles["Radius"], table["radius"], rtol=1e-7)
        np.testing.assert_array_equal(particles.identifiers, table["grain"] + first_id)
        for column in ["ux", "uy", "cell_area", "stress_yy"]:
            self.assert_text(particles[column], table[column])
        np.testing.assert_array_equal(particles["contacts"], table["contacts"])

    def frames(self, path, scene):
        pipeline = import_file(str(path))
        steps = runs.steps(scene)
        self.assertEqual(pipeline.source.num_frames, len(steps))
        return pipeline, list(enumerate(steps))

    def test_vtp_grains(self):
        for scene in SCENES:
            path = runs.exported(scene, "vtp") / "grains" / "*.vtp"
            pipeline, frames = self.frames(path, scene)
            for frame, step in frames:
                data = pipeline.compute(frame)
                table = runs.table(scene, "grains", step).to_pandas()
                self.assertEqual(data.particles.count, len(table))
                expected = table["x"] + table["ux"]
                np.testing.assert_array_equal(data.particles.positions[:, 0], expected)
                np.testing.assert_allclose(data.particles["Radius"], table["radius"], rtol=1e-7)
                np.testing.assert_array_equal(data.particles["stress_yy"], table["stress_yy"])

    def test_extended_xyz(self):
        for scene in SCENES:
            path = runs.exported(scene, "extxyz") / "grains.extxyz"
            pipeline, frames = self.frames(path, scene)
            for frame, step in frames:
                data = pipeline.compute(frame)
                self.check_grains(scene, step, data, 0)
                self.assertEqual(data.attributes["step"], step)
                factor = data.attributes["load_factor"]
                self.assertAlmostEqual(factor, runs.load_factor(scene, step), 12)

    def test_lammps_dump_with_bonds(self):
        for scene in SCENES:
            folder = runs.exported(scene, "lammps")
            pipeline, frames = self.frames(folder / "grains.dump", scene)
            bonds = LoadTrajectoryModifier()
            head = (folder / "bonds.dump").read_text().splitlines()[8]
            names = head.split()[2:]
            kept = ["normal_force", "contact"]
            columns = [name if name in kept else None for name in names]
            columns[:2] = ["Particle Identifiers.1", "Particle Identifiers.2"]
            bonds.source.load(str(folder / "bonds.dump"), columns=columns)
            pipeline.modifiers.append(bonds)
            for frame, step in frames:
                data = pipeline.compute(frame)
                self.assertEqual(data.attributes["Timestep"], step)
                self.check_grains(scene, step, data, 1)
                self.check_bonds(scene, step, data.particles.bonds)

    def check_bonds(self, scene, step, bonds):
        table = runs.table(scene, "contacts", step).to_pandas()
        active = table[~table["state"].isin(["open", "broken"]) & (table["second"] >= 0)]
        self.assertEqual(bonds.count, len(active))
        np.testing.assert_array_equal(bonds.topology, active[["first", "second"]])
        np.testing.assert_array_equal(bonds["contact"], active["contact"])
        self.assert_text(bonds["normal_force"], active["normal_force"])
