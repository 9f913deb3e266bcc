#!/usr/bin/env python3
"""Kills, floods, doubles and damages what actformer does, at random moments drawn from a seed.

Every command runs once undisturbed; what it makes then is what it must make after any disturbance and a run to the end:
  kills     SIGKILL, SIGTERM, SIGINT or SIGHUP at a random moment, several times, then the same command to its end
  disks     a file system with too little room; then the same command with enough of it (as root)
  doubles   the same command twice at once
  flips     one byte of what a command reads is changed: it is told, the file is made anew, or nothing comes of it

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

ENDED_BY = {signal.SIGKILL: -signal.SIGKILL} | {how: 128 + how for how in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)}

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
  b: {seeds: [5]}
"""


@dataclasses.dataclass
class Command:
    """Words with {out} for what it makes and {base} for what it reads; what it makes is compared without `apart`."""

    words: str
    out: str
    apart: tuple = ()  # names of files that hold times
    reads: tuple = ()  # patterns of files below {base}, of its own below {out}, or in the user's cache, for flips
    left: tuple = ()  # endings of what an unfinished run may leave beside `out`, for the next one
    in_background: bool = False  # its work goes on behind it, as jobs of Slurm's


TIMED = ("log.jsonl", "lock", "ingest.json", "results.json", "done.json", "job.json", "log.txt", "config.yaml", "slurm.json", "slurm.log",
         "slurm.txt")
DATASET = ("{base}/data/ntu-1p/dataset.json", "{base}/data/ntu-1p/shard-*.h5")
TRAINING = ("{out}/config.yaml", "{out}/log.jsonl", "{out}/checkpoint-*.h5", "{out}/weights-last.h5")
OF_RECOGNISER, OF_GENERATOR, MOTIONS = ("{base}/recogniser/weights-last.h5",), ("{base}/generator/weights-last.h5",), ("{base}/motions.h5",)
SWEPT = tuple("/jobs/*/" + name for name in ("scores.json", "run/config.yaml", "run/log.jsonl", "*.h5", "features/*.h5"))

COMMANDS = {
    "synth ntu": Command("synth ntu -o {out} --clips 60 --actions 6,8,9 --seed 1", "synthetic", TIMED, ("{out}/synth.json",)),
    "ingest ntu": Command("ingest ntu {base}/raw -o {out}", "data", TIMED, ("{out}/ingest.json", "{base}/raw/ORIGIN"), (".partial",)),
    "ingest bvh": Command("ingest bvh {base}/bvh -o {out} --name {{take}}A{{action}}", "frombvh", TIMED, ("{out}/ingest.json",),
                          (".partial",)),
    "ingest motions": Command("ingest motions {base}/clips.npz -o {out}", "frommotions", TIMED, ("{out}/ingest.json",), (".partial",)),
    "export h5": Command("export {base}/data/ntu-1p -o {out}", "clips.h5", (), DATASET),
    "export npz": Command("export {base}/data/ntu-1p -o {out}", "clips.npz", (), DATASET),
    "train recogniser": Command(
        "train recogniser -c {base}/recogniser.yaml --data {base}/data/ntu-1p -o {out}", "recogniser", TIMED, DATASET + TRAINING),
    "train generator": Command(
        "train generator -c {base}/generator.yaml --data {base}/data/ntu-1p -o {out}", "generator", TIMED, DATASET + TRAINING),
    "features": Command(
        "features --recogniser {base}/recogniser {base}/data/ntu-1p --split xsub/train --window 16 -o {out}",
        "features.h5", (), DATASET + OF_RECOGNISER),
    "generate": Command("generate --generator {base}/generator -o {out} --per-class 6 --threads 1", "motions.h5", (), OF_GENERATOR),
    "score": Command(
        "score --recogniser {base}/recogniser --real {base}/data/ntu-1p --split xsub/train --window 16 "
        "--generated {base}/motions.h5 -o {out}", "scores.json", (),
        DATASET + OF_RECOGNISER + MOTIONS + ("{cache}/actformer/features/*.h5",), (".work",)),
    "classify": Command("classify --recogniser {base}/recogniser {base}/data/ntu-1p --window 16 -o {out}", "classes.csv", (),
                        DATASET + OF_RECOGNISER),
    "compare": Command(
        "compare {base}/motions.h5 {base}/others.h5 --recogniser {base}/recogniser --real {base}/data/ntu-1p --split xsub/train "
        "--window 16 -o {out}", "comparison", TIMED + ("report.html",), DATASET + OF_RECOGNISER + MOTIONS),
    "report": Command("report {base}/sweep -o {out}", "report.html", (),
                      ("{base}/sweep/results.json",) + tuple("{base}/sweep" + name for name in SWEPT)),
    "render": Command("render {base}/motions.h5 --count 2 --size 60 -o {out}", "motions.gif", (), MOTIONS),
    "sweep": Command("sweep {base}/sweep.yaml -o {out} --jobs 2", "sweep", TIMED,
                     ("{out}/results.json", "{out}/jobs/*/done.json", "{out}/jobs/*/job.json") + tuple("{out}" + name for name in SWEPT)),
    "sweep --slurm": Command("sweep {base}/sweep.yaml -o {out} --slurm", "slurm", TIMED, ("{out}/slurm.json", "{out}/jobs/*/done.json"),
                             (), True),
}
TELLS = ("damaged", "changed since", "missing", "notice: ")  # words of those who leave something out or make it anew


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


