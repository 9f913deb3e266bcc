#!/usr/bin/python3
"""Compiles the method that docs/adding-a-method.md adds, as a source of the room `model` is compiled: method_test.py SOURCES BUILD"""
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

sources, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
page = sources / "docs/adding-a-method.md"
files = dict(re.findall(r"^`(method\.[ch]pp)`:\n\n```cpp\n(.*?)^```$", page.read_text(), re.M | re.S))
if sorted(files) != ["method.cpp", "method.hpp"]:
    sys.exit(f"{page}: method.hpp and method.cpp expected, found {sorted(files)}")

commands = build / "compile_commands.json"
entries = [entry for entry in json.loads(commands.read_text()) if "/model.dir/" in entry["command"] and "cmake_pch.hxx.cxx" not in entry["file"]]
if not entries:
    sys.exit(f"{commands}: no source of the room model; is this a build with libtorch?")
like = max(entries, key=lambda entry: "cmake_pch" in entry["command"])  # with a precompiled header it takes seconds less
with tempfile.TemporaryDirectory() as folder:
    method = pathlib.Path(folder) / "model/generators/mean"
    method.mkdir(parents=True)
    for name, text in files.items():
        (method / name).write_text(text)
    words = [word for word in shlex.split(like["command"]) if word != like["file"]]
    at = words.index("-o")
    command = [*words[:at], *words[at + 2 :], f"-I{folder}", "-fsyntax-only", str(method / "method.cpp")]
    sys.exit(subprocess.run(command, cwd=like["directory"], check=False).returncode)
