#!/usr/bin/python3
"""The includes draw the picture of the README: rooms point downward only, and no folders point at each other in a circle.

usage: rooms_test.py SOURCE_FOLDER
"""
import collections, os, re, sys

# Lowest first. A file may include what stands in its own room or in one before it.
ROOMS = ["base", "kernels", "ingest", "eval", "reports", "model", "cli"]
# Neither of these knows the other.
APART = {("model", "reports"), ("reports", "model")}


def includes(root):
    """(file, included file) of every include of a file of the project."""
    for room in ROOMS:
        for folder, _, files in os.walk(os.path.join(root, room)):
            for name in files:
                if not name.endswith((".cpp", ".hpp")):
                    continue
                path = os.path.join(folder, name)
                with open(path, encoding="utf-8") as file:
                    for target in re.findall(r'^#include "([^"]+)"', file.read(), re.M):
                        yield os.path.relpath(path, root), target


def circle(edges):
    """A circle of folders, or none."""
    seen, path = {}, []

    def walk(node):
        seen[node] = "open"
        path.append(node)
        for other in sorted(edges[node]):
            if seen.get(other) == "open":
                return path[path.index(other):] + [other]
            if other not in seen and (found := walk(other)):
                return found
        seen[node] = "done"
        path.pop()
        return None

    for node in sorted(edges):
        if node not in seen and (found := walk(node)):
            return found
    return None


def main(root):
    faults, edges, why = [], collections.defaultdict(set), {}
    count = 0
    for file, target in includes(root):
        count += 1
        room, other = file.split("/")[0], target.split("/")[0]
        if other not in ROOMS:
            faults.append(f"{file} includes {target}, which is in no room")
            continue
        if ROOMS.index(other) > ROOMS.index(room) or (room, other) in APART:
            faults.append(f"{file} includes {target}: {room}/ may not know {other}/")
        here, there = os.path.dirname(file), os.path.dirname(target)
        # A folder and those inside it are one place: the seam stands in the outer folder, its kinds in the inner ones.
        if here != there and not here.startswith(there + "/") and not there.startswith(here + "/"):
            edges[here].add(there)
            why.setdefault((here, there), f"{file} includes {target}")
    if found := circle(edges):
        faults.append("folders in a circle: " + "; ".join(why[pair] for pair in zip(found, found[1:])))
    for fault in faults:
        print(fault)
    print(f"{count} includes, {len(edges)} folders, {len(faults)} faults")
    return 1 if faults or count < 100 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")))
