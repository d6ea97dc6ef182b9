#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws CAD bodies by a seed and writes their triangles as STL exporters make them: parts that nobody has chosen.

  draw_bodies.py FOLDER [--count N] [--seed S]

A body is one of several kinds (plate, bracket, block, disc, shaft, tray, arm, gear, grating, profile, turned part,
pipe), or two of them in one; then features on faces that are picked at random (holes, counterbores, slots, pockets,
bosses, ribs), also near edges; then fillets and chamfers of random edges. The same seed draws the same bodies, whatever
the count. Each is written twice, NUMBER_KIND_coarse.stl and NUMBER_KIND_fine.stl: with an angle of 20 and of 6 degrees
between the triangles of curved faces, planes as the needles that the mesher of Open CASCADE makes of them. Bodies that
Open CASCADE fails to make, or whose triangles are not closed, are drawn again.

Needs gmsh (package python3-gmsh) for the bodies, and Draw (packages occt-draw, libocct-draw-dev) for the triangles.
"""
import argparse
import math
import multiprocessing
import pathlib
import random
import subprocess
import sys
import tempfile

import gmsh
import numpy

#: Angle between the triangles of curved faces in degrees, and distance to the surface over the diagonal.
TESSELLATIONS = {"coarse": (20.0, 4e-3), "fine": (6.0, 5e-4)}
SECONDS = 60  # a body that takes longer is drawn again

occ = gmsh.model.occ


def cut(body, tools):
    return occ.cut([(3, body)], [(3, tool) for tool in tools])[0][0][1]


def fuse(body, tools):
    return occ.fuse([(3, body)], [(3, tool) for tool in tools])[0][0][1]


def prism(points, height):
    """A polygon in the plane z = 0, drawn up by height."""
    corners = [occ.addPoint(x, y, 0) for x, y in points]
    lines = [occ.addLine(corners[i], corners[(i + 1) % len(corners)]) for i in range(len(corners))]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    return next(tag for dim, tag in occ.extrude([(2, face)], 0, 0, height) if dim == 3)


def cylinder(at, along, radius):
    return occ.addCylinder(*at, *along, radius)


# Kinds of bodies. Lengths are about millimetres.

def plate(rng):
    length, width, height = rng.uniform(30, 120), rng.uniform(20, 80), rng.uniform(2, 12)
    body = occ.addBox(0, 0, 0, length, width, height)
    holes = []
    for _ in range(rng.randint(1, 8)):
        radius = rng.uniform(1, min(length, width) / 6)
        x, y = (rng.uniform(1.1 * radius, size - 1.1 * radius) for size in (length, width))
        holes.append(cylinder((x, y, -1), (0, 0, height + 2), radius))
    return cut(body, holes)


def bracket(rng):
    length, height, width, wall = rng.uniform(25, 70), rng.uniform(20, 70), rng.uniform(15, 60), rng.uniform(3, 9)
    body = prism([(0, 0), (length, 0), (length, wall), (wall, wall), (wall, height), (0, height)], width)
    if rng.random() < 0.6:
        reach = rng.uniform(0.3, 0.9) * (min(length, height) - wall)
        rib = prism([(wall / 2, wall / 2), (wall + reach, wall / 2), (wall + reach, wall), (wall, wall + reach),
                     (wall / 2, wall + reach)], rng.uniform(0.1, 0.3) * width)
        occ.translate([(3, rib)], 0, 0, rng.uniform(0.1, 0.6) * width)
        body = fuse(body, [rib])
    return body


def block(rng):
    size = [rng.uniform(15, 60) for _ in range(3)]
    body = occ.addBox(0, 0, 0, *size)
    for _ in range(rng.randint(0, 2)):
        step = [rng.uniform(0.2, 0.6) * length for length in size]
        step[rng.randrange(3)] = 200
        corner = [rng.choice((-0.01, length - part)) for length, part in zip(size, step)]
        body = cut(body, [occ.addBox(*corner, *(part + 0.01 for part in step))])
    return body


def disc(rng):
    radius, height = rng.uniform(15, 50), rng.uniform(3, 20)
    body = cylinder((0, 0, 0), (0, 0, height), radius)
    holes = [cylinder((0, 0, -1), (0, 0, height + 2), rng.uniform(0.1, 0.35) * radius)]
    count, circle, small = rng.randint(3, 10), rng.uniform(0.5, 0.85) * radius, rng.uniform(0.03, 0.1) * radius
    for i in range(count):
        turn = 2 * math.pi * i / count
        holes.append(cylinder((circle * math.cos(turn), circle * math.sin(turn), -1), (0, 0, height + 2), small))
    body = cut(body, holes)
    if rng.random() < 0.5:
        hub = cylinder((0, 0, 0), (0, 0, height + rng.uniform(3, 20)), rng.uniform(0.36, 0.5) * radius)
        bore = cylinder((0, 0, -1), (0, 0, height + 30), rng.uniform(0.1, 0.3) * radius)
        body = cut(fuse(body, [hub]), [bore])
    return body


def shaft(rng):
    at, steps = 0.0, []
    for _ in range(rng.randint(2, 6)):
        length, radius = rng.uniform(3, 30), rng.uniform(4, 15)
        steps.append(cylinder((0, 0, at), (0, 0, length), radius))
        at += length
    body = fuse(steps[0], steps[1:])
    if rng.random() < 0.5:
        body = cut(body, [occ.addBox(-1.5, rng.uniform(1, 4), rng.uniform(0, at / 2), 3, 30, rng.uniform(5, at / 2))])
    if rng.random() < 0.5:
        body = cut(body, [cylinder((-30, 0, rng.uniform(2, at - 2)), (60, 0, 0), rng.uniform(1, 2.5))])
    if rng.random() < 0.4:
        body = cut(body, [cylinder((0, 0, -1), (0, 0, rng.uniform(0.2, 1.2) * at + 2), rng.uniform(1.5, 3.5))])
    return body


def tray(rng):
    length, width, height, wall = rng.uniform(30, 90), rng.uniform(25, 70), rng.uniform(8, 40), rng.uniform(1, 5)
    inner = occ.addBox(wall, wall, wall, length - 2 * wall, width - 2 * wall, height)
    body = cut(occ.addBox(0, 0, 0, length, width, height), [inner])
    radius, inset = rng.uniform(1.5, 4), rng.uniform(0.2, 1.6)
    if rng.random() < 0.6:
        near = wall + inset * radius
        corners = [(x, y) for x in (near, length - near) for y in (near, width - near)]
        tall = rng.uniform(0.4, 0.95) * height
        body = fuse(body, [cylinder((x, y, wall / 2), (0, 0, tall - wall / 2), radius) for x, y in corners])
        body = cut(body, [cylinder((x, y, wall), (0, 0, height), 0.5 * radius) for x, y in corners])
    if rng.random() < 0.5:
        body = fuse(body, [occ.addBox(rng.uniform(0.3, 0.6) * length, wall / 2, wall / 2, rng.uniform(1, 3),
                                      width - wall, rng.uniform(0.3, 0.8) * height)])
    return body


def arm(rng):
    length, height = rng.uniform(30, 90), rng.uniform(4, 15)
    first, second = rng.uniform(7, 18), rng.uniform(5, 15)
    along = rng.uniform(0.3, 1.0) * min(first, second)
    ends = [cylinder((0, 0, 0), (0, 0, height * rng.uniform(1, 2)), first),
            cylinder((length, 0, 0), (0, 0, height * rng.uniform(1, 2)), second)]
    body = fuse(occ.addBox(0, -along, 0, length, 2 * along, height), ends)
    bores = [cylinder((0, 0, -1), (0, 0, 60), rng.uniform(0.3, 0.8) * first),
             cylinder((length, 0, -1), (0, 0, 60), rng.uniform(0.3, 0.8) * second)]
    return cut(body, bores)


def gear(rng):
    count, radius, height = rng.randint(8, 40), rng.uniform(15, 40), rng.uniform(4, 15)
    if rng.random() < 0.5:
        pitch = 2 * math.pi / count
        low = radius * (1 - rng.uniform(1.2, 2.4) / count)
        points = []
        for i in range(count):
            for share, reach in ((0.0, low), (0.28, low), (0.42, radius), (0.86, radius)):
                points.append((reach * math.cos(pitch * (i + share)), reach * math.sin(pitch * (i + share))))
        body = prism(points, height)
    else:
        groove = rng.uniform(0.2, 0.8) * math.pi * radius / count
        turns = [2 * math.pi * i / count for i in range(count)]
        body = cut(cylinder((0, 0, 0), (0, 0, height), radius),
                   [cylinder((radius * math.cos(turn), radius * math.sin(turn), -1), (0, 0, height + 2), groove)
                    for turn in turns])
    return cut(body, [cylinder((0, 0, -1), (0, 0, height + 2), rng.uniform(0.1, 0.6) * radius)])


def grating(rng):
    columns, rows, height = rng.randint(2, 9), rng.randint(1, 6), rng.uniform(1, 8)
    wide, deep, bar, rim = rng.uniform(2, 8), rng.uniform(3, 20), rng.uniform(0.8, 4), rng.uniform(1, 8)
    body = occ.addBox(0, 0, 0, columns * (wide + bar) - bar + 2 * rim, rows * (deep + bar) - bar + 2 * rim, height)
    tools, is_round = [], rng.random() < 0.4
    for i in range(columns):
        for j in range(rows):
            x, y = rim + i * (wide + bar), rim + j * (deep + bar)
            if is_round:
                tools.append(cylinder((x + wide / 2, y + deep / 2, -1), (0, 0, height + 2), min(wide, deep) / 2))
            else:
                tools.append(occ.addBox(x, y, -1, wide, deep, height + 2))
    return cut(body, tools)


def profile(rng):
    """A profile of right angles and slants, drawn up."""
    x, points, top = 0.0, [(0.0, 0.0)], rng.uniform(8, 30)
    while x < 40:
        after = x + rng.uniform(3, 14)
        height = rng.uniform(3, 30)
        points += [(x, top), (after, top if rng.random() < 0.7 else height)]
        x, top = after, height
    points.append((x, 0.0))
    clean = [point for i, point in enumerate(points) if point != points[i - 1]]
    return prism(clean, rng.uniform(10, 60))


def turned(rng):
    """A profile that is turned about the z axis."""
    low, z, points = rng.uniform(2, 8), 0.0, []
    for _ in range(rng.randint(2, 5)):
        radius, height = low + rng.uniform(2, 22), rng.uniform(2, 15)
        points += [(radius, z), (radius + rng.choice((0, 0, rng.uniform(-1.5, 3))), z + height)]
        z += height
    points = [(low, 0.0)] + points + [(low, z)]
    corners = [occ.addPoint(x, 0, height) for x, height in points]
    lines = [occ.addLine(corners[i], corners[(i + 1) % len(corners)]) for i in range(len(corners))]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    made = occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, 2 * math.pi)
    return next(tag for dim, tag in made if dim == 3)


def pipe(rng):
    """A pipe with flanges and a branch."""
    radius, length, wall = rng.uniform(6, 15), rng.uniform(30, 80), rng.uniform(1, 3.5)
    side = rng.uniform(0.4, 0.95) * radius
    at = rng.uniform(0.35, 0.65) * length
    along = (0, rng.uniform(1.4, 3) * radius, rng.choice((0, rng.uniform(-10, 10))))
    body = fuse(cylinder((0, 0, 0), (0, 0, length), radius), [cylinder((0, 0, at), along, side)])
    flanges = [cylinder((0, 0, z), (0, 0, 4), radius + rng.uniform(3, 10)) for z in (0, length - 4)]
    body = fuse(body, flanges[:rng.randint(1, 2)])
    far = tuple(1.1 * part for part in along)
    return cut(body, [cylinder((0, 0, -1), (0, 0, length + 2), radius - wall),
                      cylinder((0, 0, at), far, max(side - wall, 0.5 * side))])


KINDS = {kind.__name__: kind for kind in (plate, bracket, block, disc, shaft, tray, arm, gear, grating, profile, turned,
                                          pipe)}


# Features on faces.

def place_on_face(rng, body):
    """A point on a plane face, its outward normal, a direction in it, and about how wide the face is there."""
    faces = [tag for _, tag in gmsh.model.getBoundary([(3, body)], oriented=False) if
             gmsh.model.getType(2, tag) == "Plane"]
    rng.shuffle(faces)
    for face in faces:
        low, high = gmsh.model.getParametrizationBounds(2, face)
        for _ in range(20):
            place = [rng.uniform(low[i], high[i]) for i in range(2)]
            if not gmsh.model.isInside(2, face, place):
                continue
            at = numpy.array(gmsh.model.getValue(2, face, place))
            normal = numpy.array(gmsh.model.getNormal(face, place))
            probe = occ.addSphere(*(at + 0.02 * normal), 0.01)
            if occ.intersect([(3, probe)], [(3, body)], removeTool=False)[0]:  # getNormal() is that of the surface
                normal = -normal
            aside = numpy.cross(normal, (1, 0, 0) if abs(normal[0]) < 0.7 else (0, 1, 0))
            box = gmsh.model.getBoundingBox(2, face)
            extents = sorted(box[3 + i] - box[i] for i in range(3))
            return at, normal, aside / numpy.linalg.norm(aside), extents[1]
    return None


def bar(at, normal, aside, sizes, low, high):
    """A box on a face: sizes along aside and across, from low to high along the normal."""
    across = numpy.cross(normal, aside)
    corners = [at + low * normal + 0.5 * (a * sizes[0] * aside + b * sizes[1] * across) for a, b in
               ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    points = [occ.addPoint(*corner) for corner in corners]
    lines = [occ.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    return next(tag for dim, tag in occ.extrude([(2, face)], *((high - low) * normal)) if dim == 3)


def add_feature(rng, body):
    place = place_on_face(rng, body)
    if place is None:
        return body
    at, normal, aside, width = place
    radius = rng.uniform(0.04, 0.22) * width
    kind = rng.choice(("through", "through", "blind", "counterbore", "slot", "pocket", "boss", "rib", "stud"))
    depth = rng.uniform(0.5, 3) * radius
    if kind == "through":
        return cut(body, [cylinder(at + normal, -300 * normal, radius)])
    if kind == "blind":
        return cut(body, [cylinder(at + normal, -(depth + 1) * normal, radius)])
    if kind == "counterbore":
        return cut(body, [cylinder(at + normal, -300 * normal, 0.55 * radius),
                          cylinder(at + normal, -(0.5 * depth + 1) * normal, radius)])
    if kind == "slot":
        half = rng.uniform(0.5, 3) * radius
        ends = [cylinder(at + side * half * aside + normal, -(depth + 1) * normal, radius) for side in (-1, 1)]
        return cut(body, [fuse(bar(at, normal, aside, (2 * half, 2 * radius), 1, -depth), ends)])
    if kind == "pocket":
        return cut(body, [bar(at, normal, aside, (2 * radius, rng.uniform(0.5, 4) * radius), 1, -depth)])
    if kind == "rib":
        return fuse(body, [bar(at, normal, aside, (0.5 * radius, rng.uniform(2, 6) * radius), -0.2 * radius, depth)])
    boss = fuse(body, [cylinder(at - 0.2 * radius * normal, (depth + 0.2 * radius) * normal, radius)])
    return boss if kind == "stud" else cut(boss, [cylinder(at + (depth + 1) * normal, -(depth + 2) * normal,
                                                           rng.uniform(0.3, 0.7) * radius)])


def round_edges(rng, body):
    """Fillets or chamfers of some edges; what Open CASCADE fails at stays sharp."""
    faces = [tag for _, tag in gmsh.model.getBoundary([(3, body)], oriented=False)]
    of_face = {face: [abs(tag) for _, tag in gmsh.model.getBoundary([(2, face)])] for face in faces}
    edges = sorted({edge for loop in of_face.values() for edge in loop})
    box = gmsh.model.getBoundingBox(3, body)
    size = rng.uniform(0.02, 0.12) * min(box[3 + i] - box[i] for i in range(3))
    which = rng.choice(("all", "face", "face", "some", "some", "some"))
    if which == "face":
        edges = of_face[rng.choice(faces)]
    elif which == "some":
        edges = rng.sample(edges, min(len(edges), rng.randint(1, 8)))
    try:
        if rng.random() < 0.7:
            made = occ.fillet([body], edges, [size], removeVolume=False)[0][1]
        else:
            owners = [next(face for face in faces if edge in of_face[face]) for edge in edges]
            made = occ.chamfer([body], edges, owners, [size], removeVolume=False)[0][1]
    except Exception:  # gmsh raises nothing more special
        return body
    occ.remove([(3, body)], recursive=True)
    return made


def draw(rng):
    """The kind, and the tag of the only volume."""
    name = rng.choice(list(KINDS))
    body = KINDS[name](rng)
    if rng.random() < 0.2:
        other = rng.choice(list(KINDS))
        second = KINDS[other](rng)
        occ.rotate([(3, second)], 0, 0, 0, *rng.choice(((1, 0, 0), (0, 1, 0), (0, 0, 1))),
                   rng.choice((0, math.pi / 2, rng.uniform(0, math.pi))))
        occ.translate([(3, second)], rng.uniform(0, 15), rng.uniform(0, 15), rng.uniform(0, 5))
        body, name = fuse(body, [second]), f"{name}-{other}"
    occ.synchronize()
    for _ in range(rng.randint(0, 5)):
        body = add_feature(rng, body)
        occ.synchronize()
    for _ in range(rng.choice((0, 1, 1, 2, 3))):
        body = round_edges(rng, body)
        occ.synchronize()
    volumes = gmsh.model.getEntities(3)
    if len(volumes) != 1:
        raise RuntimeError("more than one body")
    return name, volumes[0][1]


def triangles_of(path):
    """Of a binary STL file, #triangles x 3 x 3."""
    data = path.read_bytes()[84:]
    record = numpy.dtype([("normal", "<f4", 3), ("points", "<f4", (3, 3)), ("attribute", "<u2")])
    return numpy.frombuffer(data, dtype=record)["points"].astype(float)


