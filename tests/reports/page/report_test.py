#!/usr/bin/python3
"""Opens a report in a real browser and uses it as a reader does: report_test.py REPORT.html [--comparison] [--screenshots DIR].

One line a check. Exit 0: all hold; 1: one does not, named on the last line; 77: there is no browser to ask.
"""

import argparse
import hashlib
import json
import pathlib
import re
import sys
import time

from browser import Browser, available

NUMBER = re.compile(r"^[-−]?\d+(\.\d+)?$")
PRINTED = re.compile(r"^(not at hand|[-−]?\d+(\.\d+)?( ± \d+(\.\d+)?)?)$")
STATES = ("not run", "failed", "not finished", "not measured")


class Failed(AssertionError):
    """What a check found wrong."""


def expect(condition, words):
    if not condition:
        raise Failed(words)


def choose(browser, select, value):
    browser.run("""const select = document.getElementById(arguments[0]);
        select.value = arguments[1];
        select.dispatchEvent(new Event("change"));""", select, value)


def settled(browser):
    """Waits until what was asked for has been drawn."""
    browser.run("window.settled = false; requestAnimationFrame(() => requestAnimationFrame(() => window.settled = true))")
    expect(browser.wait("return window.settled"), "the browser draws no frames")


def pixels(browser):
    """A digest of what the canvas shows."""
    settled(browser)
    return hashlib.sha256(browser.run("return document.getElementById('viewer').toDataURL()").encode()).hexdigest()


def differs(browser, before, seconds=5):
    """Whether the canvas comes to show something else than `before`."""
    end = time.monotonic() + seconds
    while pixels(browser) == before:
        if time.monotonic() > end:
            return False
    return True


def frame(browser):
    return int(browser.run("return document.getElementById('scrub').value"))


def focus(browser, selector):
    browser.run("document.querySelector(arguments[0]).focus()", selector)


def run_with(browser, what, condition):
    """Chooses the first run for which `condition`, an expression of a row, holds; None without one."""
    index = browser.run(f"""const report = JSON.parse(document.getElementById("data").textContent);
        return report.rows.findIndex((row) => {condition});""")
    if index < 0:
        print(f"skip: no run {what}")
        return None
    choose(browser, "run", str(index))
    settled(browser)
    return index


def run_with_motions(browser):
    """Chooses a run with motions of at least two frames."""
    return run_with(browser, "has motions", """row.motions &&
        (report.motion_sets[row.motions.generated] ?? []).some((m) => m.frames > 8)""")


# --- Checks, in the order in which they run ---------------------------------------------------------


def check_hostile_names(browser):
    """names are text: no script element beyond the template's, none of the names' code ran"""
    for run in range(browser.run("return document.getElementById('run').length")):
        choose(browser, "run", str(run))
        for action in ("-1", "0"):
            choose(browser, "action", action)
        found = browser.run("""return {
            scripts: document.scripts.length, hostile: typeof window.hostile,
            foreign: document.querySelectorAll("main img, main script, main iframe, main object").length,
            handlers: [...document.querySelectorAll("*")].filter((e) =>
                [...e.attributes].some((a) => a.name.startsWith("on"))).length }""")
        expect(found["scripts"] == 2, f"run {run}: {found['scripts']} script elements in place of 2")
        expect(found["hostile"] == "undefined", f"run {run}: code inside a name has run")
        expect(found["foreign"] == 0 and found["handlers"] == 0, f"run {run}: markup inside a name came alive")
    names = browser.run("""const report = JSON.parse(document.getElementById("data").textContent);
        return [report.rows.map((row) => row.name), [...document.getElementById("run").options].map((o) => o.text)]""")
    for name, shown in zip(*names):
        expect(" ".join(shown.split()).startswith(" ".join(name.split())), f"run {name!r} is listed as {shown!r}")


