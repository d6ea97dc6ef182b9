# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Maps of one surface against each other: without decimation, by each cost of it and with each budget."""
import dataclasses
import time

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import quadrille

from . import guided

#: Costs of phase 2, in the order of the paper's figures: its names, and what the filter calls them.
COSTS = (("E_G,mem", "COST_GAUSSIAN_MEMORY"), ("E_G", "COST_GAUSSIAN"), ("E_QEM", "COST_QUADRIC"),
         ("E_uni", "COST_UNIFORM"))
BUDGET = 1000
MEASURES = ("Sizing", "Anisotropy", "Shear")
#: Points of a level that a map is still made on; the filter refuses larger ones.
LARGEST = 100000
#: A budget that no surface reaches: phase 2 has nothing to do.
ALL = 2 ** 31 - 1


@dataclasses.dataclass
class Outcome:
    """One map, carried to the surface. seconds: of the stages, by name. distance: from the reference, by measure; that
    of the irregular vertices in quarter turns times edge lengths. histograms: (middles of the bins, percent) by
    measure. guides: degrees between guides and isolines, None without guides. error: empty, or why there is no map;
    then all else is empty."""
    name: str
    budget: int = 0
    vertices: int = 0  # of the level that the map was made on
    triangles: int = 0
    seconds: dict = dataclasses.field(default_factory=dict)
    valences: dict = dataclasses.field(default_factory=dict)
    means: dict = dataclasses.field(default_factory=dict)
    medians: dict = dataclasses.field(default_factory=dict)
    distance: dict = dataclasses.field(default_factory=dict)
    histograms: dict = dataclasses.field(default_factory=dict)
    inverted: int = 0
    guides: float = None
    certificate: str = ""
    valid: bool = False
    error: str = ""

    @property
    def extreme(self):
        """Irregular vertices of other valences than 3 and 5."""
        return sum(count for valence, count in self.valences.items() if valence not in (3, 5))


@dataclasses.dataclass
class Study:
    """All maps of one surface. reference: the first of `outcomes`."""
    model: str
    triangles: int
    quads: int
    edge_length: float
    method: str
    reference_note: str  # what the reference is
    outcomes: list

    @property
    def reference(self):
        return self.outcomes[0]


def _stages(run):
    """Seconds by stage of a filter's last execution."""
    data = run.GetOutputDataObject(0).GetFieldData()
    names, seconds = data.GetAbstractArray("StageNames"), data.GetArray("StageSeconds")
    if names is None or seconds is None:
        return {}
    return {names.GetValue(i): seconds.GetTuple1(i) for i in range(names.GetNumberOfValues())}


def _table(table):
    """Columns of a vtkTable by name."""
    columns = {}
    for i in range(table.GetNumberOfColumns()):
        column = table.GetColumn(i)
        columns[column.GetName()] = ([column.GetValue(k) for k in range(column.GetNumberOfValues())]
                                     if column.GetClassName() == "vtkStringArray" else vtk_to_numpy(column).tolist())
    return columns


class _Chain:
    """The three stages up to the map on the surface; levels are remembered from one setting to the next."""

    def __init__(self, surface, quads, method, threads):
        self.hierarchy = quadrille.vtkDecimationHierarchy()
        self.hierarchy.SetInputData(surface)
        self.hierarchy.SetTargetTypeToNumberOfQuads()
        self.hierarchy.SetNumberOfQuads(quads)
        self.grid = quadrille.vtkIntegerGridMap()
        self.grid.SetInputConnection(self.hierarchy.GetOutputPort(0))
        self.grid.SetMethod(quadrille.METHODS.index(method))
        self.upmap = quadrille.vtkIntegerGridMapUpmap()
        self.upmap.SetInputConnection(self.grid.GetOutputPort())
        self.upmap.SetInputDataObject(1, surface)
        self.upmap.SetLogConnection(self.hierarchy.GetOutputPort(2))
        self.upmap.TextureCoordinatesOff()
        for run in (self.hierarchy, self.grid, self.upmap):
            run.SetNumberOfThreads(threads)

    def run(self, cost, budget):
        self.hierarchy.SetDecimationCost(getattr(quadrille.vtkDecimationHierarchy, cost))
        self.hierarchy.SetCoarseVertices(budget)
        quadrille.check(self.upmap)
        return self.upmap.GetOutput()


def _copy(surface):
    result = vtkPolyData()
    result.ShallowCopy(surface)
    return result


def _without_map(mapped):
    """The surface as it was mapped, with its features, and without the map."""
    bare = _copy(mapped)
    for arrays, names in ((bare.GetCellData(), ("IGM", "Matching", "Determinant")),
                          (bare.GetPointData(), ("Turns", "Index", "IntegerVertex"))):
        for name in names:
            arrays.RemoveArray(name)
    return bare


def _certificate(mapped):
    """(text, is valid) of a mapped surface."""
    data = mapped.GetFieldData()
    text, valid = data.GetAbstractArray("Certificate"), data.GetArray("CertificateValid")
    return text.GetValue(0) if text else "", bool(valid and valid.GetTuple1(0))


