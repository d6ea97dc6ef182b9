# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces as users of ParaView have them: by its own sources and filters, with their defaults where nothing is said.

All are the same on each run.
"""
import math


def field(simple, extent, function):
    """A volume with a point array F, over [-1, 1] in each direction with 2 extent + 1 points."""
    grid = simple.Wavelet(WholeExtent=[-extent, extent] * 3)
    where = {c: f"(coords{c}/{extent})" for c in "XYZ"}
    for c, text in where.items():
        function = function.replace(c.lower(), text)
    return simple.Calculator(Input=grid, ResultArrayName="F", Function=function)


def contour(simple, source, value, array="F", **options):
    return simple.Contour(Input=source, ContourBy=["POINTS", array], Isosurfaces=[value], **options)


def wavelet(simple, extent=10):
    return simple.Wavelet(WholeExtent=[-extent, extent] * 3)


def waveletContour(simple, extent, value):
    return contour(simple, wavelet(simple, extent), value, "RTData")


def extracted(simple, source):
    return simple.ExtractSurface(Input=source)


def plane(simple, proxy, origin, normal):
    proxy.Origin = origin
    proxy.Normal = normal


def clipped(simple, source, normal=(1, 0.3, 0.2)):
    """With Crinkle Clip off: cut through the cells."""
    clip = simple.Clip(Input=source, ClipType="Plane", Scalars=["POINTS", ""])
    plane(simple, clip.ClipType, [0, 0, 0], normal)
    return clip


def clippedBySphere(simple, source, radius):
    clip = simple.Clip(Input=source, ClipType="Sphere", Scalars=["POINTS", ""])
    clip.ClipType.Center = [0, 0, 0]
    clip.ClipType.Radius = radius
    return clip


def sliced(simple, source, kind):
    section = simple.Slice(Input=source, SliceType=kind)
    if kind == "Plane":
        plane(simple, section.SliceType, [0, 0, 0], [1, 0.2, 0.1])
    else:
        section.SliceType.Center = [0, 0, 0]
        section.SliceType.Radius = 8
    return section


def threshold(simple, source, low, high):
    return simple.Threshold(Input=source, Scalars=["POINTS", "RTData"], LowerThreshold=low, UpperThreshold=high,
                            ThresholdMethod="Between")


def noisy(simple, extent, amount):
    """A ball whose field has noise from voxel to voxel: islands and pits by the dozen."""
    ball = field(simple, extent, "x*x+y*y+z*z")
    script = f"""
import numpy
values = inputs[0].PointData["F"]
noise = numpy.random.RandomState(7).uniform(-{amount}, {amount}, values.shape[0])
output.PointData.append(values + noise, "N")
"""
    return contour(simple, simple.ProgrammableFilter(Input=ball, Script=script), 0.5, "N")


def perlin(simple, extent):
    """Perlin noise as ParaView has it in Python only: vtkPerlinNoise, sampled."""
    script = f"""
from vtkmodules.vtkCommonDataModel import vtkPerlinNoise
from vtkmodules.vtkImagingHybrid import vtkSampleFunction
noise = vtkPerlinNoise()
noise.SetFrequency(1.1, 1.25, 1.5)
sample = vtkSampleFunction()
sample.SetImplicitFunction(noise)
sample.SetModelBounds(-1, 1, -1, 1, -1, 1)
sample.SetSampleDimensions({2 * extent + 1}, {2 * extent + 1}, {2 * extent + 1})
sample.ComputeNormalsOff()
sample.SetScalarArrayName("F")
sample.Update()
output.ShallowCopy(sample.GetOutput())
"""
    extents = f"""
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Set(executive.WHOLE_EXTENT(), 0, {2 * extent}, 0, {2 * extent}, 0, {2 * extent})
"""
    return simple.ProgrammableSource(OutputDataSetType="vtkImageData", Script=script, ScriptRequestInformation=extents)


def byClass(simple, module, name, **settings):
    """A source that VTK has and ParaView's menu has not."""
    lines = [f"from vtkmodules.{module} import {name}", f"source = {name}()"]
    lines += [f"source.Set{key}({value})" for key, value in settings.items()]
    lines += ["source.Update()", "output.ShallowCopy(source.GetOutput())"]
    return simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script="\n".join(lines))


def parametric(simple, name):
    """As the closed ones come with pairs of points that nearly coincide, they need Clean with a tolerance."""
    script = f"""
from vtkmodules.vtkCommonComputationalGeometry import {name}
from vtkmodules.vtkFiltersSources import vtkParametricFunctionSource
shape = {name}()
source = vtkParametricFunctionSource()
source.SetParametricFunction(shape)
source.SetUResolution(48)
source.SetVResolution(32)
source.Update()
output.ShallowCopy(source.GetOutput())
"""
    return simple.Clean(Input=simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script=script), Tolerance=1e-6)