def check_tables(browser):
    """five tables, every row as long as the head, every cell a number or its state"""
    tables = browser.run("""return [1, 2, 3, 4, 5].map((n) => {
        const section = document.querySelector(`section.table#table${n}`);
        if (!section) return null;
        const span = (row) => [...row.cells].reduce((sum, cell) => sum + cell.colSpan, 0);
        return { columns: span(section.querySelector("thead tr")), rows: [...section.querySelectorAll("tbody tr")].map(
            (row) => ({ name: row.cells[0].textContent, span: span(row), cells: [...row.querySelectorAll("td")].map((td) => ({
                value: td.querySelector(".value")?.textContent.trim() ?? td.firstChild?.textContent.trim() ?? "",
                paper: td.querySelector(".paper")?.textContent.trim() ?? null })) })) };
    })""")
    for number, table in enumerate(tables, 1):
        expect(table is not None, f"table {number} is missing")
        expect(table["rows"], f"table {number} has no rows")
        for row in table["rows"]:
            where = f"table {number}, {row['name']}"
            expect(row["span"] == table["columns"], f"{where}: {row['span']} cells for {table['columns']} columns")
            for cell in row["cells"]:
                expect(NUMBER.match(cell["value"]) or cell["value"] in STATES, f"{where}: a cell says {cell['value']!r}")
                expect(cell["paper"] is None or PRINTED.match(cell["paper"]), f"{where}: paper's figure {cell['paper']!r}")


def check_tips(browser):
    """tab reaches a measured cell, and its tip becomes visible inside the window"""
    if not browser.run("return document.querySelectorAll('td.measured').length"):
        print("skip: nothing was measured")
        return
    browser.run("""window.scrollTo(0, 0); document.activeElement.blur();
        getSelection().removeAllRanges();""")
    for _ in range(40):
        browser.press("tab")
        if browser.run("return document.activeElement.matches('td.measured')"):
            break
    else:
        raise Failed("40 tabs reach no measured cell")
    for where in ("first", "last"):
        if where == "last":
            browser.run("[...document.querySelectorAll('td.measured[tabindex]')].at(-1).focus()")
        tip = browser.run("""const tip = document.activeElement.querySelector(".tip"), box = tip.getBoundingClientRect();
            const at = (x, y) => { tip.style.pointerEvents = "auto"; const hit = document.elementFromPoint(x, y);
                tip.style.pointerEvents = ""; return tip.contains(hit); };
            return { words: tip.innerText.trim().length, left: box.left, right: box.right, width: innerWidth, top: box.top,
                seen: at(box.left + 6, box.top + 6) && at(box.right - 6, box.bottom - 6) }""")
        expect(tip["words"] > 0, f"the {where} measured cell's tip says nothing or is not shown")
        expect(tip["left"] >= 0 and tip["right"] <= tip["width"], f"the {where} measured cell's tip lies outside the window")
        expect(tip["seen"], f"the {where} measured cell's tip is covered or cut off")
    browser.press("escape")
    expect(browser.run("return [...document.querySelectorAll('.tip')].every((t) => !t.matches('td:focus > *'))"),
           "escape does not take the tip away")


def check_play(browser):
    """play changes the picture, pause stops it, a paused picture stays"""
    if run_with_motions(browser) is None:
        return
    before = pixels(browser)
    expect(pixels(browser) == before, "the picture moves before anyone presses play")
    start = frame(browser)
    browser.click("#play")
    expect(browser.wait("return document.getElementById('scrub').value != arguments[0]", str(start)),
           "play does not move the slider")
    expect(differs(browser, before), "play does not change the picture")
    browser.click("#play")
    paused = pixels(browser)
    time.sleep(0.3)
    expect(pixels(browser) == paused, "pause does not stop the picture")