def is_sound(triangles, volume):
    """Closed, and with the volume of the body but for what chords cut off."""
    _, names = numpy.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    names = names.reshape(-1, 3)
    names = names[(names != numpy.roll(names, 1, axis=1)).all(axis=1)]
    ways = numpy.concatenate([names[:, (i, (i + 1) % 3)] for i in range(3)])
    there, back = (numpy.unique(pairs, axis=0, return_counts=True) for pairs in (ways, ways[:, ::-1]))
    if there[0].shape != back[0].shape or (there[0] != back[0]).any() or (there[1] != back[1]).any():
        return False
    found = numpy.einsum("ij,ij->", triangles[:, 0], numpy.cross(triangles[:, 1], triangles[:, 2])) / 6
    return abs(found - volume) < 0.05 * volume


def write_body(folder, number, seed):
    """Raises an exception where there is no sound body."""
    rng = random.Random(seed)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    name, body = draw(rng)
    volume = occ.getMass(3, body)
    box = gmsh.model.getBoundingBox(3, body)
    diagonal = math.dist(box[:3], box[3:])
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        gmsh.write(str(place / "body.brep"))
        gmsh.finalize()
        commands = "pload MODELING XDE\n"
        for which, (angle, distance) in TESSELLATIONS.items():
            commands += (f"restore {place}/body.brep s\nincmesh s {distance * diagonal} -a {angle}\n"
                         f"writestl s {place}/{which}.stl 1\n")
        (place / "draw.tcl").write_text(commands + "exit\n")
        subprocess.run(["occt-draw-7.6", "-b", "-f", place / "draw.tcl"], stdin=subprocess.DEVNULL, capture_output=True,
                       timeout=SECONDS, check=False)
        written = {which: place / f"{which}.stl" for which in TESSELLATIONS}
        if not all(path.exists() and is_sound(triangles_of(path), volume) for path in written.values()):
            raise RuntimeError("its triangles are not closed")
        for which, path in written.items():
            (folder / f"{number:03d}_{name}_{which}.stl").write_bytes(path.read_bytes())


def write_or_exit(folder, number, seed):
    try:
        write_body(folder, number, seed)
    except Exception as error:  # gmsh raises nothing more special
        print(f"{number:03d}: {error}", flush=True)
        sys.exit(1)


def attempt(folder, number, seed):
    """A process of its own, as Open CASCADE may end it or never return."""
    process = multiprocessing.Process(target=write_or_exit, args=(folder, number, seed))
    process.start()
    process.join(SECONDS)
    if process.is_alive():
        process.kill()
        process.join()
    return process.exitcode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for number in range(arguments.count):
        tries = 0
        while not attempt(arguments.folder, number, f"{arguments.seed}/{number}/{tries}"):
            tries += 1
        print(f"{number:03d}: drawn {tries + 1} times", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
