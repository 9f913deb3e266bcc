# Lists what clang-tidy reads: of BUILD/compile_commands.json the rooms' sources, but no generated ones, no tests, and none that include
# libtorch, whose 1.13 headers are not C++20 to clang 14. Sources that are compiled together stay together, in pieces of their own below
# build/lint/pieces, with a compile_commands.json for them all and without GCC's precompiled headers. The longest come first.
# Usage: lintable.py ROOT BUILD
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


def of_a_room(source):
    return source.is_relative_to(root) and source.relative_to(root).parts[0] not in ("tests", "build")


def compiled(entry):
    """The sources of an entry: those of a piece, or itself."""
    path = pathlib.Path(entry["file"])
    if path.parent.name == "Unity":
        return [pathlib.Path(name) for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M)]
    return [path]


def piece(number, sources):
    """A source of its own, or a file that includes them all."""
    if len(sources) == 1:
        return sources[0]
    path = pieces / f"{number}.cpp"
    path.write_text("".join(f'#include "{source}"\n' for source in sources))
    return path


pieces = root / "build/lint/pieces"
pieces.mkdir(parents=True, exist_ok=True)
commands, sizes = [], {}
for number, entry in enumerate(json.loads((root / sys.argv[2] / "compile_commands.json").read_text())):
    sources = [source for source in compiled(entry) if of_a_room(source) and not includes_torch(source)]
    if sources and sources[0] not in sizes:
        path = piece(number, sources)
        command = re.sub(r"-Winvalid-pch|-include \S+/cmake_pch\.hxx", "", entry["command"])
        commands.append({**entry, "command": command.replace(entry["file"], str(path)), "file": str(path)})
        sizes[path] = len(sources)
(pieces / "compile_commands.json").write_text(json.dumps(commands))
for path in sorted(sizes, key=sizes.get, reverse=True):
    print(path)
