# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes as arrays: what remesh() and read() return where there is no VTK."""
import numpy

from ._arrays import as_faces, as_points


#: In field data, where edges and vertices of a CAD file are, see Filters/Files/CadNames.h.
CAD_PLACES = ("CadEdgeEnds", "CadEdgePoints", "CadEdgeCounts", "CadVertexPoints")
#: What info() leaves out: these places, and the exact shape, which are bytes.
CAD_BYTES = ("CadShape", *CAD_PLACES)


def _offsets_of(counts):
    return numpy.concatenate(([0], numpy.cumsum(counts))).astype(numpy.int64)


class Mesh:
    """Points and faces with arrays, in NumPy's own types. It is also the pair of both:

        points, faces = quadrille.remesh((points, faces), quads=500)

    points: n by 3. faces: m by k where all have k corners, else a list of arrays. point_data, cell_data: arrays by
    name, one row a point or face. field_data: lists by name, see info(). offsets and corners: the same faces as one
    array; face i has corners[offsets[i]] to corners[offsets[i + 1] - 1].
    """

    def __init__(self, points, faces, *, point_data=None, cell_data=None, field_data=None):
        self.points = as_points(points)
        counts, self.corners = as_faces(faces, len(self.points))
        self.offsets = _offsets_of(counts)
        self.point_data = dict(point_data or {})
        self.cell_data = dict(cell_data or {})
        self.field_data = dict(field_data or {})

    @classmethod
    def from_cells(cls, points, offsets, corners, *, point_data=None, cell_data=None, field_data=None):
        """The same from offsets and corners, which are not checked; cells may also be lines."""
        mesh = cls.__new__(cls)
        mesh.points, mesh.offsets, mesh.corners = points, offsets, corners
        mesh.point_data = dict(point_data or {})
        mesh.cell_data = dict(cell_data or {})
        mesh.field_data = dict(field_data or {})
        return mesh

    @property
    def faces(self):
        counts = numpy.diff(self.offsets)
        if counts.size == 0:
            return numpy.zeros((0, 4), numpy.int64)
        if (counts == counts[0]).all():
            return self.corners.reshape(-1, counts[0])
        return numpy.split(self.corners, self.offsets[1:-1])

    @property
    def vertices(self):
        """The points, by the name that trimesh has for them."""
        return self.points

    def __iter__(self):
        return iter((self.points, self.faces))

    def __len__(self):
        """2: it is a pair of points and faces."""
        return 2

    def __repr__(self):
        return f"<quadrille.Mesh: {len(self.points)} points, {len(self.offsets) - 1} faces>"

    def with_arrays(self, point_data, cell_data):
        """A mesh that shares all of this one and has further arrays."""
        return Mesh.from_cells(self.points, self.offsets, self.corners,
                               point_data={**self.point_data, **point_data},
                               cell_data={**self.cell_data, **cell_data}, field_data=self.field_data)

    def to_vtk(self):
        """A vtkPolyData of it; needs VTK's modules for Python (python3-vtk9, or pip's vtk)."""
        from ._vtk_data import polydata_of

        return polydata_of(self)


def carried(source, points, weights, cells):
    """Arrays of a mesh at places on it: point data of the three `points` (n by 3) with `weights`, and cell data of
    `cells` (m). Real numbers and colours (three or four uint8) are interpolated, all else comes from the point with
    the largest weight, the first of several."""
    largest = points[numpy.arange(len(points)), weights.argmax(axis=1)]
    point_data = {}
    for name, values in source.point_data.items():
        is_colour = values.dtype == numpy.uint8 and values.ndim == 2 and values.shape[1] in (3, 4)
        if values.dtype.kind != "f" and not is_colour:
            point_data[name] = values[largest]
            continue
        factors = weights.reshape(weights.shape + (1,) * (values.ndim - 1))
        rows = values[points].astype(numpy.float64)
        # A point with weight 0 has no influence, whatever its value is.
        sums = numpy.where(factors == 0, 0.0, factors * rows).sum(axis=1)
        if is_colour:
            sums = numpy.clip(numpy.floor(sums + 0.5), 0, 255)
        point_data[name] = sums.astype(values.dtype)
    return point_data, {name: values[cells] for name, values in source.cell_data.items()}