def check_keys(browser):
    """the keyboard alone plays, pauses, steps by one frame, orbits, zooms, resets and changes the action"""
    if run_with_motions(browser) is None:
        return
    focus(browser, "#viewer")
    browser.press("space")
    expect(browser.run("return document.getElementById('play').getAttribute('aria-pressed')") == "true", "space does not play")
    browser.press("space")
    expect(browser.run("return document.getElementById('play').getAttribute('aria-pressed')") == "false", "space does not pause")
    browser.run("""const scrub = document.getElementById("scrub"); scrub.value = 3; scrub.dispatchEvent(new Event("input"));""")
    settled(browser)
    for key, wanted in (("right", 4), ("left", 3)):
        before = pixels(browser)
        browser.press(key)
        settled(browser)
        expect(frame(browser) == wanted, f"{key}: frame {frame(browser)} in place of {wanted}")
        expect(pixels(browser) != before, f"{key}: the picture stays the same")
    still = pixels(browser)
    for words, keys, held in (("shift and right", ["right"], "shift"), ("shift and up", ["up"], "shift"), ("plus", ["+"], None)):
        before = pixels(browser)
        browser.press(*keys, held=held)
        expect(pixels(browser) != before, f"{words} does not change the view")
    expect(frame(browser) == 3, "orbiting moves the clock")
    browser.press("home")
    expect(pixels(browser) == still, "home does not bring the first view back")
    check_action_keys(browser)


def check_action_keys(browser):
    count = browser.run("return document.getElementById('action').length")
    if count < 2:
        return
    action = "return document.getElementById('action').value"
    choose(browser, "action", "-1")
    focus(browser, "#viewer")
    browser.press("]")
    expect(browser.run(action) == "0", "] does not go to the first action")
    browser.press("[")
    expect(browser.run(action) == "-1", "[ does not go back")


def check_drag(browser):
    """dragging orbits, a double click brings the view back"""
    if run_with_motions(browser) is None:
        return
    browser.run("document.getElementById('viewer').scrollIntoView({ block: 'center' })")
    before = pixels(browser)
    browser.drag("#viewer", 120, 20)
    expect(pixels(browser) != before, "dragging does not change the view")
    browser.run("document.getElementById('viewer').dispatchEvent(new MouseEvent('dblclick', { bubbles: true }))")
    expect(pixels(browser) == before, "a double click does not bring the first view back")


def drawn_bands(browser, action):
    """What the viewer shows of an action: [{heading, right, picture, cells: [{title, x}]}], from the top down."""
    browser.run("""const context = document.getElementById("viewer").getContext("2d");
        window.words = [];
        context.fillText = function (words, x, y, ...rest) {
            window.words.push({ words, x, y, right: x + this.measureText(words).width, heading: this.textAlign === "left" });
            CanvasRenderingContext2D.prototype.fillText.call(this, words, x, y, ...rest);
        };""")
    choose(browser, "action", action)
    settled(browser)
    words = browser.run("""const canvas = document.getElementById("viewer");
        delete canvas.getContext("2d").fillText;
        const dense = canvas.width / canvas.clientWidth, all = window.words.sort((a, b) => a.y - b.y || a.x - b.x);
        const picture = (from, to) => {
            const part = document.createElement("canvas");
            part.width = canvas.width;
            part.height = (to - from) * dense;
            part.getContext("2d").drawImage(canvas, 0, -from * dense);
            return part.toDataURL(); };
        return all.map((one) => {
            const end = all.find((other) => other.y > one.y)?.y;
            return { ...one, picture: one.heading && end ? picture(one.y + 12, end - 12) : "" }; })""")
    bands = []
    for one in words:
        if one["heading"]:
            if not bands or bands[-1]["y"] != one["y"]:  # drawn twice where a width has just changed
                bands.append({"heading": one["words"], "y": one["y"], "right": one["right"], "picture": one["picture"], "cells": []})
        elif {"title": one["words"], "x": one["x"]} not in bands[-1]["cells"]:
            bands[-1]["cells"].append({"title": one["words"], "x": one["x"]})
    return bands