def tube(simple, sides):
    points = []
    for i in range(25):
        t = 4 * math.pi * i / 24
        points += [math.cos(t), math.sin(t), 0.15 * t]
    return simple.Tube(Input=simple.PolyLineSource(Points=points), Radius=0.15, NumberofSides=sides,
                       Scalars=["POINTS", ""],
                       Vectors=["POINTS", ""])


def cloud(simple, script):
    return simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script="""
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.vtkCommonCore import vtkPoints
random = numpy.random.RandomState(3)
""" + script + """
points = vtkPoints()
points.SetData(dataset_adapter.numpyTovtkDataArray(where))
output.SetPoints(points)
""")


def warped(simple, resolution, scale):
    flat = simple.Plane(XResolution=resolution, YResolution=resolution)
    heights = simple.Calculator(Input=flat, ResultArrayName="H", Function="sin(9*coordsX)*cos(7*coordsY)")
    return simple.WarpByScalar(Input=heights, Scalars=["POINTS", "H"], ScaleFactor=scale)


def assembly(simple):
    parts = [simple.Sphere(), simple.Cone(Center=[2, 0, 0]), simple.Box(Center=[4, 0, 0]),
             simple.Cylinder(Center=[6, 0, 0], Resolution=24)]
    return simple.AppendGeometry(Input=parts)


def glyphs(simple):
    """Spheres of six by six on the points of a coarse grid."""
    return simple.Glyph(Input=wavelet(simple, 2), GlyphType="Sphere", ScaleFactor=0.8, GlyphMode="All Points",
                        ScaleArray=["POINTS", "No scale array"], OrientationArray=["POINTS", "No orientation array"])


def turned(simple):
    profile = simple.PolyLineSource(Points=[0.5, 0, -1, 1.0, 0, -0.5, 0.6, 0, 0, 0.9, 0, 0.6, 0.4, 0, 1])
    return simple.RotationalExtrusion(Input=profile, Resolution=32, Capping=0)


def ellipsoid(simple):
    proxy = simple.Transform(Input=simple.Sphere(ThetaResolution=32, PhiResolution=32))
    proxy.Transform.Scale = [1.0, 2.0, 0.5]
    return proxy


def contours(simple):
    """Isosurfaces, at several resolutions: what ParaView is used for most."""
    result = {}
    for extent in (5, 10, 20):
        for value in (80, 120, 157.09, 200, 240):
            result[f"wavelet_{extent}_{value:g}"] = lambda e=extent, v=value: waveletContour(simple, e, v)
    tangle = "(2.5*x)^4-5*(2.5*x)^2+(2.5*y)^4-5*(2.5*y)^2+(2.5*z)^4-5*(2.5*z)^2"
    gyroid = "sin(6*x)*cos(6*y)+sin(6*y)*cos(6*z)+sin(6*z)*cos(6*x)"
    for extent in (10, 20):
        result[f"tangle_{extent}"] = lambda e=extent: contour(simple, field(simple, e, tangle), -11.8)
        result[f"gyroid_{extent}"] = lambda e=extent: contour(simple, field(simple, e, gyroid), 0.0)
        result[f"perlin_{extent}"] = lambda e=extent: contour(simple, perlin(simple, e), 0.05)
    result["quadric"] = lambda: contour(simple, field(simple, 10, "0.5*x*x+y*y-0.7*z*z+0.2*x*y"), 0.15)
    result["two_values"] = lambda: simple.Contour(Input=wavelet(simple), ContourBy=["POINTS", "RTData"],
                                                  Isosurfaces=[110, 190])
    result["noisy_ball"] = lambda: noisy(simple, 12, 0.12)
    result["noisier_ball"] = lambda: noisy(simple, 10, 0.3)
    result["mandelbrot"] = lambda: contour(simple, simple.Mandelbrot(WholeExtent=[0, 24] * 3), 40, "Iterations")
    return result


