#!/usr/bin/env python3
"""Kills, floods, doubles and damages what actformer does, at random moments drawn from a seed.

Every command runs once undisturbed; what it makes then is what it must make after any disturbance and a run to the end:
  kills     SIGKILL, SIGTERM or SIGINT at a random moment, several times, then the same command to its end
  disks     a file system with too little room; then the same command with enough of it (as root)
  doubles   the same command twice at once
  flips     one byte of what a command reads is changed: it is told, or has no effect

Exit code 0 where nothing was wrong. Python's standard library only.
"""

import argparse
import collections
import dataclasses
import filecmp
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ENDED_BY = {signal.SIGKILL: -signal.SIGKILL, signal.SIGTERM: 128 + signal.SIGTERM, signal.SIGINT: 128 + signal.SIGINT}

RECOGNISER = """model: recogniser
width: 0.1
frames: 16
batch: 8
epochs: 4
rate_drops: []
train_split: xsub/train
test_split: xsub/test
seed: 4
threads: 1
checkpoint_minutes: 0
"""
GENERATOR = """model: actformer
frames: 16
width: 16
heads: 2
depth: 1
latent: 8
d_width: 2
batch: 8
epochs: 6
average: 0.9
train_split: xsub/train
seed: 4
threads: 1
checkpoint_minutes: 0
"""
SWEEP = """name: chaos
datasets:
  one: {path: %(base)s/data/ntu-1p}
recognisers:
  one: {data: one, config: recogniser.yaml, set: {epochs: 2}}
base: {data: one, recogniser: one, config: generator.yaml, split: xsub/train, repeats: 2, per_class: 2, set: {epochs: 3}}
rows:
  a: {fills: [table3/full/NTU-1P]}
  b: {set: {seed: 5}}
"""


@dataclasses.dataclass
class Command:
    """Words with {out} for what it makes and {base} for what it reads; what it makes is compared without `apart`."""

    words: str
    out: str
    apart: tuple = ()  # names of files that hold times
    reads: tuple = ()  # below {base}, for flips
    left: tuple = ()  # endings of what an unfinished run may leave beside `out`, for the next one


TIMED = ("log.jsonl", "lock", "ingest.json", "results.json", "done.json", "job.json", "log.txt", "config.yaml")

COMMANDS = {
    "ingest ntu": Command("ingest ntu {base}/raw -o {out}", "data", TIMED, ("raw",), (".partial",)),
    "ingest bvh": Command("ingest bvh {base}/bvh -o {out} --name {{take}}A{{action}}", "frombvh", TIMED, ("bvh",), (".partial",)),
    "ingest motions": Command("ingest motions {base}/clips.npz -o {out}", "frommotions", TIMED, (), (".partial",)),
    "export h5": Command("export {base}/data/ntu-1p -o {out}", "clips.h5", (), ("data/ntu-1p",)),
    "export npz": Command("export {base}/data/ntu-1p -o {out}", "clips.npz", (), ("data/ntu-1p",)),
    "train recogniser": Command(
        "train recogniser -c {base}/recogniser.yaml --data {base}/data/ntu-1p -o {out}", "recogniser", TIMED),
    "train generator": Command(
        "train generator -c {base}/generator.yaml --data {base}/data/ntu-1p -o {out}", "generator", TIMED),
    "features": Command(
        "features --recogniser {base}/recogniser {base}/data/ntu-1p --split xsub/train --window 16 -o {out}",
        "features.h5", (), ("data/ntu-1p", "recogniser/weights-last.h5")),
    "generate": Command("generate --generator {base}/generator -o {out} --per-class 6 --threads 1", "motions.h5", (),
                        ("generator/weights-last.h5",)),
    "score": Command(
        "score --recogniser {base}/recogniser --real {base}/data/ntu-1p --split xsub/train --window 16 "
        "--generated {base}/motions.h5 -o {out}", "scores.json", (), ("motions.h5",), (".work",)),
    "report": Command("report {base}/sweep -o {out}", "report.html", (), ()),
    "render": Command("render {base}/motions.h5 --count 2 --size 60 -o {out}", "motions.gif", (), ("motions.h5",)),
    "sweep": Command("sweep {base}/sweep.yaml -o {out} --jobs 2", "sweep", TIMED),
}
READERS = {  # what tells of a flip in which artefact, beside the commands that read it
    "data/ntu-1p": ("export h5", "features"),
    "motions.h5": ("score",),
    "generator/weights-last.h5": ("generate",),
    "recogniser/weights-last.h5": ("features",),
}


