# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# Types of the package; what they mean is in the docstrings. Testing/Native/test_types.py holds it against them.
from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, NamedTuple

import numpy
from numpy.typing import ArrayLike, NDArray

# A Mesh, a pair (points, faces), an object with vertices and faces, or data of VTK.
MeshLike = Any
Progress = Callable[[float, str], object]
Place = int | Sequence[float] | NDArray[Any]

class RemeshError(RuntimeError): ...
class InvalidInput(RemeshError, ValueError): ...

class FailedElements(RemeshError):
    elements: Any
    count: int

class Mesh:
    points: NDArray[numpy.float64]
    offsets: NDArray[numpy.int64]
    corners: NDArray[numpy.int64]
    point_data: dict[str, NDArray[Any]]
    cell_data: dict[str, NDArray[Any]]
    field_data: dict[str, Any]
    def __init__(
        self, points: ArrayLike, faces: Any, *, point_data: Mapping[str, NDArray[Any]] | None = ...,
        cell_data: Mapping[str, NDArray[Any]] | None = ..., field_data: Mapping[str, Any] | None = ...) -> None: ...
    @classmethod
    def from_cells(
        cls, points: NDArray[Any], offsets: NDArray[Any], corners: NDArray[Any], *,
        point_data: Mapping[str, NDArray[Any]] | None = ..., cell_data: Mapping[str, NDArray[Any]] | None = ...,
        field_data: Mapping[str, Any] | None = ...) -> Mesh: ...
    @property
    def faces(self) -> Any: ...
    @property
    def vertices(self) -> NDArray[numpy.float64]: ...
    def __iter__(self) -> Iterator[Any]: ...
    def __len__(self) -> int: ...
    def with_arrays(self, point_data: Mapping[str, NDArray[Any]], cell_data: Mapping[str, NDArray[Any]]) -> Mesh: ...
    def to_vtk(self) -> Any: ...

class Remeshed(NamedTuple):
    quads: Any
    surface: Any
    lines: Any
    info: dict[str, Any]
    separatrices: Any

class Irregular(NamedTuple):
    point: NDArray[numpy.float64]
    valence: NDArray[Any]

def remesh(
    mesh: MeshLike,
    *,
    quads: int | None = ...,
    edge_length: float | None = ...,
    relative_edge_length: float | None = ...,
    feature_angle: float | None = ...,
    feature_criterion: str = ...,
    guiding_direction: ArrayLike | None = ...,
    guiding_weight: ArrayLike | None = ...,
    target_valence: ArrayLike | Mapping[int, int] | None = ...,
    sizing: ArrayLike | None = ...,
    feature_edges: ArrayLike | None = ...,
    patch_ids: ArrayLike | None = ...,
    curves: Sequence[ArrayLike] | Any = ...,
    strokes: Sequence[ArrayLike] | None = ...,
    connections: Sequence[ArrayLike] | None = ...,
    cycles: Sequence[ArrayLike] | None = ...,
    patch_array: str | None = ...,
    coarse_vertices: int = ...,
    threads: int = ...,
    maximum_number_of_quads: int = ...,
    smoothing_steps: int = ...,
    memory_limit: float = ...,
    time_limit: float = ...,
    close_handles: float = ...,
    small_details: str = ...,
    small_components: str = ...,
    method: str = ...,
    final_quality: str = ...,
    integers: str = ...,
    anisotropy_limit: float = ...,
    distortion_metric: bool = ...,
    cell_data: str = ...,
    preview: bool = ...,
    symmetry: str | tuple[Sequence[float], Sequence[float]] | None = ...,
    rotation: int | tuple[int, Sequence[float], Sequence[float]] | None = ...,
    plane_curve: str = ...,
    chord_error: float | None = ...,
    gap_quads: float = ...,
    smallest_size: float = ...,
    largest_size: float = ...,
    guide: str | None = ...,
    guide_anisotropy: float = ...,
    stroke_radius: float = ...,
    wrap: float | str | None = ...,
    progress: Progress | None = ...,
    everything: bool = ...,
    spread: bool = ...) -> Any: ...
def to_arrays(quads: Any) -> tuple[NDArray[Any], NDArray[Any]]: ...
def to_polydata(points: ArrayLike, faces: Any) -> Any: ...
def info(quads: Any) -> dict[str, Any]: ...
def read(path: str | PathLike[str]) -> Any: ...
def write(
    mesh: Any, path: str | PathLike[str], *, patch_array: str | None = ..., element: str | None = ...,
    dialect: str = ..., material: str = ..., msh_version: str = ..., file_details: bool = ...,
    progress: Progress | None = ...) -> list[str]: ...
