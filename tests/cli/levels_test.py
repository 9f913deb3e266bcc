# The builds for levels of x86-64 that lie beside a program say the same: losses and motions of each, by ACTFORMER_ISA, beside the
# least one's. Usage: levels_test.py PROGRAM
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "build"))
from compare_motions import TOLERANCE, motions

program = pathlib.Path(sys.argv[1]).resolve()
root = pathlib.Path(__file__).resolve().parents[2]
flags = set(pathlib.Path("/proc/cpuinfo").read_text().split("flags", 1)[1].split("\n", 1)[0].split())
needs = {"v2": {"sse4_2", "popcnt"}, "v3": {"avx2", "fma", "bmi2"}, "v4": {"avx512bw", "avx512cd", "avx512dq", "avx512vl"}}
methods = ("actformer", "actor", "action2motion", "csgn")


def run(folder, words, level=None, refused=False):
    environment = {name: value for name, value in os.environ.items() if name not in ("ACTFORMER_ISA", "OPENBLAS_CORETYPE")}
    if level:
        environment["ACTFORMER_ISA"] = level
    done = subprocess.run([program, *words.split()], cwd=folder, env=environment, capture_output=True, text=True)
    assert (done.returncode != 0) == refused, f"{level}: {words}: {done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def losses(folder, run_of):
    lines = [json.loads(line) for line in (folder / run_of / "log.jsonl").read_text().splitlines()]
    return numpy.array([[value for name, value in sorted(line.items()) if "loss" in name] for line in lines])


def far(name, level, value, least, tolerance):
    apart = numpy.abs(value - least).max() / max(1, numpy.abs(least).max())
    print(f"{level}: {name}: {apart:.1e} of the least build's (at most {tolerance:.0e})")
    assert value.size and apart <= tolerance


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    run(folder, "synth ntu -o raw --clips 60 --actions 9,10 --seed 1")
    run(folder, "ingest ntu raw -o ntu")
    found = {}
    for level in ("v2", "v3", "v4"):
        if not needs[level] <= flags:
            print(f"{level}: skipped, this processor cannot run it")
            assert "this processor cannot run that" in run(folder, "model actformer-small --data ntu/ntu-1p", level, refused=True)
            continue
        run(folder, f"generate --generator {root}/weights/cmu/actformer.h5 --per-class 2 --seed 1 -o {level}.h5", level)
        for method in methods:
            run(folder, f"train generator -c {method}-small.yaml --data ntu/ntu-1p -o {method}-{level} epochs=2 batch=30 train_split=all", level)
        found[level] = {"motions": motions(folder / f"{level}.h5"), **{method: losses(folder, f"{method}-{level}") for method in methods}}
    least = found["v2"]
    # Of losses after four steps, in which Adam makes whole updates of gradients that are next to nothing. Sixteen steps of an adversarial
    # training are 2e-3 apart already.
    for level, values in found.items():
        for name, value in values.items():
            far(name, level, value, least[name], TOLERANCE if name == "motions" else 1e-2)
    assert "there is no such build" in run(folder, "model actformer-small --data ntu/ntu-1p", "v9", refused=True)
