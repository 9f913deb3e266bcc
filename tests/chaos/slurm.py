#!/usr/bin/env python3
"""Stands for sbatch and squeue, by the name it is called by: a job runs at once in the background, behind those it depends on.

Below the folder CHAOS_SLURM lies a file for each job: NUMBER, empty, then with the process that runs it; NUMBER.ended once it has, with its
exit code. Python's standard library only.
"""

import os
import pathlib
import signal
import subprocess
import sys
import time

FOLDER = pathlib.Path(os.environ["CHAOS_SLURM"])


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


def sbatch(words):
    value = lambda option: words[words.index(option) + 1] if option in words else ""
    needs = value("--dependency").split(":")[1:]
    number = new_number()
    if os.fork() == 0:
        os.setsid()
        for inherited in (0, 1, 2):
            os.dup2(os.open(os.devnull, os.O_RDWR), inherited)
        for stopped in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(stopped, signal.SIG_DFL)
        try:
            work(number, needs, value("--output"), value("--wrap"))
        except OSError:  # as where the disk of its output is full
            end(number, 1)
        os._exit(0)
    print(number)


def squeue():
    for file in FOLDER.iterdir():
        if file.name.isdigit() and not has_ended(file.name):
            print(file.name, "R" if file.stat().st_size else "PD", "None")


if __name__ == "__main__":
    if pathlib.Path(sys.argv[0]).name == "sbatch":
        sbatch(sys.argv[1:])
    else:
        squeue()
