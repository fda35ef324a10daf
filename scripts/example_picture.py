"""Draws a mesh cut open beside a deformed result; numpy and matplotlib only."""

import matplotlib
import numpy as np

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402
from matplotlib.colors import Normalize  # noqa: E402

FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # of a tetrahedron, normals outward
QUARTERS = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])  # of a triangle with mid-side nodes
LIGHT = np.array([-0.4, 0.5, 0.77])  # right, up, towards the viewer
INK, GREY = "#1f2933", "#7b8794"
LARGEST_SHARE = 0.06  # deformation shown, as a share of the diagonal


def view(azimuth, elevation):
    """(3, 3) rows right, up, towards the viewer; degrees."""
    a, e = np.radians([azimuth, elevation])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def draw(axes, points, triangles, colours, camera, line="none", width=0.0):
    """Paint triangles facing the camera from back to front, shaded; colours (m, 3)."""
    seen = points @ camera.T
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    front = normals @ camera[2] > 0
    order = np.flatnonzero(front)
    order = order[np.argsort(seen[triangles[order], 2].mean(axis=1))]
    shade = 0.62 + 0.38 * np.clip(normals[order] @ (camera.T @ LIGHT), 0.0, 1.0)
    paint = np.clip(colours[order] * shade[:, None], 0.0, 1.0)
    edge = paint if line == "none" else line
    axes.add_collection(
        PolyCollection(seen[triangles[order], :2], facecolors=paint, edgecolors=edge, linewidths=width)
    )


def frame(axes, points, camera):
    """Limits and looks of one half."""
    seen = points @ camera.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    margin = 0.04 * (high - low).max()
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.axis("off")


def colour_bar(figure, axes, norm, colours, label):
    """A slim bar under one half; its end is pointed where values lie above it."""
    box = axes.get_position()
    place = figure.add_axes([box.x0 + 0.2 * box.width, 0.1, 0.6 * box.width, 0.022])
    bar = figure.colorbar(
        plt.cm.ScalarMappable(norm, colours), cax=place, orientation="horizontal", extend="max"
    )
    bar.set_label(label, color=INK, fontsize=11)
    bar.ax.tick_params(labelsize=10, colors=INK)
    bar.outline.set_visible(False)


def cut_open(points, tets, origin, normal):
    """(triangles, tetrahedron of each): the skin of the tetrahedra whose centre lies behind a plane."""
    centres = points[tets[:, :4]].mean(axis=1)
    kept = np.flatnonzero((centres - origin) @ normal < 0)
    faces = tets[kept][:, FACES].reshape(-1, 3)
    _, inverse, count = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    skin = count[inverse.reshape(-1)] == 1
    return faces[skin], np.repeat(kept, 4)[skin]


def draw_mesh(figure, axes, points, tets, angles, camera, cut):
    """The cut mesh, each tetrahedron in the colour of its smallest dihedral angle."""
    triangles, owner = cut_open(points, tets, *cut)
    norm, colours = Normalize(15, 60), plt.get_cmap("viridis")
    draw(
        axes,
        points,
        triangles,
        colours(norm(angles[owner]))[:, :3],
        camera,
        line=(0.07, 0.1, 0.13, 0.75),
        width=0.25,
    )
    frame(axes, points, camera)
    colour_bar(figure, axes, norm, colours, "smallest dihedral angle of each tetrahedron (degrees)")
    axes.set_title("Mesh, cut open", color=INK, fontsize=14, pad=4)


def draw_result(figure, axes, points, triangles, lines, moved, stress, camera):
    """The deformed surface coloured by stress over the outline of the part as it was."""
    largest = np.linalg.norm(moved, axis=1).max()
    factor = LARGEST_SHARE * np.linalg.norm(np.ptp(points, axis=0)) / max(largest, 1e-30)
    deformed = points + factor * moved
    fine = triangles[:, QUARTERS].reshape(-1, 3) if triangles.shape[1] == 6 else triangles
    norm, colours = Normalize(0, np.percentile(stress, 99.7)), plt.get_cmap("turbo")
    values = stress[fine].mean(axis=1)
    seen = points @ camera.T
    outline = LineCollection(seen[lines[:, :2], :2], colors=GREY, linewidths=0.7, alpha=0.7)
    draw(axes, deformed, fine, colours(norm(values))[:, :3], camera, width=0.15)
    axes.add_collection(outline)
    frame(axes, np.concatenate([points, deformed]), camera)
    colour_bar(figure, axes, norm, colours, "von Mises stress (MPa)")
    axes.set_title(
        "Deformed %.0f times, outline of the unloaded part" % factor, color=INK, fontsize=14, pad=4
    )


def picture(path, mesh, angles, moved, stress, cut, title):
    """Both halves in one PNG.  angles (t,); moved (n, 3) and stress (n,) per node; cut = (point, normal)."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(15, 7), facecolor="white")
    figure.subplots_adjust(left=0.01, right=0.99, top=0.88, bottom=0.14, wspace=0.02)
    draw_mesh(figure, left, mesh.points, mesh.tets[:, :4], angles, view(-60, 24), cut)
    draw_result(figure, right, mesh.points, mesh.triangles, mesh.lines, moved, stress, view(-50, 24))
    figure.suptitle(title, color=INK, fontsize=13, y=0.985)
    figure.savefig(path, dpi=130)
    plt.close(figure)
