# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Walls of a container: commands of LIGGGHTS, and meshes as STL."""

FLOOR_SPEED = 0.02  # m/s, upwards: floor of the container of meshes
SQUARES = 2  # each side of the mesh in each direction, two triangles a square


def wall_commands(container, model):
    """Lines of the script."""
    half, height = 0.5 * container.width, container.height
    if container.is_open:
        return []
    if container.kind == "mesh":
        return [
            "fix sides all mesh/surface file sides.stl type 1",
            "fix floor all mesh/surface file floor.stl type 1",
            f"fix walls all wall/gran model {model} mesh n_meshes 2 meshes sides floor",
            f"fix lift all move/mesh mesh floor linear 0 0 {FLOOR_SPEED}",
        ]
    planes = [("zplane", "0"), ("zplane", height)]
    if container.kind == "planes":
        planes += [(plane, position) for plane in ("xplane", "yplane") for position in (-half, half)]
    elif container.kind == "cylinder":
        planes.append(("zcylinder", f"{half:.9g} 0 0"))
    return [f"fix wall{i} all wall/gran model {model} primitive type 1 {plane} {position}"
            for i, (plane, position) in enumerate(planes)]


def mesh_files(container):
    """{file name: text}."""
    half, height = 0.5 * container.width, container.height
    across, along, up = (2 * half, 0, 0), (0, 2 * half, 0), (0, 0, height)
    corner, far = (-half, -half, 0), (half, half, height)
    down, back, left = ((0, 0, -height), (0, -2 * half, 0), (-2 * half, 0, 0))
    sides = [(corner, across, up), (corner, along, up), (far, left, down), (far, back, down), (far, left, back)]
    return {"sides.stl": _stl(sides), "floor.stl": _stl([(corner, across, along)])}


def _stl(faces):
    lines = ["solid faces"]
    for corner, edge1, edge2 in faces:
        for i in range(SQUARES):
            for j in range(SQUARES):
                a, b, c, d = (_point(corner, edge1, edge2, i + p, j + q)
                              for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
                for triangle in ((a, b, c), (a, c, d)):
                    lines += ["facet normal 0 0 0", "outer loop"]
                    lines += ["vertex " + " ".join(f"{x:.9g}" for x in point) for point in triangle]
                    lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid faces"]) + "\n"


def _point(corner, edge1, edge2, i, j):
    return [o + (i * p + j * q) / SQUARES for o, p, q in zip(corner, edge1, edge2)]
