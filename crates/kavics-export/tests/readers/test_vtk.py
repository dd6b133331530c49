"""VTK reads grains and contacts as they stand in the tables."""

import unittest
import xml.etree.ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import runs


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


class Vtk(unittest.TestCase):
    def check_columns(self, scene, name, step, attributes):
        table = runs.table(scene, name, step)
        words = runs.words(runs.exported(scene, "vtp"))
        for column in table.column_names:
            found = vtk_to_numpy(attributes.GetArray(column))
            expected = table[column].to_pylist()
            if (name, column) in words:
                found = [words[name, column][number] for number in found]
                self.assertEqual(found, expected, column)
            else:
                np.testing.assert_array_equal(found, expected, column)

    def test_grains_have_their_displaced_places_and_all_columns(self):
        for scene in ["block-32", "polygon", "dropped-1000"]:
            for step in runs.steps(scene):
                data = read(runs.exported(scene, "vtp") / "grains" / f"{step:06}.vtp")
                table = runs.table(scene, "grains", step).to_pandas()
                points = vtk_to_numpy(data.GetPoints().GetData())
                np.testing.assert_array_equal(points[:, 0], table["x"] + table["ux"])
                np.testing.assert_array_equal(points[:, 1], table["y"] + table["uy"])
                self.assertTrue((points[:, 2] == 0).all())
                self.check_columns(scene, "grains", step, data.GetPointData())
                moved = vtk_to_numpy(data.GetPointData().GetArray("displacement"))
                np.testing.assert_array_equal(moved[:, 1], table["uy"])
                fields = data.GetFieldData()
                self.assertEqual(fields.GetArray("step").GetValue(0), step)
                factor = fields.GetArray("load_factor").GetValue(0)
                self.assertEqual(factor, runs.load_factor(scene, step))

    def test_contacts_are_lines_between_their_partners(self):
        for scene in ["block-32", "polygon", "dropped-1000"]:
            step = runs.steps(scene)[-1]
            data = read(runs.exported(scene, "vtp") / "contacts" / f"{step:06}.vtp")
            table = runs.table(scene, "contacts", step).to_pandas()
            self.assertEqual(data.GetNumberOfLines(), len(table))
            self.check_columns(scene, "contacts", step, data.GetCellData())
            ends = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)
            grain = vtk_to_numpy(data.GetPointData().GetArray("grain"))
            np.testing.assert_array_equal(grain[ends[:, 0]], table["first"])
            # At a side the line ends in a point that is no grain.
            np.testing.assert_array_equal(grain[ends[:, 1]], table["second"].clip(lower=-1))
            points = vtk_to_numpy(data.GetPoints().GetData())
            along = points[ends[:, 1]] - points[ends[:, 0]]
            opened = table["opening"].abs() + table["shear"].abs() + 1e-9
            # Partners turn, so that openings are met to second order.
            lengths = np.abs(np.hypot(along[:, 0], along[:, 1]) - table["branch_length"])
            self.assertTrue((lengths < 0.5 + opened).all())

    def test_a_series_names_a_file_for_each_load_step(self):
        folder = runs.exported("dropped-1000", "vtp")
        for name in ["grains", "contacts"]:
            series = xml.etree.ElementTree.parse(folder / f"{name}.pvd").iter("DataSet")
            files = {float(entry.get("timestep")): entry.get("file") for entry in series}
            self.assertEqual(sorted(files), runs.steps("dropped-1000"))
            self.assertTrue(all((folder / file).is_file() for file in files.values()))
