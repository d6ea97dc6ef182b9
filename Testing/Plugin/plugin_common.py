# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the plugin share."""
import os

PLUGIN = os.environ["QUADRILLE_PLUGIN"]
DATA = os.environ["QUADRILLE_DATA"]
ARTIFACTS = os.environ["QUADRILLE_ARTIFACTS"]
FILTERS = ("QuadRemesh", "DecimationHierarchy", "IntegerGridMap", "IntegerGridMapUpmap", "QuadExtraction",
           "QuadElements")
if os.environ.get("QUADRILLE_USE_CGAL") == "ON":
    FILTERS += ("SurfaceRepair", "SurfaceWrap", "QuadProjection")


def surface(simple, **options):
    """A torus, triangulated: closed, genus 1, 4,608 triangles."""
    torus = simple.Superquadric(Toroidal=1, ThetaResolution=64, PhiResolution=36, PhiRoundness=1, ThetaRoundness=1,
                                Thickness=0.4, **options)
    return simple.Triangulate(Input=simple.Clean(Input=torus))


def check(condition, text):
    if not condition:
        raise SystemExit("FAILED: " + text)


def size_of(proxy, port=0):
    return proxy.GetDataInformation(port).GetNumberOfCells()


def number(proxy, name):
    proxy.UpdatePropertyInformation()
    return proxy.GetPropertyValue(name)
