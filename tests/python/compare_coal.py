"""`cspace-haptics track --time` beside Coal, warm-started, on the same parts and poses.

    pip install coal==3.0.3 numpy scipy
    python3 tests/python/compare_coal.py target/release/cspace-haptics

A part slides over an obstacle in shallow contact (1 % of the sum of the radii), 0.1 % of that sum and a milliradian a
sample. Coal computes its signed distance from the last answer: cached guess, cached support hints. It is called from
Python, so the same call on two spheres, where there is next to nothing to compute, is timed and taken off. Coal is timed
by the CPU clock of its thread, which a busy machine does not disturb; both times
are the best of five passes; the depths are compared, too.
"""

import csv
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import coal
import numpy as np
from scipy.spatial import ConvexHull

SAMPLES = 4000
PASSES = 5


def box(x, y, z):
    return np.array([[i, j, k] for i in (-x / 2, x / 2) for j in (-y / 2, y / 2) for k in (-z / 2, z / 2)])


def ball(rng, count, radius):
    points = rng.normal(size=(count, 3))
    return radius * points / np.linalg.norm(points, axis=1)[:, None]


def triangles(points):
    """Triangles of the hull, counter-clockwise seen from outside; every point must be a corner."""
    hull = ConvexHull(points)
    assert len(hull.vertices) == len(points)
    center = points.mean(axis=0)
    for a, b, c in hull.simplices:
        outward = np.dot(np.cross(points[b] - points[a], points[c] - points[a]), points[a] - center) > 0
        yield (int(a), int(b), int(c)) if outward else (int(a), int(c), int(b))


def write_obj(path, points):
    lines = ["v " + " ".join(repr(float(c)) for c in p) for p in points]
    lines += ["f " + " ".join(str(i + 1) for i in t) for t in triangles(points)]
    path.write_text("\n".join(lines) + "\n")


def convex(points):
    vertices, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for p in points:
        vertices.append(p)
    for t in triangles(points):
        faces.append(coal.Triangle(*t))
    return coal.Convex(vertices, faces)


def request():
    r = coal.DistanceRequest()
    r.enable_signed_distance = True
    r.gjk_initial_guess = coal.GJKInitialGuess.CachedGuess
    return r


def transform(x, q):
    t = coal.Transform3s()
    t.setTranslation(x)
    i, j, k, w = q
    t.setRotation(
        np.array(
            [
                [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
                [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
                [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
            ]
        )
    )
    return t


def turn(q, axis_angle):
    half = axis_angle / 2
    v, w = np.append(half, 1.0)[:3], 1.0
    out = np.append(w * q[:3] + q[3] * v + np.cross(v, q[:3]), w * q[3] - v @ q[:3])
    return out / np.linalg.norm(out)


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def sliding(rng, a, b, size):
    """Poses at a depth of 1 % of the size, found by bisection on Coal's own answer."""
    query = coal.ComputeDistance(a, b)
    still, r, result = coal.Transform3s(), request(), coal.DistanceResult()
    direction, heading, q = unit(rng), unit(rng), np.append(unit(rng), 1.0)
    q /= np.linalg.norm(q)
    poses = []
    for _ in range(SAMPLES):
        heading = heading + 0.02 * unit(rng)
        heading /= np.linalg.norm(heading)
        direction = direction + 0.001 * heading
        direction /= np.linalg.norm(direction)
        q = turn(q, 0.001 * unit(rng))
        low, high = 0.0, 2 * size
        for _ in range(25):
            middle = (low + high) / 2
            result.clear()
            inside = query(transform(direction * middle, q), still, r, result) < -0.01 * size
            low, high = (middle, high) if inside else (low, middle)
        poses.append((direction * high, q))
    return poses


def coal_time(a, b, poses):
    """ns a call, and the answers of the last pass."""
    query, still = coal.ComputeDistance(a, b), coal.Transform3s()
    transforms = [transform(x, q) for x, q in poses]
    best, answers = np.inf, []
    for _ in range(PASSES):
        r, result = request(), coal.DistanceResult()
        answers = []
        start = time.thread_time_ns()
        for t in transforms:
            result.clear()
            answers.append(query(t, still, r, result))
            r.updateGuess(result)
        best = min(best, (time.thread_time_ns() - start) / len(poses))
    return best, np.array(answers)


def track(program, folder, points_a, points_b, poses):
    """Mean ns a step, and the distances."""
    write_obj(folder / "a.obj", points_a)
    write_obj(folder / "b.obj", points_b)
    with open(folder / "p.csv", "w") as f:
        f.write("t,x,y,z,qx,qy,qz,qw\n")
        for i, (x, q) in enumerate(poses):
            f.write(",".join(repr(float(v)) for v in (i * 1e-3, *x, *q)) + "\n")
    files = {"--moving": "a.obj", "--fixed": "b.obj", "--poses": "p.csv", "--out": "o.csv"}
    command = [program, "track", "--time"] + [s for k, v in files.items() for s in (k, str(folder / v))]
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    mean = float(out.split("mean=")[1].split()[0])
    with open(folder / "o.csv") as f:
        return mean, np.array([float(row["distance"]) for row in csv.DictReader(f)])


def main():
    program = sys.argv[1]
    rng = np.random.default_rng(1)
    cases = [
        ("boxes", box(0.06, 0.08, 0.1), box(0.1, 0.09, 0.12)),
        ("60 points", ball(rng, 60, 0.05), ball(rng, 60, 0.06)),
        ("1,000 points", ball(rng, 1000, 0.05), ball(rng, 1000, 0.06)),
    ]
    print("| parts | track | Coal | call taken off | times faster | largest difference in depth / size |")
    print("|---|---|---|---|---|---|")
    for name, points_a, points_b in cases:
        size = sum(np.linalg.norm(p, axis=1).max() for p in (points_a, points_b))
        a, b = convex(points_a), convex(points_b)
        poses = sliding(rng, a, b, size)
        call, _ = coal_time(coal.Sphere(0.01), coal.Sphere(0.01), poses)
        theirs, depths = coal_time(a, b, poses)
        with tempfile.TemporaryDirectory() as folder:
            ours, distances = track(program, Path(folder), points_a, points_b, poses)
        off = np.abs(depths - distances).max() / size
        net = theirs - call
        print(f"| {name} | {ours:.0f} ns | {net:.0f} ns | {call:.0f} ns | {net / ours:.1f} | {off:.0e} |", flush=True)


if __name__ == "__main__":
    main()
