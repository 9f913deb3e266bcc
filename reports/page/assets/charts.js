// Charts: curves, bars, confusion matrix, scatter. Colours come from classes, so that themes and print
// need no redrawing; names from the data only ever become text.
const charts = (() => {
  const svgSpace = "http://www.w3.org/2000/svg";

  function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children);  // strings become text nodes
    return element;
  }
  const svg = (tag, attributes = {}, ...children) =>
    fill(document.createElementNS(svgSpace, tag), attributes, children);
  const html = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);

  /** What stands where there is nothing to draw. */
  const missing = (words) => html("p", { class: "missing" }, words);

  const shortened = (name, most) => (name.length > most ? name.slice(0, most - 1).trimEnd() + "…" : name);

  /** Round numbers from at or below `low` to at or above `high`, about `wanted` of them. */
  function ticks(low, high, wanted = 5) {
    if (!(high > low)) [low, high] = [low - 0.5, low + 0.5];
    const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find((d) => d * power >= rough * 0.999) * power;
    const out = [];
    const last = Math.ceil(high / step - 1e-9);
    for (let i = Math.floor(low / step + 1e-9); i <= last; ++i) out.push(i * step);
    return out;
  }

  /** The text of ticks, all with as many decimals as their step needs. */
  function tickText(values) {
    const step = values.length > 1 ? values[1] - values[0] : 1;
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return values.map((v) => v.toFixed(Math.min(decimals, 6)).replace("-", "−"));
  }

  const linear = (from, to, start, end) => (v) => start + ((v - from) / (to - from)) * (end - start);

  /** Ticks inside a range that ends where the data do, as a number of epochs does. */
  const ticksWithin = (low, high, wanted) => ticks(low, high, wanted).filter((v) => v >= low && v <= high);

  /**
   * Scales, grid, tick labels and titles of a chart with two axes; `box` is its inside in pixels, `xRange`
   * the ends of the first axis where ticks are not its ends.
   */
  function axes(box, xTicks, yTicks, xTitle, yTitle, { withXGrid = false, xRange = [xTicks[0], xTicks.at(-1)] }) {
    const x = linear(...xRange, box.left, box.right);
    const y = linear(yTicks[0], yTicks.at(-1), box.bottom, box.top);
    const group = svg("g", { class: "axes" });
    const xText = tickText(xTicks), yText = tickText(yTicks);
    yTicks.forEach((v, i) => group.append(
      svg("path", { class: "grid", d: `M${box.left} ${y(v)}H${box.right}` }),
      svg("text", { x: box.left - 8, y: y(v), class: "y-tick" }, yText[i])));
    xTicks.forEach((v, i) => {
      if (withXGrid) group.append(svg("path", { class: "grid", d: `M${x(v)} ${box.top}V${box.bottom}` }));
      group.append(svg("path", { class: "tick", d: `M${x(v)} ${box.bottom}v4` }),
        svg("text", { x: x(v), y: box.bottom + 17, class: "x-tick" }, xText[i]));
    });
    group.append(svg("path", { class: "axis", d: `M${box.left} ${box.bottom}H${box.right}` }),
      svg("text", { x: (box.left + box.right) / 2, y: box.bottom + 34, class: "title-x" }, xTitle));
    if (yTitle) group.append(svg("text", {
      class: "title-y", transform: `translate(${box.left - 44} ${(box.top + box.bottom) / 2}) rotate(-90)`,
    }, yTitle));
    return { group, x, y };
  }

  const drawing = (width, height, attributes, ...children) =>
    svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, ...attributes }, ...children);

  /** A legend entry: a swatch drawn as the marks are, its name and a place for the value under the cursor. */
  function legendEntry(kind, name) {
    const value = html("span", { class: "value" });
    const swatch = drawing(22, 10, { class: "swatch", "aria-hidden": "true" },
      svg("path", { class: kind, d: kind.startsWith("line") ? "M1 5H21" : "M11 5h0" }));
    return { entry: html("span", { class: "entry" }, swatch, name, value), value };
  }

  // --- Curves -------------------------------------------------------------------------------------

  const COLOURS = 4;

  /** SVG path through the points whose value is there; a gap stays a gap only where nothing follows it. */
  function curvePath(points, key, x, y) {
    return points.filter((p) => data.present(p[key]))
      .map((p, i) => `${i ? "L" : "M"}${x(p.epoch).toFixed(1)} ${y(p[key]).toFixed(1)}`).join("");
  }

  /** The marks of one series: a line, and dots where the values are too few to make out a line by. */
  function curveMarks(points, item, x, y) {
    const path = curvePath(points, item.key, x, y);
    const marks = [svg("path", { class: `line line-${item.colour}`, d: path })];
    const known = points.filter((p) => data.present(p[item.key]));
    if (known.length <= 40) marks.push(svg("path", {
      class: `dot dot-${item.colour}`, d: known.map((p) => `M${x(p.epoch)} ${y(p[item.key])}h0`).join(""),
    }));
    return marks;
  }

  /** Lets pointer and arrow keys step a cursor over `epochs`; `show(index)` gets -1 when the cursor leaves. */
  function epochCursor(chart, epochs, x, show) {
    let at = -1;
    const move = (index) => show((at = index));
    const nearest = (pixel) => epochs.reduce((best, e, i) =>
      Math.abs(x(e) - pixel) < Math.abs(x(epochs[best]) - pixel) ? i : best, 0);
    chart.addEventListener("pointermove", (event) => {
      const frame = chart.getBoundingClientRect();
      move(nearest((event.clientX - frame.left) * (chart.viewBox.baseVal.width / frame.width)));
    });
    chart.addEventListener("pointerleave", () => move(-1));
    chart.addEventListener("blur", () => move(-1));
    chart.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      move(Math.min(epochs.length - 1, Math.max(0, at < 0 ? epochs.length - 1 : at + step)));
    });
  }

  /**
   * One chart over epochs. `series`: [{key, name}], coloured in turn; `unit` ("%") follows the values read
   * off. Series without any value are left out; null when none is left.
   */
  function curves(points, { title, series, unit, from_zero: fromZero }, width) {
    const drawn = series.filter((s) => points.some((p) => data.present(p[s.key])))
      .map((s, i) => ({ ...s, colour: 1 + (i % COLOURS) }));
    if (!drawn.length) return null;
    const values = drawn.flatMap((s) => points.map((p) => p[s.key]).filter(data.present));
    const low = Math.min(...values), epochs = points.map((p) => p.epoch);
    // One epoch alone still needs a width to stand in.
    const xRange = [Math.min(...epochs), Math.max(Math.max(...epochs), Math.min(...epochs) + 1)];
    const height = 230, box = { left: 58, right: width - 14, top: 10, bottom: height - 44 };
    const frame = axes(box, ticksWithin(...xRange, Math.max(3, width / 90)),
      ticks(fromZero ? Math.min(0, low) : low, Math.max(...values), 4), "epoch", title + (unit && `, ${unit}`), { xRange });

    const cursor = svg("path", { class: "cursor", visibility: "hidden" });
    const chart = drawing(width, height, { class: "chart", tabindex: 0, role: "img",
      "aria-label": `${title} over ${epochs.length} epochs; left and right read values off` },
      frame.group, ...drawn.flatMap((s) => curveMarks(points, s, frame.x, frame.y)), cursor);
    const entries = drawn.map((s) => legendEntry(`line line-${s.colour}`, s.name));
    const epoch = html("span", { class: "value" });
    epochCursor(chart, epochs, frame.x, (index) => {
      cursor.setAttribute("visibility", index < 0 ? "hidden" : "visible");
      if (index >= 0) cursor.setAttribute("d", `M${frame.x(epochs[index])} ${box.top}V${box.bottom}`);
      epoch.textContent = index < 0 ? "" : `epoch ${epochs[index]}`;
      drawn.forEach((s, i) => {
        const value = index < 0 ? null : points[index][s.key];
        entries[i].value.textContent = index < 0 ? "" : data.present(value) ? data.figure(value) + (unit && ` ${unit}`) : "–";
      });
    });
    const legend = html("figcaption", { class: "entries", "aria-live": "polite" }, ...entries.map((e) => e.entry), epoch);
    return html("figure", {}, legend, chart);
  }

  // --- Bars ---------------------------------------------------------------------------------------

  /** A column of bars with its scale from 0, to 100 for shares; null where no class has a value. */
  function barColumn(column, index, perClass) {
    const { key, floor, unit } = column, share = unit === "%";
    const values = perClass.flatMap((c) => [c[key], floor ? c[floor] : null]).filter(data.present);
    if (!values.length) return null;
    const marks = ticks(0, share ? 100 : Math.max(...values), 4);
    return { ...column, colour: 1 + (index % COLOURS), text: share ? (v) => v.toFixed(0) : data.figure, marks, end: marks.at(-1) };
  }

  /** The sticky head of a column: its title over its axis. */
  function barHead({ heading, unit, marks, end }) {
    const labels = tickText(marks);
    const axis = html("span", { class: "bar-axis", "aria-hidden": "true" });
    marks.forEach((v, i) => {
      const label = html("span", {}, labels[i]);
      label.style.left = `${(100 * v) / end}%`;
      axis.append(label);
    });
    return html("th", { scope: "col" }, data.capital(heading) + (unit && `, ${unit}`), axis);
  }

  function barCell(column, entry) {
    const value = entry[column.key];
    const cell = html("td", {});
    if (!data.present(value)) return fill(cell, { class: "none" }, ["–"]);
    const track = html("span", { class: "track" }), bar = html("span", { class: `fill fill-${column.colour}` });
    track.style.setProperty("--steps", column.marks.length - 1);
    bar.style.width = `${(100 * value) / column.end}%`;
    track.append(bar);
    if (column.floor && data.present(entry[column.floor])) {
      const tick = html("span", { class: "floor", title: `real against real: ${data.figure(entry[column.floor])}` });
      tick.style.left = `${(100 * entry[column.floor]) / column.end}%`;
      track.append(tick);
    }
    cell.append(track, html("span", { class: "value" }, column.text(value)));
    return cell;
  }

  /**
   * Metrics of each class as bars in a table: it reads as one, scrolls in its box and prints whole. `metrics`:
   * [{key, heading, unit, better, floor}]; `order`: the key of one of them. `choose(class)` is called for a click on a row.
   */
  function bars(classes, perClass, metrics, order, chosen, choose) {
    const columns = metrics.map((metric, i) => barColumn(metric, i, perClass)).filter(Boolean);
    if (!columns.length) return missing("No class of this run was scored.");
    const head = html("tr", {}, html("th", { scope: "col" }, "Action"), ...columns.map(barHead));
    const body = html("tbody");
    for (const c of data.classOrder(perClass, metrics.find((m) => m.key === order))) {
      const entry = perClass[c];
      const name = html("th", { scope: "row", title: `${entry.real} real, ${entry.generated} generated` }, classes[c] ?? `class ${c + 1}`);
      const line = html("tr", c === chosen ? { class: "chosen" } : {}, name, ...columns.map((column) => barCell(column, entry)));
      line.addEventListener("click", () => choose(c));
      body.append(line);
    }
    const table = html("table", { class: "bars" }, html("thead", {}, head), body);
    const scroll = html("div", { class: "bars-box", tabindex: 0, role: "region", "aria-label": `${columns.map((c) => c.heading).join(", ")} by action` }, table);
    if (!columns.some((c) => c.floor)) return scroll;
    const key = html("p", { class: "quiet" }, html("span", { class: "floor-key", "aria-hidden": "true" }),
      " the floor: FID of real motions against other real motions of the class");
    const whole = document.createDocumentFragment();
    whole.append(scroll, key);
    return whole;
  }

  // --- Confusion matrix ---------------------------------------------------------------------------

  const levels = 25;  // steps of shading: more than one can tell apart, and few enough to draw as paths

  /** One path a step of shading: 120 x 120 cells as a few elements rather than fourteen thousand. */
  function matrixShades(confusion, cell, origin) {
    const paths = new Array(levels + 1).fill("");
    confusion.forEach((line, row) => {
      const of = data.sum(line);
      line.forEach((count, column) => {
        if (count > 0) paths[Math.max(1, Math.round((levels * count) / of))] +=
          `M${(origin.x + column * cell).toFixed(2)} ${(origin.y + row * cell).toFixed(2)}h${cell.toFixed(2)}v${cell.toFixed(2)}h${(-cell).toFixed(2)}z`;
      });
    });
    return paths.map((d, level) => svg("path", { class: "heat", d, "fill-opacity": (level / levels).toFixed(2) }))
      .filter((path) => path.getAttribute("d"));
  }

  /** Names where a row is high enough to read them, numbers every few rows otherwise. */
  function matrixLabels(classes, count, cell, origin, size) {
    const group = svg("g", { class: "axes" });
    const named = cell >= 13 && classes.length >= count;
    const letters = Math.floor((origin.x - 30) / 7), every = named ? 1 : cell >= 13 ? 1 : [2, 5, 10, 20].find((n) => n * cell >= 26) ?? 50;
    for (let i = 0; i < count; ++i) {
      if (i > 0 && (i + 1) % every) continue;
      const text = named ? shortened(classes[i], letters) : String(i + 1), middle = (i + 0.5) * cell;
      group.append(
        svg("text", { class: "y-tick", x: origin.x - 6, y: origin.y + middle }, text),
        svg("text", { class: named ? "slanted" : "x-tick",
          transform: `translate(${origin.x + middle} ${origin.y + size + (named ? 10 : 16)})${named ? " rotate(-50)" : ""}` }, text));
    }
    return group;
  }

  /** Moves a cell cursor over the matrix by pointer and by arrow keys; `show(row, column)`, or null. */
  function cellCursor(chart, count, cell, origin, show) {
    let at = { row: 0, column: 0 };
    const clamp = (i) => Math.min(count - 1, Math.max(0, i));
    chart.addEventListener("pointermove", (event) => {
      const frame = chart.getBoundingClientRect(), zoom = chart.viewBox.baseVal.width / frame.width;
      const column = Math.floor(((event.clientX - frame.left) * zoom - origin.x) / cell);
      const row = Math.floor(((event.clientY - frame.top) * zoom - origin.y) / cell);
      if (row !== clamp(row) || column !== clamp(column)) return show(null);
      show((at = { row, column }));
    });
    chart.addEventListener("pointerleave", () => show(null));
    chart.addEventListener("blur", () => show(null));
    chart.addEventListener("focus", () => { if (chart.matches(":focus-visible")) show(at); });
    chart.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
      if (!step) return;
      event.preventDefault();
      show((at = { row: clamp(at.row + step[0]), column: clamp(at.column + step[1]) }));
    });
  }

  const share = (count, of) => (of > 0 ? `${((100 * count) / of).toFixed(0)}\u00a0%` : "–");

  function commonest(classes, confusion) {
    const found = data.commonConfusions(confusion, 5);
    if (!found.length) return html("p", {}, "Every motion was recognised as the action asked for.");
    const name = (c) => html("b", {}, classes[c] ?? `class ${c + 1}`);
    return html("div", { class: "commonest" }, html("h3", {}, "Commonest confusions"), html("ol", {}, ...found.map((f) =>
      html("li", {}, name(f.asked), " taken for ", name(f.recognised), `: ${f.count} of ${f.of} (${share(f.count, f.of)})`))));
  }

  /** Steps of shading with their shares, drawn as the cells are. */
  function heatKey() {
    const step = 5, key = drawing(step * levels, 12, { class: "swatch", "aria-hidden": "true" });
    for (let level = 1; level <= levels; ++level) key.append(svg("path", {
      class: "heat", "fill-opacity": level / levels, d: `M${step * (level - 1)} 1h${step}v10h${-step}z`,
    }));
    return html("span", { class: "entry" }, "0 ", key, " 100 % of the row");
  }

  /** Where the matrix lies in a drawing as wide as `width`, with room for names where they will fit. */
  function matrixPlace(count, width) {
    const names = width >= 520 ? 150 : 118, numbers = 46, most = 620;
    const named = Math.min(width - names - 10, most) / count >= 13;
    const left = named ? names : numbers, size = Math.min(width - left - 10, most, count * 40);
    return { origin: { x: left, y: 6 }, size, cell: size / count, height: size + (named ? names * 0.86 + 26 : 46) };
  }

  function matrixDrawing(classes, confusion, place, width) {
    const { origin, size, cell, height } = place, count = confusion.length;
    return drawing(Math.min(width, origin.x + size + 10), height, { class: "chart", tabindex: 0, role: "img",
      "aria-label": `Confusion matrix of ${count} actions, rows asked for, columns recognised; arrow keys read cells` },
      svg("rect", { class: "heat-ground", x: origin.x, y: origin.y, width: size, height: size }),
      ...matrixShades(confusion, cell, origin), matrixLabels(classes, count, cell, origin, size),
      svg("text", { class: "title-x", x: origin.x + size / 2, y: height - 6 }, "recognised as"),
      svg("text", { class: "title-y", transform: `translate(12 ${origin.y + size / 2}) rotate(-90)` }, "asked for"));
  }

  function confusionMatrix(classes, confusion, chosen, width) {
    if (!confusion || !confusion.length) return missing("No confusion matrix was kept for this run.");
    const place = matrixPlace(confusion.length, width), { origin, size, cell } = place;
    const chart = matrixDrawing(classes, confusion, place, width);
    if (chosen >= 0 && chosen < confusion.length) chart.append(svg("rect", {
      class: "row-mark", x: origin.x - 1, y: origin.y + chosen * cell - 1, width: size + 2, height: cell + 2 }));
    const mark = svg("rect", { class: "cell-mark", width: cell, height: cell, visibility: "hidden" });
    chart.append(mark);
    const hint = "Point at a cell, or step through with the arrow keys.";
    const readout = html("output", { class: "readout" }, hint);
    cellCursor(chart, confusion.length, cell, origin, (at) => {
      mark.setAttribute("visibility", at ? "visible" : "hidden");
      if (!at) return void (readout.textContent = hint);
      mark.setAttribute("x", origin.x + at.column * cell);
      mark.setAttribute("y", origin.y + at.row * cell);
      const line = confusion[at.row], name = (c) => classes[c] ?? `class ${c + 1}`;
      readout.textContent = `asked for ${name(at.row)}, recognised as ${name(at.column)}: ` +
        `${line[at.column]} of ${data.sum(line)}`;
    });
    return html("div", { class: "matrix" },
      html("figure", {}, html("figcaption", { class: "entries" }, readout, heatKey()), chart), commonest(classes, confusion));
  }

  // --- Scatter ------------------------------------------------------------------------------------

  /** All dots of a kind as one path of zero-length strokes with round caps. */
  function dots(points, kind, x, y, wanted) {
    let d = "";
    for (let i = 0; points && i < points.x.length; ++i)
      if (wanted(points.labels[i])) d += `M${x(points.x[i]).toFixed(1)} ${y(points.y[i]).toFixed(1)}h0`;
    return d ? [svg("path", { class: `dot ${kind}`, d })] : [];
  }

  function range(clouds, axis) {
    let low = Infinity, high = -Infinity;
    for (const cloud of clouds) for (const v of cloud[axis]) { low = Math.min(low, v); high = Math.max(high, v); }
    return [low, high];
  }

  /** Real and generated features; with an action chosen the rest stands back. */
  function scatter(real, made, explained, chosen, width) {
    const clouds = [real, made].filter((c) => c && c.x.length);
    if (!clouds.length) return missing("No features were kept for this run.");
    width = Math.min(width, 860);
    const height = Math.round(Math.min(560, Math.max(300, width * 0.66)));
    const box = { left: 58, right: width - 14, top: 8, bottom: height - 44 };
    const title = (ordinal, i) => `${ordinal} principal component` +
      (data.present(explained?.[i]) ? ` (${(100 * explained[i]).toFixed(0)} %)` : "");
    const frame = axes(box, ticks(...range(clouds, "x"), 6), ticks(...range(clouds, "y"), 5),
      title("first", 0), title("second", 1), { withXGrid: true });
    const rest = chosen >= 0 ? " back" : "", other = (l) => l !== chosen, same = (l) => l === chosen;
    const chart = drawing(width, height, { class: "chart", role: "img",
      "aria-label": "Real and generated motions by the first two principal components of their features" },
      frame.group,
      ...dots(real, "dot-real" + rest, frame.x, frame.y, other), ...dots(made, "dot-made" + rest, frame.x, frame.y, other),
      ...dots(real, "dot-real front", frame.x, frame.y, same), ...dots(made, "dot-made front", frame.x, frame.y, same));
    const legend = html("figcaption", { class: "entries" },
      legendEntry("dot dot-real front", `real, ${real ? real.x.length : 0}`).entry,
      legendEntry("dot dot-made front", `generated, ${made ? made.x.length : 0}`).entry);
    return html("figure", {}, legend, chart);
  }

  return { html, missing, curves, bars, confusionMatrix, scatter };
})();
