"""Compares trajectories as ASE reads them with what the system was when they were written."""

import json
import sys
from pathlib import Path

import ase.io
import numpy as np

# Numbers are written with nine digits.
TOLERANCE = 6e-9


def difference(read, written):
    """The largest difference relative to what was written."""
    read, written = np.asarray(read, float), np.asarray(written, float)
    assert read.shape == written.shape, f"{read.shape} instead of {written.shape}"
    return np.max(np.abs(read - written) / np.maximum(np.abs(written), 1e-300))


def check_frame(atoms, written, internal):
    assert list(atoms.pbc) == written["periodic"]
    assert atoms.get_chemical_symbols() == written["symbol"]
    assert list(atoms.cell.angles()) == [90, 90, 90]
    assert list(atoms.arrays["id"]) == written["id"]
    assert atoms.info["Step"] == written["step"]
    compared = {
        "cell": (atoms.cell.lengths(), written["lengths"]),
        "time": (atoms.info["Time"], written["time"]),
        "positions": (atoms.get_positions(), written["position"]),
        "velocities": (atoms.get_velocities(), written["velocity"]),
        "velo": (atoms.arrays["velo"], written["velocity"]),
        "masses": (atoms.get_masses(), written["mass"]),
    }
    for name in ("internal_energy", "temperature"):
        assert (name in atoms.arrays) == internal, name
        if internal:
            compared[name] = (atoms.arrays[name], written[name])
    for name, (read, right) in compared.items():
        # A velocity is the quotient of two rounded numbers.
        allowed = 2 * TOLERANCE if name == "velocities" else TOLERANCE
        found = difference(read, right)
        assert found <= allowed, f"{name} differs by {found}"


def check_file(folder, name, internal):
    written = json.loads((folder / f"{name}.json").read_text())
    frames = ase.io.read(folder / f"{name}.xyz", index=":")
    assert len(frames) == len(written) > 1
    for atoms, right in zip(frames, written):
        check_frame(atoms, right, internal)
    # The comparison sees one velocity that is another particle's.
    swapped = json.loads(json.dumps(written[0]))
    swapped["velocity"][3], swapped["velocity"][4] = swapped["velocity"][4], swapped["velocity"][3]
    try:
        check_frame(frames[0], swapped, internal)
    except AssertionError:
        return
    raise AssertionError("a wrong velocity was not seen")


check_file(Path(sys.argv[1]), "energies", internal=True)
check_file(Path(sys.argv[1]), "isothermal", internal=False)
check_file(Path(sys.argv[1]), "walls_and_species", internal=True)
