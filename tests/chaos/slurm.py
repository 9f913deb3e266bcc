#!/usr/bin/env python3
"""Stands for sbatch and squeue, by the name it is called by: a job runs at once in the background, behind those it depends on.

Below the folder CHAOS_SLURM lie files for each job: NUMBER, empty, then with the process that runs it; NUMBER.comment; NUMBER.needs, the jobs
it depends on; NUMBER.ended once it has, with its exit code. `twice` names the jobs that were submitted while they waited or ran. Python's standard library only.
"""

import contextlib
import fcntl
import os
import pathlib
import signal
import subprocess
import sys
import time

FOLDER = pathlib.Path(os.environ["CHAOS_SLURM"])


@contextlib.contextmanager
def one_at_a_time():
    with open(FOLDER / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def new_number():
    number = 1
    while True:
        try:
            (FOLDER / str(number)).touch(exist_ok=False)
            return number
        except FileExistsError:
            number += 1


def end(number, code):
    part = FOLDER / f"{number}.part"
    part.write_text(str(code))
    part.rename(FOLDER / f"{number}.ended")


def has_ended(number):
    return (FOLDER / f"{number}.ended").exists()


def comment_of(number):
    file = FOLDER / f"{number}.comment"
    return file.read_text() if file.exists() else ""


def alive():
    return [int(file.name) for file in FOLDER.iterdir() if file.name.isdigit() and not has_ended(file.name)]


def waits_in_vain(number):
    """It needs a job that failed, or one that does so."""
    return any((FOLDER / f"{need}.ended").read_text() != "0" if has_ended(need) else waits_in_vain(need) for need in needs_of(number))


def needs_of(number):
    file = FOLDER / f"{number}.needs"
    return file.read_text().split() if file.exists() else []


def work(number, needs, output, command):
    """Drops the job where one that it needs failed, as --kill-on-invalid-dep does."""
    while not all(has_ended(need) for need in needs):
        time.sleep(0.02)
    if any((FOLDER / f"{need}.ended").read_text() != "0" for need in needs):
        return end(number, 1)
    with open(output, "ab") as log:
        job = subprocess.Popen(["/bin/sh", "-c", command], stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
    (FOLDER / str(number)).write_text(str(job.pid))
    end(number, job.wait())


def admit(comment, needs):
    """The number of a new job."""
    with one_at_a_time():
        if any(comment_of(number) == comment and not waits_in_vain(number) for number in alive()):
            with open(FOLDER / "twice", "a") as twice:
                print(comment, file=twice)
        number = new_number()
        (FOLDER / f"{number}.needs").write_text(" ".join(needs))
        (FOLDER / f"{number}.comment").write_text(comment)
    return number


def sbatch(words):
    """The job does not end with who submits it, as Slurm's do not."""
    value = lambda option: words[words.index(option) + 1] if option in words else ""
    needs = value("--dependency").split(":")[1:]
    told, tell = os.pipe()
    if os.fork() == 0:
        os.setsid()
        number = admit(value("--comment"), needs)
        os.write(tell, str(number).encode())
        os.close(tell)
        for inherited in (0, 1, 2):
            os.dup2(os.open(os.devnull, os.O_RDWR), inherited)
        for stopped in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(stopped, signal.SIG_DFL)
        try:
            work(number, needs, value("--output"), value("--wrap"))
        except OSError:  # as where the disk of its output is full
            end(number, 1)
        os._exit(0)
    os.close(tell)
    print(os.read(told, 20).decode())


def squeue():
    with one_at_a_time():
        queue = alive()
    for number in queue:
        state = "R" if (FOLDER / str(number)).stat().st_size else "PD"
        print(number, state, "None", comment_of(number) or "(null)", sep="|")


if __name__ == "__main__":
    if pathlib.Path(sys.argv[0]).name == "sbatch":
        sbatch(sys.argv[1:])
    else:
        squeue()