def check_bands(browser):
    """real and generated motions stand one under the other; of a comparison real ones, A's and B's, the same clips in a column"""
    if run_with_motions(browser) is None:
        return
    names = browser.run("""return JSON.parse(document.getElementById("data").textContent).rows.map((row) => row.name)""")
    wanted = ["Real", *names] if browser.comparison else ["Real", "Generated"]
    for action in ("-1", "0"):
        bands = drawn_bands(browser, action)
        expect([band["heading"] for band in bands] == wanted, f"bands {[band['heading'] for band in bands]} in place of {wanted}")
        for band in bands:
            expect([cell["x"] for cell in band["cells"]] == [cell["x"] for cell in bands[0]["cells"]],
                   f"{band['heading']}: motions stand elsewhere than the real ones")
        told = browser.run("return document.getElementById('viewer').getAttribute('aria-label')")
        expect(all(name in told for name in wanted[1:] if browser.comparison), f"who does not see it is told {told!r}")
    if browser.comparison:
        real, a, b = bands
        expect([cell["title"] for cell in a["cells"]] == [cell["title"] for cell in b["cells"]], "B's clips are not A's")
        expect(len({real["picture"], a["picture"], b["picture"]}) == 3, "two bands show the same motions")
        check_narrow_bands(browser, wanted)


def check_narrow_bands(browser, wanted):
    """Below 560 pixels two clips of each band come first, then the other two; headings end in the picture."""
    browser.resize(400, 900)
    settled(browser)
    bands = drawn_bands(browser, "0")
    expect(len(bands) == 2 * len(wanted), f"{len(bands)} bands in a narrow window in place of {2 * len(wanted)}")
    for name, band in zip(wanted * 2, bands):
        shown = band["heading"].removesuffix("…")
        expect(name.startswith(shown) and len(shown) > 3, f"in a narrow window {name!r} is headed {band['heading']!r}")
        expect(band["right"] < 400 and len(band["cells"]) == 2, f"in a narrow window {name} has {len(band['cells'])} columns")
    browser.resize(1280, 1000)
    settled(browser)


def check_panels(browser):
    """another run and another action change the panels; a run without anything says so"""
    words = "return document.getElementById('panels').innerText"
    seen = {}
    for run in range(browser.run("return document.getElementById('run').length")):
        choose(browser, "run", str(run))
        settled(browser)
        name = browser.run("return JSON.parse(document.getElementById('data').textContent).rows[arguments[0]].name", run)
        expect(browser.run("return document.getElementById('run-name').textContent") == name, f"run {run} is not named")
        seen[run] = browser.run(words)
        empty = browser.run("""return ["bars", "matrix", "curves", "scatter"].filter(
            (id) => !document.getElementById(id).textContent.trim())""")
        expect(not empty, f"run {run}: {', '.join(empty)} shows nothing and says nothing")
    expect(len(set(seen.values())) == len(seen), "two runs show the same")
    if run_with_motions(browser) is None:
        return
    action = browser.run("""const report = JSON.parse(document.getElementById("data").textContent);
        const row = report.rows[document.getElementById("run").value];
        return report.motion_sets[row.motions.generated].at(-1).label""")
    before = pixels(browser)
    choose(browser, "action", str(action))
    expect(pixels(browser) != before, "another action shows the same motions")
    expect(browser.run("return document.querySelectorAll('.bars .chosen').length") == 1
           or browser.run("return !document.querySelector('.bars')"), "the action is not marked among the bars")


def check_matrix(browser):
    """pointing at a cell of the confusion matrix, and arrow keys, tell its counts"""
    if run_with(browser, "has a confusion matrix", "(row.confusion ?? []).length > 1") is None:
        return
    readout = "return document.querySelector('#matrix .readout').textContent"
    focus(browser, "#matrix .chart")
    browser.press("right", "left")
    wanted = browser.run("""const report = JSON.parse(document.getElementById("data").textContent);
        const line = report.rows[document.getElementById("run").value].confusion[0];
        return `${line[0]} of ${line.reduce((a, b) => a + b, 0)}`""")
    told = browser.run(readout)
    expect(told.startswith("asked for ") and told.endswith(": " + wanted), f"the first cell reads {told!r}, not {wanted!r}")
    browser.press("down")
    expect(browser.run(readout) != told, "the arrow keys do not step through the matrix")