class Failure(Exception):
    """Something is not as it should be."""


def members(path, root):
    """What a JSON file says, but for the path of the folder that it lies in, and its checksum, which is of the path too."""
    read = json.loads(path.read_text().replace(str(root), "OUT"))
    if isinstance(read, dict):
        read.pop("checksum", None)
    return read


def differences(one, other, apart):
    """Names in which two files or folders differ, but for the folders' own paths."""
    one, other = pathlib.Path(one), pathlib.Path(other)

    def same(name):
        a, b = one / name, other / name
        if not a.is_file() or not b.is_file():
            return False
        return filecmp.cmp(a, b, shallow=False) or a.suffix == ".json" and members(a, one) == members(b, other)

    if one.is_file():
        return [] if other.is_file() and filecmp.cmp(one, other, shallow=False) else [other.name]
    names = {p.relative_to(root) for root in (one, other) for p in root.rglob("*") if p.is_file()}
    timed = [n for n in names if n.name in apart or n.name.startswith("checkpoint-")]
    return [str(n) for n in sorted(names - set(timed)) if not same(n)]


class Chaos:
    def __init__(self, options):
        self.program = str(pathlib.Path(options.program).resolve())
        self.random = random.Random(options.seed)
        self.end = time.monotonic() + options.seconds
        self.only = options.only.split(",") if options.only else list(COMMANDS)
        self.home = pathlib.Path(tempfile.mkdtemp(prefix="chaos-"))
        self.base = self.home / "base"
        self.table = collections.defaultdict(collections.Counter)
        self.seconds = {}  # within which a kill is likely to land
        self.failures = []
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.home / "cache"), TMPDIR=str(self.home / "tmp"))
        (self.home / "tmp").mkdir()

    def start(self, words, base=None, out=None, log=None):
        line = [self.program, *[w.format(base=base or self.base, out=out) for w in words.split()]]
        return subprocess.Popen(line, stdin=subprocess.DEVNULL, stdout=log or subprocess.DEVNULL, stderr=subprocess.STDOUT,
                                env=self.environment, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def run(self, words, base=None, out=None):
        """Exit code and what it said."""
        log = self.home / "log"
        with open(log, "wb") as file:
            code = self.start(words, base, out, file).wait()
        return code, log.read_text(errors="replace")

    def must_run(self, words, base=None, out=None):
        code, said = self.run(words, base, out)
        if code != 0:
            raise Failure(f"exit code {code}: {words}: {said.strip()[-300:]}")

    def prepare(self):
        """Every command undisturbed."""
        self.base.mkdir()
        (self.base / "recogniser.yaml").write_text(RECOGNISER)
        (self.base / "generator.yaml").write_text(GENERATOR)
        (self.base / "sweep.yaml").write_text(SWEEP % {"base": self.base})
        self.must_run("synth ntu -o {out} --clips 60 --actions 6,8,9 --seed 1", out=self.base / "raw")
        made = set()

        def make(name):
            command = COMMANDS[name]
            start = time.monotonic()
            self.must_run(command.words, out=self.base / command.out)
            self.seconds[name] = time.monotonic() - start
            made.add(name)

        make("ingest ntu")
        self.must_run("export {base}/data/ntu-1p -o {out} --format bvh", out=self.base / "bvh")
        for name in ("export npz", "export h5", "train recogniser", "train generator", "generate", "sweep"):
            make(name)
        for name in COMMANDS:
            if name not in made:
                make(name)

    def place(self):
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.home))
        return folder

    def compare(self, name, out):
        wrong = differences(self.base / COMMANDS[name].out, out, COMMANDS[name].apart)
        if wrong:
            raise Failure(f"{name}: other bytes in {', '.join(wrong[:5])}")

    def nothing_left(self, name, folder, finished):
        """No temporary file beside what was made; what an unfinished run keeps for the next one is its own."""
        command = COMMANDS[name]
        kept = {command.out} | (set() if finished else {command.out + e for e in command.left})
        extra = [p.name for p in folder.iterdir() if p.name not in kept]
        deep = [str(p) for p in folder.rglob("*.partial*") if not finished and not command.left or finished]
        if extra or deep:
            raise Failure(f"{name}: left behind: {', '.join(extra + deep)}")

    def finish(self, name, folder):
        out = folder / COMMANDS[name].out
        self.must_run(COMMANDS[name].words, out=out)
        self.compare(name, out)
        return out

    def kills(self, name):
        folder = self.place()
        out = folder / COMMANDS[name].out
        gentle = True
        for _ in range(self.random.randint(1, 4)):
            with open(self.home / "log", "wb") as log:
                process = self.start(COMMANDS[name].words, out=out, log=log)
            try:
                process.wait(self.random.uniform(0, self.seconds[name]))
            except subprocess.TimeoutExpired:
                pass
            how = self.random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
            process.send_signal(how)
            code = process.wait()
            if code == 0:
                self.table[name]["too late"] += 1
                self.seconds[name] *= 0.9
                continue
            if code not in (ENDED_BY[how], -how):
                said = (self.home / "log").read_text(errors="replace").strip()[-300:]
                raise Failure(f"{name}: exit code {code} after {how.name}: {said}")
            gentle = gentle and how != signal.SIGKILL
            self.table[name]["kills"] += 1
            self.seconds[name] *= 1.05
            self.table[name][how.name] += 1
            if gentle and name != "sweep":
                self.nothing_left(name, folder, False)
        self.finish(name, folder)
        shutil.rmtree(folder)

    def disks(self, name):
        folder = self.place()
        room = self.random.choice([64, 128, 256, 512, 1024])  # kB
        mount = lambda options: subprocess.run(
            ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], capture_output=True).returncode == 0
        if not mount(f"size={room}k"):
            return
        try:
            out = folder / COMMANDS[name].out
            code, said = self.run(COMMANDS[name].words, out=out)
            self.table[name]["disks"] += 1
            if code == 0:
                self.compare(name, out)
            elif code != 1 or not said.strip():
                raise Failure(f"{name}: exit code {code} on a disk of {room} kB: {said.strip()[-300:]}")
            subprocess.run(["mount", "-o", "remount,size=512m", str(folder)], check=True)
            self.finish(name, folder)
        finally:
            subprocess.run(["umount", str(folder)], check=True)
        shutil.rmtree(folder)

    def doubles(self, name):
        folder = self.place()
        out = folder / COMMANDS[name].out
        logs = [self.home / "log1", self.home / "log2"]
        files = [open(log, "wb") for log in logs]
        first = self.start(COMMANDS[name].words, out=out, log=files[0])
        time.sleep(self.random.uniform(0, 0.3) * self.random.choice([0, 1]) * self.seconds[name])
        second = self.start(COMMANDS[name].words, out=out, log=files[1])
        codes = [first.wait(), second.wait()]
        for file in files:
            file.close()
        self.table[name]["doubles"] += 1
        if 0 not in codes or not set(codes) <= {0, 1}:
            raise Failure(f"{name}: twice at once ended with {codes}: " +
                          " | ".join(log.read_text(errors="replace").strip()[-200:] for log in logs))
        self.compare(name, out)
        shutil.rmtree(folder)

    def flips(self, name):
        reads = [r for r in COMMANDS[name].reads if r in READERS]
        if not reads:
            return
        folder = self.place()
        base = folder / "base"
        shutil.copytree(self.base, base, ignore=shutil.ignore_patterns("raw", "bvh", "sweep", "frombvh", "frommotions"))
        target = base / self.random.choice(reads)
        if target.is_dir():
            target = self.random.choice(sorted(p for p in target.rglob("*") if p.is_file() and p.name != "lock"))
        data = bytearray(target.read_bytes())
        at = self.random.randrange(len(data))
        data[at] ^= 1 << self.random.randrange(8)
        target.write_bytes(data)
        out = folder / COMMANDS[name].out
        code, said = self.run(COMMANDS[name].words, base, out)
        self.table[name]["flips"] += 1
        if code == 0:
            wrong = differences(self.base / COMMANDS[name].out, out, COMMANDS[name].apart)
            if wrong:
                raise Failure(f"{name}: nothing said of byte {at} of {target.relative_to(base)}, and other results")
            self.table[name]["no effect"] += 1
        elif code == 1 and said.strip():
            self.table[name]["told"] += 1
        else:
            raise Failure(f"{name}: exit code {code} for byte {at} of {target.relative_to(base)}: {said.strip()[-200:]}")
        shutil.rmtree(folder)

    def disturb(self):
        name = self.random.choice(self.only)
        what = self.random.choices([self.kills, self.disks, self.doubles, self.flips], [6, 1, 1, 2])[0]
        if what == self.disks and os.geteuid() != 0:
            what = self.kills
        self.attempt(what, name)

    def attempt(self, what, name):
        try:
            what(name)
        except Failure as failure:
            self.failures.append(f"{what.__name__}: {failure}")
            print(f"WRONG {self.failures[-1]}", flush=True)

    def print_table(self):
        columns = ["kills", "SIGKILL", "SIGTERM", "SIGINT", "too late", "disks", "doubles", "flips", "told", "no effect"]
        print(f"{'':<18}" + "".join(f"{c:>10}" for c in columns))
        sums = collections.Counter()
        for name in self.only:
            sums.update(self.table[name])
            print(f"{name:<18}" + "".join(f"{self.table[name][c]:>10}" for c in columns))
        print(f"{'all':<18}" + "".join(f"{sums[c]:>10}" for c in columns))

    def kill_each(self, count):
        """Until so many kills have landed in each command."""
        for name in self.only:
            while self.table[name]["kills"] < count and len(self.failures) < 20:
                self.attempt(self.kills, name)
            print(f"{name}: {self.table[name]['kills']} kills landed", flush=True)

    def run_all(self, kills):
        start = time.monotonic()
        self.prepare()
        print(f"every command once: {sum(self.seconds.values()):.0f} s", flush=True)
        if kills:
            self.kill_each(kills)
        else:
            while time.monotonic() < self.end:
                self.disturb()
        print(f"{time.monotonic() - start:.0f} s")
        self.print_table()
        temporary = list((self.home / "tmp").iterdir())
        print(f"{len(self.failures)} wrong; {len(temporary)} temporary folders of killed commands wait for the next one")
        for failure in self.failures:
            print(f"  {failure}")
        shutil.rmtree(self.home)
        return 1 if self.failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seconds", nargs="?", type=float, default=600, help="how long, every command's first run included")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 32))
    parser.add_argument("--program", default="build/actformer")
    parser.add_argument("--kills", type=int, help="instead: until so many kills have landed in each command, however long it takes")
    parser.add_argument("--only", help="these commands, as in 'score,ingest ntu'")
    options = parser.parse_args()
    length = f"{options.kills} kills a command" if options.kills else f"{options.seconds:.0f} s"
    print(f"seed {options.seed}, {length}", flush=True)
    sys.exit(Chaos(options).run_all(options.kills))


if __name__ == "__main__":
    main()