__version__: str
def has_cgal() -> bool: ...
def check(source: Any) -> Any: ...
def elements(quads: Any, surface: Any = ..., **options: Any) -> Any: ...
def repair(
    mesh: MeshLike, *, fill_holes_below: float = ..., find_self_intersections: bool = ..., time_limit: float = ...,
    progress: Progress | None = ...) -> tuple[Any, list[str]]: ...
def wrap(
    mesh: MeshLike, *, alpha: float | None = ..., offset: float | None = ..., time_limit: float = ...,
    progress: Progress | None = ...) -> Any: ...

class Session:
    def __init__(
        self, mesh: MeshLike, *, quads: int | None = ..., edge_length: float | None = ...,
        relative_edge_length: float | None = ..., guiding_direction: ArrayLike | None = ...,
        guiding_weight: ArrayLike | None = ..., target_valence: ArrayLike | Mapping[int, int] | None = ...,
        sizing: ArrayLike | None = ..., feature_edges: ArrayLike | None = ..., patch_ids: ArrayLike | None = ...,
        progress: Callable[[float], object] | None = ..., **settings: Any) -> None: ...
    @classmethod
    def load(
        cls, file: str | PathLike[str], mesh: MeshLike, *, progress: Callable[[float], object] | None = ...,
        **arrays: Any) -> Session: ...
    def save(self, file: str | PathLike[str]) -> None: ...
    def add_guide(
        self, points: ArrayLike | None = ..., weight: float = ..., radius: float = ..., *,
        faces: ArrayLike | None = ..., direction: Sequence[float] | None = ..., edit: int | None = ...) -> int: ...
    def add_feature(self, points: ArrayLike, *, edit: int | None = ...) -> int: ...
    def set_valence(self, point: Place, valence: int, *, edit: int | None = ...) -> int: ...
    def set_size(
        self, point: Place | None = ..., factor: float = ..., radius: float = ..., *, faces: ArrayLike | None = ...,
        edit: int | None = ...) -> int: ...
    def move_irregular(self, origin: Place, target: Place, *, edit: int | None = ...) -> int: ...
    def split_irregular(
        self, at: Place, first: Place, second: Place, valences: Sequence[int] | None = ..., *,
        edit: int | None = ...) -> int: ...
    def merge_irregular(
        self, first: Place, second: Place, target: Place | None = ..., *, edit: int | None = ...) -> int: ...
    def cancel_pair(self, first: Place, second: Place, *, edit: int | None = ...) -> int: ...
    def add_pair(
        self, first: Place, second: Place, valences: Sequence[int] | None = ..., *, edit: int | None = ...) -> int: ...
    def connect(self, start: Any, end: Place | None = ..., *, edit: int | None = ...) -> int: ...
    def add_cycle(self, points: ArrayLike, *, edit: int | None = ...) -> int: ...
    def set_symmetry(
        self, origin: Sequence[float] | None = ..., normal: Sequence[float] | None = ..., *, plane_curve: str = ...,
        edit: int | None = ...) -> int: ...
    def set_rotation(
        self, order: int, origin: Sequence[float] | None = ..., direction: Sequence[float] | None = ..., *,
        edit: int | None = ...) -> int: ...
    def remove(self, constraint: int) -> None: ...
    def set_settings(self, **settings: Any) -> None: ...
    def update(self) -> dict[str, Any]: ...
    def preview(self) -> tuple[NDArray[numpy.float64], NDArray[Any]]: ...
    @property
    def quads(self) -> tuple[NDArray[numpy.float64], NDArray[Any]]: ...
    @property
    def polydata(self) -> Any: ...
    @property
    def mirror_point(self) -> NDArray[Any] | None: ...
    @property
    def rotated_point(self) -> NDArray[Any] | None: ...
    def irregular(self) -> Irregular: ...
    def constraints(self) -> list[dict[str, Any]]: ...
    def settings(self) -> dict[str, Any]: ...
    def undo(self) -> bool: ...
    def redo(self) -> bool: ...
    def state(self, name: str) -> None: ...
    def states(self) -> list[str]: ...
    def go_to(self, name: str) -> None: ...
    def compare(self, first: str, second: str = ...) -> dict[str, Any]: ...

# Classes of VTK, where the package was built for one.
def __getattr__(name: str) -> Any: ...