def check_themes(browser):
    """the theme buttons change the background, and automatic follows the system"""
    background = "return getComputedStyle(document.body).backgroundColor"
    seen = {}
    for theme in ("light", "dark"):
        browser.click(f"[data-set-theme={theme}]")
        seen[theme] = browser.run(background)
    expect(seen["light"] != seen["dark"], "light and dark have one background")
    browser.click("[data-set-theme=auto]")
    for theme in ("dark", "light"):
        browser.command("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": theme}]})
        expect(browser.run(background) == seen[theme], f"automatic does not follow a {theme} system")


def check_widths(browser):
    """nothing is wider than the window, at 1280 and at 400 pixels"""
    for width in (1280, 400):
        browser.resize(width, 900)
        for run in range(browser.run("return document.getElementById('run').length")):
            choose(browser, "run", str(run))
            settled(browser)
            wide = browser.run("""const scrolls = (e) => { for (; e && e !== document.body; e = e.parentElement)
                    if (/auto|scroll|hidden/.test(getComputedStyle(e).overflowX)) return true; return false; };
                return [document.documentElement.scrollWidth, ...[...document.querySelectorAll("body *")].filter((e) => {
                    const box = e.getBoundingClientRect();
                    return box.width > 0 && box.right > innerWidth + 1 && !scrolls(e.parentElement) && !e.closest("svg svg, svg *, .skip");
                }).map((e) => `${e.tagName.toLowerCase()}.${e.getAttribute("class") ?? e.id}`)]""")
            expect(wide[0] <= width, f"at {width} pixels, run {run}, the page scrolls sideways ({wide[0]})")
            expect(len(wide) == 1, f"at {width} pixels, run {run}: {', '.join(wide[1:4])} reach out of the window")
    browser.resize(1280, 1000)


def check_console(browser):
    """no error or warning in the console"""
    entries = [e for e in browser.log("browser") if e["level"] in ("SEVERE", "WARNING")]
    expect(not entries, entries and entries[0]["message"])


def check_requests(browser):
    """no request but for the file itself"""
    asked = set()
    for entry in browser.log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] != "Network.requestWillBeSent":
            continue
        url, asker = message["params"]["request"]["url"], message["params"]["documentURL"]
        if asker.split("#")[0] != browser.page:
            continue  # the browser's own empty page, before the report was opened
        expect(url.startswith("data:") or url.split("#")[0] == browser.page, f"the page asks for {url}")
        asked.add(url.split("#")[0])
    expect(browser.page in asked, "the driver's log has no request for the file itself: it would have had no other either")


CHECKS = [check_hostile_names, check_tables, check_tips, check_play, check_keys, check_drag, check_bands, check_panels, check_matrix,
          check_themes, check_widths, check_requests, check_console]


def take_screenshots(browser, folder):
    folder.mkdir(parents=True, exist_ok=True)
    choose(browser, "run", "0")
    for name, theme, width in (("light", "light", 1280), ("dark", "dark", 1280), ("narrow", "light", 400)):
        browser.resize(width, 900)
        browser.run("document.querySelector(`[data-set-theme=${arguments[0]}]`).click()", theme)
        settled(browser)
        (folder / f"{name}.png").write_bytes(browser.whole_page())
    browser.resize(1280, 1000)
    settled(browser)
    (folder / "print.pdf").write_bytes(browser.print_pdf())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report", type=pathlib.Path)
    parser.add_argument("--comparison", action="store_true", help="the page is of `actformer compare`: no table of a paper is in it")
    parser.add_argument("--screenshots", type=pathlib.Path, metavar="DIR")
    options = parser.parse_args()
    if not available():
        print("skipped: python3-selenium, chromedriver and chromium are not all installed")
        return 77
    with Browser() as browser:
        browser.page = options.report.resolve(strict=True).as_uri()
        browser.comparison = options.comparison
        browser.resize(1280, 1000)
        browser.open(browser.page)
        for check in CHECKS:
            if options.comparison and check is check_tables:
                continue
            try:
                check(browser)
            except Failed as e:
                print(f"FAILED {check.__name__.removeprefix('check_')}: {e}")
                return 1
            print(f"ok: {check.__doc__}")
        if options.screenshots:
            take_screenshots(browser, options.screenshots)
            print(f"screenshots in {options.screenshots}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
