#!/usr/bin/python3
"""How long `actformer report` takes for a sweep of the paper's scale, and how large its page is: report_scale.py PROGRAM [--runs 60]

Makes up a sweep's folder: a third of the runs on 94 classes of one person, the others on 26 of two, 100 samples a class in 256
dimensions, 20 repeats, 500 epochs of log. Synthetic clips stand for the real side.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import time

import h5py
import numpy

KINDS = {"ntu-1p": 94, "ntu-2p": 26}


def write_features(path, classes, each, random):
    with h5py.File(path, "w") as file:
        n = classes * each
        file["features"] = random.standard_normal((n, 256), dtype="f4")
        file["logits"] = random.standard_normal((n, classes), dtype="f4")
        file["labels"] = numpy.repeat(numpy.arange(classes, dtype="u4"), each)


def write_motions(path, exported, classes, shift):
    """Four motions a class, each a window of some clip that `actformer export` wrote."""
    with h5py.File(exported) as clips, h5py.File(path, "w") as out:
        for key, value in clips.attrs.items():
            out.attrs[key] = value
        windows = [clip[..., :60] for clip in clips.values() if clip.shape[2] >= 60]
        for label in range(classes):
            for i in range(4):
                out[f"A{label + 1:03}_{i}"] = windows[(4 * label + i + shift) % len(windows)]


def scores(classes, random):
    def metric():
        values = random.uniform(1, 50, 20)
        return {"mean": float(values.mean()), "ci95": 1.0, "repeats": values.tolist()}

    names = ["fid_mean", "fid_whole", "fida_mean", "fida_whole", "diversity", "multimodality"]
    return {
        "accuracy": {"mean": 0.4, "ci95": 0.01, "repeats": random.uniform(0, 1, 20).tolist()},
        **{name: metric() for name in names},
        "real": {"samples": 40000, "accuracy": 0.8},
        "per_class": [{"class": f"class {c}", "label": c, "real": 400, "generated": 100, "accuracy": 0.4, "fid": 3.0,
                       "fida": None, "floor": 1.0} for c in range(classes)],
        "confusion": random.integers(0, 200, (classes, classes)).tolist(),
        "warnings": [],
    }


def write_log(path):
    lines = [{"epoch": e, "discriminator_loss": 1 / e, "generator_loss": 0.5, "accuracy": 0.3, "fid_whole": 9.0}
             for e in range(1, 501)]
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))


def make_sweep(program, folder, runs):
    random = numpy.random.default_rng(1)
    run = lambda *words: subprocess.run([program, *map(str, words)], check=True, capture_output=True)
    run("synth", "ntu", "-o", folder / "raw", "--clips", 960)
    run("ingest", "ntu", folder / "raw", "-o", folder / "data")
    rows = []
    for i in range(runs):
        kind = "ntu-1p" if i % 3 == 0 else "ntu-2p"
        classes, job = KINDS[kind], folder / "out" / f"job{i}"
        (job / "features").mkdir(parents=True)
        if not (folder / f"{kind}.h5").exists():
            run("export", folder / "data" / kind, "-o", folder / f"{kind}.h5")
            write_features(folder / f"{kind}-real.h5", classes, 40000 // classes, random)
        (job / "features" / "real.h5").symlink_to(folder / f"{kind}-real.h5")
        write_features(job / "features" / "generated.h5", classes, 100, random)
        write_motions(job / "motions.h5", folder / f"{kind}.h5", classes, i)
        (job / "scores.json").write_text(json.dumps(scores(classes, random)))
        write_log(job / "log.jsonl")
        rows.append({"name": f"run {i}", "status": "done", "fills": [], "dataset": kind, "split": "all",
                     "data": {"path": kind}, "settings": {"seed": str(i)},
                     "runs": [{"seed": i, "status": "done", "scores": f"job{i}/scores.json", "run": f"job{i}",
                               "features": f"job{i}/features", "motions": f"job{i}/motions.h5",
                               "recogniser": f"job{i % 3 == 0}", "dataset": str(folder / "data" / kind)}]})
    (folder / "out" / "results.json").write_text(json.dumps({"format": 1, "sweep": "scale", "rows": rows}))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--runs", type=int, default=60)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_sweep(options.program, folder, options.runs)
        page = folder / "report.html"
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            subprocess.run([options.program, "report", folder / "out", "-o", page], check=True, capture_output=True)
            seconds.append(time.perf_counter() - start)
        print(f"{options.runs} runs: {min(seconds):.2f} s, {page.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
