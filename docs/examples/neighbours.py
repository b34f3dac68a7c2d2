# neighbours.py - powers of spheres by the models of other codes, beside those of fibrad. SPDX-License-Identifier: MIT
"""Run `python3 neighbours.py bed.dump ...`. fibrad is in the PATH, and NumPy is needed. Each bed stands in an insulated box,
so the powers of all spheres add up to 0. docs/beside.md says what the models and columns are."""
import subprocess
import sys

import numpy as np

SIGMA, EMISSIVITY, UNIT = 5.670374419e-8, 0.8, 0.01  # the file is in centimetres


def read(name):
    """Centres [m] and radii [m] of a dump with the columns id type x y z radius."""
    rows = np.loadtxt(name, skiprows=9, usecols=range(2, 6)) * UNIT
    return rows[:, :3], rows[:, 3]


def true_powers(x, r, T):
    """Powers [W] and their estimated errors by `fibrad heat`, in an insulated box that ends where the spheres end."""
    table = "x [m],y [m],z [m],r [m],T\n" + "\n".join(",".join(map(repr, row)) for row in np.c_[x, r, T].tolist())
    run = subprocess.run(["fibrad", "heat", "-", "--emissivity", str(EMISSIVITY), "--temperature", "T", "--wall",
                          f"box:insulated:emissivity={EMISSIVITY}", "--format", "csv", "-o", "-", "--quiet"],
                         input=table, stdout=subprocess.PIPE, text=True, check=True)
    rows = [line.split(",") for line in run.stdout.splitlines()[1:]]
    return np.array([row[2:4] for row in rows if int(row[0]) >= 0], float).T


def pair_factor(s):
    """View factor between two equal spheres alone, their centres s radii apart. It is the mean, over rings of one sphere, of
    the factor from a small plane to the other sphere. The horizon of the plane may cut this sphere."""
    u = 1 - (np.arange(2000) + 0.5) / 1000  # cosines of the rings
    h = np.sqrt(s * s + 1 - 2 * s * u)  # from a ring to the centre of the other sphere
    cos = (s * u - 1) / h
    sin, edge = np.sqrt(1 - cos**2), np.sqrt(h * h - 1)
    whole = np.clip(cos, 0, None) / h**2
    cut = h * np.abs(cos) < 1
    with np.errstate(all="ignore"):
        part = 0.5 - np.arcsin(edge / (h * sin)) / np.pi + (cos * np.arccos(-edge * cos / sin)
                                                            - edge * np.sqrt(1 - (h * cos) ** 2)) / (np.pi * h * h)
    return np.where(cut, part, whole).mean()


def models(x, r, T):
    """Yields for each model its name, the powers [W], and the largest sum of view factors of a sphere (0: it has none)."""
    A, E, D = 4 * np.pi * r**2, SIGMA * T**4, 2 * r.mean()
    distance = np.linalg.norm(x[:, None] - x, axis=2)
    np.fill_diagonal(distance, np.inf)
    s = np.linspace(2, 30, 300)
    F = np.interp(distance / np.sqrt(np.outer(r, r)), s, [pair_factor(one) for one in s])
    AF, ends = 4 * np.pi * np.outer(r, r) * F, (1 - EMISSIVITY) / EMISSIVITY / A
    for cutoff in 1.3, 1.5, 1.7, 2, 2.5:
        near = distance < cutoff * D
        alone = ~near.any(1)
        near[alone, alone] = True
        yield f"mean-T {cutoff}", EMISSIVITY * A * (SIGMA * (near @ T / near.sum(1)) ** 4 - E), 0
        yield f"mean-T4 {cutoff}", EMISSIVITY * A * (near @ (A * E) / (near @ A) - E), 0
        G = np.where(near, 1 / (ends[:, None] + ends + 1 / AF), 0)
        yield f"pairs {cutoff}", G @ E - G.sum(1) * E, ((near * AF).sum(1) / A).max()
    for size in 1.5, 3:
        _, index = np.unique((x - x.min(0)) // (size * D) @ [1, 1e3, 1e6], return_inverse=True)
        yield f"cells {size}", EMISSIVITY * A * (SIGMA * (np.bincount(index, T) / np.bincount(index))[index] ** 4 - E), 0


def compare(name):
    x, r = read(name)
    noise = 100 * (np.arange(len(x)) * 0.6180339887 % 1 - 0.5)
    height = (x[:, 2] - x[:, 2].min()) / np.ptp(x[:, 2])
    below, left = height < 0.5, x[:, 0] < np.median(x[:, 0])
    lines, sums = {}, {}
    for case, T, cold in ("gradient", 600 + 600 * height + noise, below), ("halves", np.where(left, 600.0, 1200.0), left):
        q, errors = true_powers(x, r, T)
        rms = np.sqrt(np.mean(q**2))
        print(f"{name} {case}: rms {rms:.3g} W, errors {np.sqrt(np.mean(errors**2)) / rms:.1%} of it")
        for model, found, sums[model] in models(x, r, T):
            off = found - q
            numbers = [np.sqrt(np.mean(off**2)) / rms, np.abs(off).max() / rms, found.sum() / np.abs(found).sum(),
                       found[cold].sum() / q[cold].sum()]
            lines[model] = lines.get(model, "  ") + "  " + "".join(f"{round(one, 2) + 0:7.2f}" for one in numbers)
    print(f"{'model d':14}    rms  worst    sum   cold      rms  worst    sum   cold   sum-F")
    for model, line in lines.items():
        print(f"{model:12}{line}" + (f"{sums[model]:8.2f}" if sums[model] else ""))


for name in sys.argv[1:]:
    compare(name)
