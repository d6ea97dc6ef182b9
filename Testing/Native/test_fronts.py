# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The same surface with the same options has the same quads, to the byte, by the library for C++, by Python without VTK
and by the filter of VTK: twelve surfaces, four of more than a million triangles, two with a symmetry.

  test_fronts.py FRONTS DATA    FRONTS: the program of fronts.cxx, which asks the library and the filter
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

import quadrille

FRONTS, DATA = sys.argv[1], pathlib.Path(sys.argv[2])


class Surface:
    """Points and triangles, and arrays by the names of the arguments of remesh()."""

    def __init__(self, name, times=0):
        mesh = quadrille.read(str(DATA / (name + ".ply")))
        self.points, self.triangles = numpy.asarray(mesh.points), numpy.asarray(mesh.faces).reshape(-1, 3)
        self.patches = mesh.cell_data.get("PatchId", numpy.zeros(len(self.triangles))).astype(numpy.int64)
        self.arrays = {}
        for _ in range(times):
            self._subdivide()

    def _subdivide(self):
        """Each triangle becomes four, flat ones of the same surface."""
        pairs = numpy.sort(numpy.stack([self.triangles, numpy.roll(self.triangles, -1, axis=1)], axis=2), axis=2)
        keys = pairs[:, :, 0].astype(numpy.int64) * len(self.points) + pairs[:, :, 1]
        edges, middle = numpy.unique(keys, return_inverse=True)
        middle = middle.reshape(-1, 3) + len(self.points)
        a, b = numpy.divmod(edges, len(self.points))
        points = numpy.concatenate([self.points, (self.points[a] + self.points[b]) / 2])
        corner = self.triangles
        self.triangles = numpy.stack([
            numpy.stack([corner[:, i], middle[:, i], middle[:, i - 1]], axis=1) for i in range(3)] + [middle],
            axis=1).reshape(-1, 3)
        self.points, self.patches = points, numpy.repeat(self.patches, 4)

    def centres(self):
        return self.points[self.triangles].mean(axis=1)

    def by_patches(self):
        self.arrays["patch_ids"] = self.patches
        return self

    def guided(self):
        """Round the x axis where x is above its mean."""
        centre = self.centres() - self.points.mean(axis=0)
        around = numpy.cross([1.0, 0, 0], centre)
        around[centre[:, 0] < 0] = 0
        self.arrays["guiding_direction"] = around
        return self

    def sized(self):
        """Half as long at one end as at the other."""
        x = self.points[:, 0]
        self.arrays["sizing"] = (0.5 + 0.5 * (x - x.min()) / (x.max() - x.min())).astype(numpy.float32)
        return self

    def with_features(self):
        """The edges between two patches."""
        key = numpy.sort(numpy.stack([self.triangles, numpy.roll(self.triangles, -1, axis=1)], axis=2), axis=2)
        key = key[:, :, 0].astype(numpy.int64) * len(self.points) + key[:, :, 1]
        order = numpy.argsort(key, axis=None, kind="stable")
        flat, side = key.ravel()[order], numpy.repeat(self.patches, 3)[order]
        crosses = numpy.zeros(len(flat), bool)
        same = flat[:-1] == flat[1:]
        crosses[:-1] |= same & (side[:-1] != side[1:])
        crosses[1:] |= same & (side[:-1] != side[1:])
        bits = numpy.zeros(len(flat), numpy.uint8)
        bits[order] = crosses
        self.arrays["feature_edges"] = (bits.reshape(-1, 3) * [1, 2, 4]).sum(axis=1).astype(numpy.uint8)
        return self


#: A name, the surface, options of remesh().
INPUTS = (
    ("beast", lambda: Surface("beast"), {"quads": 800}),
    ("part", lambda: Surface("part"), {"quads": 1500}),
    ("frame by length", lambda: Surface("frame"), {"edge_length": 0.08, "feature_angle": None}),
    ("part with patches", lambda: Surface("part").by_patches(), {"quads": 1500, "feature_angle": 60.0}),
    ("beast guided", lambda: Surface("beast").guided(), {"quads": 800}),
    ("part with features and sizes", lambda: Surface("part").with_features().sized(), {"quads": 1500}),
    ("mirrored", lambda: Surface("frame"), {"quads": 800, "symmetry": "found"}),
    ("turned", lambda: Surface("frame"), {"quads": 900, "rotation": 3}),
    ("fine beast", lambda: Surface("beast", 3), {"quads": 800}),
    ("fine part with patches", lambda: Surface("part", 3).by_patches(), {"quads": 1500}),
    ("fine beast with sizes, by length", lambda: Surface("beast", 3).sized(), {"edge_length": 0.12}),
    ("fine part with features and sizes", lambda: Surface("part", 3).with_features().sized(), {"quads": 1500}),
)

#: The arrays of fronts.cxx.
TYPES = {"feature_edges": numpy.uint8, "patch_ids": numpy.int64, "guiding_direction": numpy.float64,
         "sizing": numpy.float32}


class Fronts(unittest.TestCase):
    def made_by_program(self, surface, options):
        symmetry = options.get("rotation", 1 if "symmetry" in options else 0)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            surface.points.astype(numpy.float64).tofile(folder / "points")
            surface.triangles.astype(numpy.uint32).tofile(folder / "triangles")
            for array, values in surface.arrays.items():
                values.astype(TYPES[array]).tofile(folder / array)
            angle = options.get("feature_angle", 40.0) or 0
            subprocess.run([FRONTS, name, str(options.get("quads", 0)), repr(options.get("edge_length", 0.0)),
                            repr(angle), str(symmetry)], check=True)
            return {front: ((folder / (front + ".points")).read_bytes(), (folder / (front + ".quads")).read_bytes())
                    for front in (("library", "filter") if symmetry == 0 else ("filter",))}

    def test_the_same_bytes(self):
        fine = symmetric = 0
        for name, surface_of, options in INPUTS:
            with self.subTest(name):
                surface = surface_of()
                fine += len(surface.triangles) > 1000000
                symmetric += "symmetry" in options or "rotation" in options
                made = quadrille.remesh((surface.points, surface.triangles), **options, **surface.arrays)
                points, quads = (numpy.ascontiguousarray(a) for a in quadrille.to_arrays(made))
                self.assertGreater(len(quads), 200)
                thinned = "thinned out to" in str(quadrille.info(made)["Notices"])
                self.assertEqual(thinned, len(surface.triangles) > 1000000)
                ours = (points.astype(numpy.float64).tobytes(), quads.astype(numpy.uint32).tobytes())
                for front, theirs in self.made_by_program(surface, options).items():
                    self.assertTrue(ours == theirs, f"the {front} has other quads than Python")
        self.assertEqual((len(INPUTS), fine, symmetric), (12, 4, 2))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