def cuts(simple):
    """Clips, slices and surfaces of volume meshes, and of the isosurfaces."""
    iso = lambda e=10, v=157.09: waveletContour(simple, e, v)
    return {
        "clip_volume": lambda: extracted(simple, clipped(simple, wavelet(simple))),
        "clip_volume_sphere": lambda: extracted(simple, clippedBySphere(simple, wavelet(simple), 8)),
        "clip_contour": lambda: extracted(simple, clipped(simple, iso())),
        "clip_closed": lambda: simple.ClipClosedSurface(Input=simple.Sphere(ThetaResolution=24, PhiResolution=24)),
        "slice_plane": lambda: sliced(simple, wavelet(simple), "Plane"),
        "slice_sphere": lambda: sliced(simple, wavelet(simple), "Sphere"),
        "tetrahedra": lambda: extracted(simple, simple.Tetrahedralize(Input=wavelet(simple))),
        "tetrahedra_clip": lambda: extracted(simple, simple.Tetrahedralize(Input=clipped(simple, wavelet(simple)))),
        "tetrahedra_contour": lambda: contour(simple, simple.Tetrahedralize(Input=wavelet(simple)), 157.09, "RTData"),
        "threshold": lambda: extracted(simple, threshold(simple, wavelet(simple), 160, 300)),
        "threshold_fine": lambda: extracted(simple, threshold(simple, wavelet(simple, 16), 130, 300)),
        "iso_volume": lambda: extracted(simple, simple.IsoVolume(
            Input=wavelet(simple), InputScalars=["POINTS", "RTData"], ThresholdRange=[120, 180])),
        "smooth": lambda: simple.Smooth(Input=iso(10, 120), NumberofIterations=30),
        "decimate": lambda: simple.Decimate(Input=iso(20, 157.09), TargetReduction=0.9),
        "clustering": lambda: simple.QuadricClustering(Input=iso(20, 157.09)),
        "loop": lambda: simple.Subdivide(Input=iso(5, 157.09)),
        "reflect": lambda: extracted(simple, simple.Reflect(Input=iso(5, 200))),
        "delaunay_3d": lambda: extracted(simple, simple.Delaunay3D(Input=cloud(
            simple, "where = random.normal(size=(300, 3))"))),
    }


def shapes(simple):
    """Sources and what is made of them."""
    text = lambda: simple.a3DText(Text="Qu8")
    fine = dict(ThetaResolution=32, PhiResolution=32)
    result = {
        "sphere": lambda: simple.Sphere(),
        "sphere_fine": lambda: simple.Sphere(**fine),
        "sphere_part": lambda: simple.Sphere(EndTheta=250, StartPhi=30, **fine),
        "ellipsoid": lambda: ellipsoid(simple),
        "superquadric": lambda: simple.Superquadric(),
        "superquadric_torus": lambda: simple.Superquadric(Toroidal=1, PhiRoundness=1, ThetaRoundness=1),
        "superquadric_box": lambda: simple.Superquadric(PhiRoundness=0.3, ThetaRoundness=0.3, Toroidal=0,
                                                        ThetaResolution=32, PhiResolution=32),
        "torus": lambda: parametric(simple, "vtkParametricTorus"),
        "text": text,
        "text_solid": lambda: simple.LinearExtrusion(Input=text(), Vector=[0, 0, 0.4]),
        "cylinder": lambda: simple.Cylinder(),
        "cylinder_fine": lambda: simple.Cylinder(Resolution=32),
        "cone": lambda: simple.Cone(),
        "cone_fine": lambda: simple.Cone(Resolution=32),
        "box": lambda: simple.Box(),
        "disk": lambda: simple.Disk(),
        "disk_fine": lambda: simple.Disk(RadialResolution=8, CircumferentialResolution=32),
        "plane": lambda: simple.Plane(),
        "arrow": lambda: simple.Arrow(),
        "arrow_fine": lambda: simple.Arrow(TipResolution=32, ShaftResolution=32),
        "tube": lambda: tube(simple, 6),
        "tube_fine": lambda: tube(simple, 20),
        "extruded_polygon": lambda: simple.LinearExtrusion(
            Input=byClass(simple, "vtkFiltersSources", "vtkRegularPolygonSource", NumberOfSides=5), Vector=[0, 0, 1]),
        "turned_profile": lambda: turned(simple),
        "delaunay_2d": lambda: simple.Delaunay2D(Input=cloud(
            simple, "where = numpy.hstack([random.uniform(size=(400, 2)), numpy.zeros((400, 1))])")),
        "warp": lambda: warped(simple, 40, 0.1),
        "warp_steep": lambda: warped(simple, 20, 0.6),
        "assembly": lambda: assembly(simple),
        "glyphs": lambda: glyphs(simple),
    }
    for kind, name in enumerate(("tetrahedron", "cube", "octahedron", "icosahedron", "dodecahedron")):
        result[name] = lambda k=kind: byClass(simple, "vtkFiltersSources", "vtkPlatonicSolidSource", SolidType=k)
    return result


def surfaces(simple):
    """Three groups of names with functions that make the proxies."""
    return {"contours": contours(simple), "cuts": cuts(simple), "shapes": shapes(simple)}
