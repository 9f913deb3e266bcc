#!/usr/bin/python3
"""Runs what README and docs print, block by block, in the order of a page: blocks_test.py SOURCES BUILD [PAGE...]

The program is installed from BUILD into a folder of its own, whose `actformer` is on the PATH. A block of ```sh runs in bash, one of ```python in
Python, all in one folder, so that a page finds what those before it made; where the page prints what a block says (```text behind it), it must say that, `...` standing for anything. HTML comments before a block:

    <!-- not run: WHY -->                  it needs what no test has
    <!-- in tests: X -> Y; X -> Y -->      X is replaced, so that a test takes seconds; with --printed it is not
    <!-- before it: COMMAND -->            run before the block, for what a reader has already
    <!-- it says: TEXT -->                 it prints that, which the page does not show
    <!-- file: NAME -->                    the block is no command but a file

Other blocks without a language, of ```text or of ```bibtex are only shown. One of another language fails, for nobody would notice that it never ran.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
COMMENT = re.compile(r"<!--\s*(not run|in tests|before it|it says|file):\s*(.*?)-->", re.S)

FENCES = re.compile(r"^ *```", re.M)
SHOWN = ("", "text", "bibtex")
SHOWN_IN = {"docs/adding-a-method.md": ("cpp", "yaml")}  # method_test.py takes that page's method


class Block:
    """A fenced block of a page, and the comments before it."""

    def __init__(self, page, match, begin):
        self.page, self.language, self.text = page, match[1], match[2]
        self.line = match.string.count("\n", 0, match.start()) + 1
        self.notes = {kind: text.strip() for kind, text in COMMENT.findall(match.string[begin : match.start()])}
        self.expected = self.notes.get("it says")

    def command(self, printed):
        """What bash or Python is given."""
        text = self.text
        for change in () if printed else filter(None, self.notes.get("in tests", "").split(";")):
            old, new = (side.strip() for side in change.split("->"))
            if old not in text:
                raise SystemExit(f"{self.page}:{self.line}: 'in tests' replaces {old!r}, which the block does not have")
            text = text.replace(old, new)
        return text

    def says(self, output):
        """Whether `output` is what the page prints."""
        pattern = r".*?".join(re.escape(part.strip()) for part in self.expected.strip().split("..."))
        return re.search(pattern, output, re.S) is not None


def blocks_of(page, text):
    """The blocks that run, each with what it should print."""
    blocks, begin = [], 0
    if len(FENCES.findall(text)) != 2 * len(FENCE.findall(text)):
        raise SystemExit(f"{page}: fences that are none of this test's: ```LANGUAGE or ``` alone, at the begin of a line")
    for match in FENCE.finditer(text):
        block = Block(page, match, begin)
        begin = match.end()
        if "file" in block.notes:
            blocks.append(block)
        elif block.language == "text" and blocks:
            blocks[-1].expected = block.text
        elif block.language in ("sh", "python"):
            blocks.append(block)
        elif block.language not in (*SHOWN, *SHOWN_IN.get(page, ())) and "not run" not in block.notes:
            raise SystemExit(f"{page}:{block.line}: nothing runs a block of {block.language!r}; is it ```sh?")
    return blocks


def run(block, folder, environment, printed):
    """Runs a block, or writes the file that it is; ends the program where it fails or says something else than the page."""
    if "file" in block.notes:
        (pathlib.Path(folder) / block.notes["file"]).write_text(block.command(printed))
        return
    if "before it" in block.notes:
        subprocess.run(["bash", "-euo", "pipefail", "-c", block.notes["before it"]], cwd=folder, env=environment, check=True)
    program = ["bash", "-euo", "pipefail", "-c"] if block.language == "sh" else [sys.executable, "-c"]
    done = subprocess.run([*program, block.command(printed)], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    where = f"{block.page}:{block.line}"
    if done.returncode != 0:
        raise SystemExit(f"{where}: ends with {done.returncode}\n{done.stdout}")
    if block.expected is not None and not block.says(done.stdout):
        raise SystemExit(f"{where}: does not say\n{block.expected}\nbut\n{done.stdout}")


def check_page(page, sources, folder, environment, printed):
    """Runs a page; the number of blocks that ran."""
    ran = left = 0
    for block in blocks_of(page, (sources / page).read_text()):
        if "not run" in block.notes:
            left += 1
            continue
        run(block, folder, environment, printed)
        ran += 1
    if ran + left:
        print(f"{page}: {ran} blocks ran, {left} need what no test has")
    return ran


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sources", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path, help="where the program was built")
    parser.add_argument("pages", nargs="*")
    parser.add_argument("--printed", action="store_true", help="as printed: no shorter training")
    options = parser.parse_args()
    sources = options.sources.resolve()
    pages = options.pages or ["README.md", "examples/cmu/README.md", "weights/cmu/README.md", "python/README.md",
                              *sorted(f"docs/{page.name}" for page in (sources / "docs").glob("*.md"))]
    with tempfile.TemporaryDirectory(prefix="actformer-docs-") as folder, tempfile.TemporaryDirectory(prefix="actformer-installed-") as installed:
        subprocess.run(["cmake", "--install", options.build, "--prefix", installed], check=True, stdout=subprocess.DEVNULL)
        environment = dict(os.environ, PATH=f"{installed}/bin:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}", PYTHONPATH=str(sources / "python"))
        for name in ("examples", "model", "reports", "tests", "weights"):  # it looks like the repository's root, as far as pages name it
            (pathlib.Path(folder) / name).symlink_to(sources / name)
        (pathlib.Path(folder) / "build").symlink_to(options.build.resolve())
        if sum(check_page(page, sources, folder, environment, options.printed) for page in pages) == 0:
            raise SystemExit("no block ran")


if __name__ == "__main__":
    main()