def heed_signals():
    for how in (signal.SIGINT, signal.SIGHUP):
        signal.signal(how, signal.SIG_DFL)


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
        self.kinds = collections.Counter()  # of files that were flipped
        self.slurm = self.home / "slurm"
        bin = self.home / "bin"
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.home / "cache"), TMPDIR=str(self.home / "tmp"),
                                CHAOS_SLURM=str(self.slurm), PATH=f"{bin}:{os.environ['PATH']}")
        for folder in (self.home / "tmp", self.slurm, bin):
            folder.mkdir()
        for name in ("sbatch", "squeue"):
            (bin / name).symlink_to(pathlib.Path(__file__).resolve().parent / "slurm.py")

    def start(self, words, base=None, out=None, log=None):
        line = [self.program, *[w.format(base=base or self.base, out=out) for w in words.split()]]
        return subprocess.Popen(line, stdin=subprocess.DEVNULL, stdout=log or subprocess.DEVNULL, stderr=subprocess.STDOUT,
                                env=self.environment, preexec_fn=heed_signals)

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

    def jobs_in_slurm(self):
        return [p for p in self.slurm.iterdir() if p.name.isdigit() and not (self.slurm / f"{p.name}.ended").exists()]

    def wait_for_slurm(self):
        end = time.monotonic() + 600
        while self.jobs_in_slurm():
            if time.monotonic() > end:
                raise Failure("jobs in Slurm do not end")
            time.sleep(0.05)
        twice = self.slurm / "twice"
        if twice.exists():
            jobs = twice.read_text().split()
            twice.unlink()
            raise Failure(f"submitted while they waited or ran: {', '.join(jobs)}")

    def kill_in_slurm(self):
        """One of the jobs that run, and all its processes."""
        running = [p.read_text() for p in self.jobs_in_slurm()]
        if any(running):
            try:
                os.killpg(int(self.random.choice([r for r in running if r])), signal.SIGKILL)
            except ProcessLookupError:
                pass

    def must_do(self, name, base=None, out=None):
        """The command, and what it has others do; jobs behind those that were killed are dropped, and submitted again. Its own seconds."""
        command = COMMANDS[name]
        seconds = []
        for _ in range(3 if command.in_background else 1):
            start = time.monotonic()
            self.must_run(command.words, base, out)
            seconds.append(time.monotonic() - start)
            self.wait_for_slurm()
        return seconds[0]

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
            self.seconds[name] = self.must_do(name, out=self.base / command.out)
            made.add(name)

        make("ingest ntu")
        self.must_run("export {base}/data/ntu-1p -o {out} --format bvh", out=self.base / "bvh")
        for name in ("export npz", "export h5", "train recogniser", "train generator", "generate", "sweep", "sweep --slurm"):
            make(name)
        self.must_run(COMMANDS["generate"].words + " --seed 2", out=self.base / "others.h5")
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
        deep = [str(p) for p in folder.rglob("*.partial*")] if finished or not command.left else []
        if extra or deep:
            raise Failure(f"{name}: left behind: {', '.join(extra + deep)}")

    def finish(self, name, folder):
        out = folder / COMMANDS[name].out
        self.must_do(name, out=out)
        self.compare(name, out)
        self.nothing_left(name, folder, True)

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
            how = self.random.choice([signal.SIGKILL] * 3 + [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
            process.send_signal(how)
            if COMMANDS[name].in_background:
                time.sleep(self.random.uniform(0.5, 3))  # an sbatch may outlive who called it
                self.kill_in_slurm()
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
            if gentle and not name.startswith("sweep"):
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
            self.wait_for_slurm()
            self.table[name]["disks"] += 1
            if code == 0:
                if not COMMANDS[name].in_background:
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
        self.wait_for_slurm()
        self.compare(name, out)
        self.nothing_left(name, folder, True)
        shutil.rmtree(folder)

    def flips(self, name):
        command = COMMANDS[name]
        folder = self.place()
        out = folder / command.out
        pattern = self.random.choice(command.reads)
        root, below = pattern.split("/", 1)
        if root == "{out}":  # it has run before
            shutil.copytree(self.base / command.out, out)
        found = sorted({"{base}": self.base, "{out}": out, "{cache}": self.home / "cache"}[root].glob(below))
        if not found:
            raise Failure(f"{name}: there is no {pattern}")
        target = self.random.choice(found)
        whole = target.read_bytes()
        data = bytearray(whole)
        at = self.random.randrange(len(data))
        data[at] ^= 1 << self.random.randrange(8)
        where = f"byte {at} of {target.relative_to(folder if folder in target.parents else self.home)}"
        target.write_bytes(data)
        try:
            code, said = self.run(command.words, out=out)
            self.wait_for_slurm()
        finally:
            if root != "{out}":
                target.write_bytes(whole)
        self.table[name]["flips"] += 1
        self.kinds[pattern] += 1
        told = any(word in said for word in TELLS)
        wrong = differences(self.base / command.out, out, command.apart) if code == 0 else []
        wrong = [name for name in wrong if not name.endswith(".damaged")]  # what was set aside, and said so
        excused = any("notice: " in line and target.name in line for line in said.splitlines())
        if wrong and not excused:
            raise Failure(f"{name}: nothing said of {where}, and other results in {', '.join(wrong[:5])}")
        if code not in (0, 1) or code == 1 and not said.strip():
            raise Failure(f"{name}: exit code {code} for {where}: {said.strip()[-200:]}")
        self.table[name]["told" if code or wrong else "made anew" if told else "no effect"] += 1
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
        columns = ["kills", "SIGKILL", "SIGTERM", "SIGINT", "SIGHUP", "too late", "disks", "doubles", "flips", "told", "made anew", "no effect"]
        print(f"{'':<18}" + "".join(f"{c:>10}" for c in columns))
        sums = collections.Counter()
        for name in self.only:
            sums.update(self.table[name])
            print(f"{name:<18}" + "".join(f"{self.table[name][c]:>10}" for c in columns))
        print(f"{'all':<18}" + "".join(f"{sums[c]:>10}" for c in columns))
        if self.kinds:
            print("flips in " + ", ".join(f"{kind} {count}" for kind, count in sorted(self.kinds.items())))

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
        self.wait_for_slurm()
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
