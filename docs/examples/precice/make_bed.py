"""Writes bed.csv with 152 spheres, and walls.stl, a closed tube of 24 sides with the solids tube, floor and lid. Lengths
are in metres."""
import math

SIDES, RINGS, RADIUS, HEIGHT = 24, 12, 0.055, 0.165


def corner(t, z):
    angle = 2 * math.pi * (t % SIDES) / SIDES
    return RADIUS * math.cos(angle), RADIUS * math.sin(angle), HEIGHT * z / RINGS


def write_solid(out, name, triangles):
    print("solid", name, file=out)
    for triangle in triangles:
        corners = "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in triangle)
        print(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet", file=out)
    print("endsolid", name, file=out)


with open("bed.csv", "w") as out:
    print("x [m],y [m],z [m],r [m]", file=out)
    for layer in range(8):
        for ring in range(3):
            for k in range(6 * ring or 1):
                angle, far = 2 * math.pi * k / (6 * ring or 1) + 0.4 * layer, 0.0205 * ring
                print(far * math.cos(angle), far * math.sin(angle), 0.0102 + 0.0205 * layer, 0.01, sep=",", file=out)
with open("walls.stl", "w") as out:
    write_solid(out, "tube", [triangle for z in range(RINGS) for t in range(SIDES)
                              for a, b, c, d in [(corner(t, z), corner(t + 1, z), corner(t, z + 1), corner(t + 1, z + 1))]
                              for triangle in ((a, c, b), (b, c, d))])
    for name, z in ("floor", 0), ("lid", RINGS):
        middle = (0.0, 0.0, HEIGHT * z / RINGS)
        write_solid(out, name, [(middle, corner(t, z), corner(t + 1, z)) for t in range(SIDES)])
