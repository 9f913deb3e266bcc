# The rooms' sources for clang-tidy: all of build/lint/compile_commands.json but tests, generated ones, and those that include libtorch,
# whose 1.13 headers are not C++20 to clang 14. Usage: lintable.py ROOT
import json
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
reaches = {}


def includes_torch(path):
    """Whether a file of the project includes libtorch, by itself or through others of the project."""
    if path not in reaches:
        reaches[path] = False  # a circle adds nothing
        names = re.findall(r'^#include ([<"])([^>"]+)[>"]', path.read_text(), re.M)
        reaches[path] = any(
            name.startswith(("torch/", "ATen/", "c10/")) if mark == "<" else
            (root / name).is_file() and includes_torch(root / name) for mark, name in names)
    return reaches[path]


for source in dict.fromkeys(pathlib.Path(entry["file"]) for entry in json.loads((root / "build/lint/compile_commands.json").read_text())):
    below = source.relative_to(root) if source.is_relative_to(root) else None
    if below and below.parts[0] not in ("tests", "build") and not includes_torch(source):
        print(below)
