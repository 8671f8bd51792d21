"""Motions of the peg over the floor of the scene `corner`, as CSV files for the driver `replay`."""

from support import ROOT

SCENE = ROOT / "config/scenes/corner/scene.yaml"
# The peg stands on the floor when its origin is this high, m.
STANDING = 0.015
# A law whose force on a flat contact is stiffness times depth and nothing else.
PLAIN = {"law": "paper", "gains__damping": 0.0, "passivity__enabled": False}


def write(path, depth, seconds, rate):
    """The peg upright, `depth(t)` metres in the floor."""
    with path.open("w") as rows:
        print("t,x,y,z,qx,qy,qz,qw", file=rows)
        for i in range(int(seconds * rate)):
            print(f"{i / rate!r},-0.01,0.0,{STANDING - depth(i / rate)!r},0.0,0.0,0.0,1.0", file=rows)
    return path