def _measure(outcome, mapped, reference, edge_length, threads):
    compare = quadrille.vtkIntegerGridMapComparison()
    compare.SetInputData(mapped)
    compare.SetReferenceData(reference)
    compare.SetEdgeLength(edge_length)
    compare.SetNumberOfThreads(threads)
    quadrille.check(compare)
    measures = _table(compare.GetMeasures())
    for name, ours, median, distance in zip(*(measures[key] for key in ("Measure", "Map", "MapMedian", "Distance"))):
        if name in MEASURES:
            outcome.means[name], outcome.medians[name] = ours, median
        if name in MEASURES or name == "Irregular vertices":
            outcome.distance[name] = distance
        if name == "Inverted triangles":
            outcome.inverted = int(ours)
    outcome.valences = {int(valence): int(count)
                        for valence, count in zip(*(_table(compare.GetValences())[key] for key in ("Valence", "Map")))
                        if count}
    bins = _table(compare.GetHistograms())
    outcome.histograms = {name: (bins[name + "Bin"], bins[name + "Map"]) for name in MEASURES}
    outcome.guides = guided.deviation(mapped)
    outcome.certificate, outcome.valid = _certificate(mapped)


def _whole_map(first, edge_length, method, threads, outcome):
    """The map of the surface without decimation."""
    grid = quadrille.vtkIntegerGridMap()
    grid.SetInputData(_without_map(first))
    grid.SetMethod(quadrille.METHODS.index(method))
    grid.SetEdgeLength(edge_length)
    grid.SetNumberOfThreads(threads)
    quadrille.check(grid)
    outcome.vertices, outcome.triangles = first.GetNumberOfPoints(), first.GetNumberOfCells()
    outcome.seconds = _stages(grid)
    return _copy(grid.GetOutput())


def _reference(chain, first, edge_length, method, threads, largest):
    """The map without decimation where the surface has at most `largest` points and it can be made, else that of the
    intermediate level: (mapped surface, outcome, note)."""
    outcome = Outcome("without decimation")
    mapped, note = None, f"map of the intermediate level, as the surface has more than {largest:,} points"
    start = time.perf_counter()
    if first.GetNumberOfPoints() <= largest:
        try:
            mapped = _whole_map(first, edge_length, method, threads, outcome)
            note = "map of the surface without decimation"
        except quadrille.RemeshError as error:
            note = f"map of the intermediate level, as there is none of the surface without decimation: {error}"
    if mapped is None:
        mapped = _copy(chain.run("COST_GAUSSIAN", ALL))
        outcome.name = "intermediate level"
        _levels(chain, outcome)
    outcome.seconds["whole"] = time.perf_counter() - start
    return mapped, outcome, note


def _levels(chain, outcome):
    coarse = chain.grid.GetOutput()
    outcome.vertices, outcome.triangles = coarse.GetNumberOfPoints(), coarse.GetNumberOfCells()
    for run in (chain.hierarchy, chain.grid, chain.upmap):
        outcome.seconds.update(_stages(run))


def study(surface, model, quads, budgets=(500, 2000, 4000, 0), method="seamless", threads=0, tell=print, costs=COSTS,
          largest=LARGEST):
    """All maps of a surface: the reference, one by each cost with a budget of BUDGET vertices, and one by E_G with each
    of `budgets` (0: as many as the curvature needs). A map that cannot be made is an outcome with its error. method: a
    name of quadrille.METHODS; seamless ones differ by the levels only, not by whole numbers. tell is called with a
    line now and then. costs: those of COSTS that are looked at; largest: points of a surface that is mapped without
    decimation."""
    chain = _Chain(surface, quads, method, threads)
    tell(f"{model}: levels")
    first = _copy(chain.run("COST_GAUSSIAN", BUDGET))
    edge_length = chain.hierarchy.GetOutput().GetFieldData().GetArray("TargetEdgeLength").GetTuple1(0)
    tell(f"{model}: reference")
    reference, outcome, note = _reference(chain, first, edge_length, method, threads, largest)
    _measure(outcome, reference, reference, edge_length, threads)
    result = Study(model, first.GetNumberOfCells(), quads, edge_length, method, note, [outcome])
    runs = [(name, cost, BUDGET) for name, cost in costs]
    runs += [(f"E_G, {'automatic' if budget == 0 else budget}", "COST_GAUSSIAN", budget) for budget in budgets]
    for name, cost, budget in runs:
        tell(f"{model}: {name}")
        outcome = Outcome(name, budget)
        try:
            start = time.perf_counter()
            mapped = _copy(chain.run(cost, budget))
            outcome.seconds["whole"] = time.perf_counter() - start
            _levels(chain, outcome)
            _measure(outcome, mapped, reference, edge_length, threads)
        except (quadrille.RemeshError, quadrille.InvalidInput) as error:
            outcome.error = str(error)
        result.outcomes.append(outcome)
    return result
