// Ties the page together: one chosen run and one chosen action drive every panel.
const byId = (id) => document.getElementById(id);
const { html, missing } = charts;
const report = JSON.parse(byId("data").textContent);

const MOST = 4;  // motions a band
const chosen = { run: 0, action: -1 };
const row = () => report.rows[chosen.run];
/** Pixels across an element; a page opened in the background has none yet, and is drawn again when it has. */
const widthOf = (element) => Math.max(280, element.clientWidth);

// --- Run: its name, scores and warnings -----------------------------------------------------------

const withUnit = (value, unit) => data.figure(value) + (unit && ` ${unit}`);

/** A score with what real motions come to: their own value, or the floor of real against real. */
function scoreItem({ heading, unit, value, real, floor }) {
  const [name, against] = data.present(real) ? ["real", real] : ["floor", floor];
  return html("div", {}, html("dt", {}, data.capital(heading)), html("dd", {}, withUnit(value, unit),
    html("small", {}, data.present(against) ? `${name} ${withUnit(against, unit)}` : "")));
}

const STATES = { failed: "This run failed", waiting: "This run is not finished", stopped: "This training stopped" };

function showRun() {
  const run = row();
  byId("run-name").textContent = run.name;
  byId("fills").textContent = run.sweep
    ? `${run.fills?.length ? `Fills ${run.fills.join("; ")}.` : "Fills no cell of the tables."} Sweep ${run.sweep}.`
    : "A training by itself: its curves, and no scores.";
  byId("scores").replaceChildren(...(run.scores ?? []).map(scoreItem));
  const state = STATES[run.status];
  byId("warnings").replaceChildren(
    ...(state ? [html("p", { class: run.status }, run.why ? `${state}: ${run.why}` : `${state}.`)] : []),
    ...(run.warnings ?? []).map((words) => html("p", { class: "warning" }, words)));
}

// --- Motions --------------------------------------------------------------------------------------

const actionName = (action) => (action < 0 ? "all actions" : row().classes?.[action] ?? `class ${action + 1}`);

/** The runs whose motions are shown: both sides of a comparison, else the chosen one. */
const shownRuns = () => (row().compared.length ? row().compared.map((i) => report.rows[i]) : [row()]);

/** What the viewer shows, in words: "4 real and 4 generated motions of run". */
function motionsInWords(bands) {
  const [real, ...made] = bands.map(({ name, scenes }) => ({ name, count: scenes.length })), of = actionName(chosen.action);
  return made.length === 1 ? `${real.count} real and ${made[0].count} generated motions of ${of}`
    : `Motions of ${of}: ${[`${real.count} real`, ...made.map(({ name, count }) => `${count} of ${name}`)].join("; ")}`;
}

function showMotions() {
  const runs = shownRuns(), found = data.motionsOf(report, row(), runs, chosen.action, MOST);
  const some = Boolean(found?.some(({ motions }) => motions.length));
  byId("stage").hidden = !some;
  byId("motions-missing").hidden = some;
  byId("motions-action").textContent = actionName(chosen.action);
  if (!some) {
    byId("motions-missing").textContent = found ? "No motion of this action was kept." : "No motions were kept for this run.";
    return;
  }
  const names = runs.length > 1 ? runs.map(({ name }) => name) : ["Generated"];
  const bands = found.map(({ topology, motions }, i) => ({
    name: ["Real", ...names][i], scenes: motions.map((m) => body.makeScene(m, topology)),
    empty: `no ${i === 0 ? "real" : "generated"} motion of this action in the report`,
  }));
  theViewer.show(bands, motionsInWords(bands));
}

// --- Charts ---------------------------------------------------------------------------------------

function showBars() {
  const box = byId("bars"), top = box.firstElementChild?.scrollTop ?? 0;
  box.replaceChildren(charts.bars(row().classes ?? [], row().per_class ?? [], report.class_columns, byId("order").value,
    chosen.action, chooseAction));
  if (box.firstElementChild) box.firstElementChild.scrollTop = top;
}

function showConfusion() {
  byId("matrix").replaceChildren(
    charts.confusionMatrix(row().classes ?? [], row().confusion, chosen.action, widthOf(byId("matrix"))));
}

function showCurves() {
  const box = byId("curves"), columns = widthOf(box) >= 760 ? 2 : 1, gap = 28;
  const width = (widthOf(box) - gap * (columns - 1)) / columns;
  box.style.setProperty("--columns", columns);
  const groups = Object.entries(row().curves ?? {}).map(([network, curves]) => {
    const drawn = (curves?.charts ?? []).map((chart) => charts.curves(curves.points, chart, width)).filter(Boolean);
    return drawn.length ? html("div", {}, html("h3", {}, `The ${network}`), html("div", { class: "pairs" }, ...drawn)) : null;
  }).filter(Boolean);
  box.replaceChildren(...(groups.length ? groups : [missing("No training curves were kept for this run.")]));
}

function showScatter() {
  const run = row(), plane = data.present(run.projection) ? report.projections?.[run.projection] : null;
  const real = plane && data.pointsOf(plane), made = plane && run.points ? data.pointsOf(run.points) : null;
  byId("scatter").replaceChildren(charts.scatter(real, made, plane?.explained, chosen.action, widthOf(byId("scatter"))));
}

// --- Choosing -------------------------------------------------------------------------------------

function showAction() {
  showMotions();
  showBars();
  showConfusion();
  showScatter();
}

function chooseAction(action) {
  chosen.action = action;
  byId("action").value = String(action);
  showAction();
}

/** The next action, around through "all". */
function stepAction(by) {
  const count = (row().classes?.length ?? 0) + 1;
  chooseAction(((chosen.action + 1 + by + count) % count) - 1);
}

const option = (value, words) => html("option", { value }, words);

/** Runs share actions by name, not by number: the choice stays where the next run has it too. */
function chooseRun(index) {
  const name = chosen.action < 0 ? null : actionName(chosen.action);
  chosen.run = index;
  const classes = row().classes ?? [];
  byId("action").replaceChildren(option("-1", "all"), ...classes.map((c, i) => option(String(i), c)));
  showRun();
  showCurves();
  chooseAction(name === null ? -1 : classes.indexOf(name));
}

// --- Page -----------------------------------------------------------------------------------------

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  for (const button of document.querySelectorAll("[data-set-theme]"))
    button.setAttribute("aria-pressed", button.dataset.setTheme === theme);
  theViewer.refresh();
}

/** Paper is white: the canvas, which no style sheet reaches, is drawn again for it. */
function listenForPrint() {
  let before = null;
  window.addEventListener("beforeprint", () => {
    before = document.documentElement.dataset.theme;
    setTheme("light");
  });
  window.addEventListener("afterprint", () => before && setTheme(before));
}

/** Charts are drawn in pixels, so that text keeps its size: again for every new width. */
function listenForWidth() {
  let width = widthOf(byId("panels"));
  new ResizeObserver(() => {
    if (widthOf(byId("panels")) === width) return;
    width = widthOf(byId("panels"));
    theViewer.refresh();
    showConfusion();
    showCurves();
    showScatter();
  }).observe(byId("panels"));
}

/** "lowest accuracy first": each metric of the classes, the worst class on top. */
function offerOrders() {
  byId("order").append(...report.class_columns.map(({ key, heading, better }) =>
    option(key, `${better === "higher" ? "lowest" : "highest"} ${heading} first`)));
}

function listen() {
  byId("run").addEventListener("change", () => chooseRun(Number(byId("run").value)));
  byId("action").addEventListener("change", () => chooseAction(Number(byId("action").value)));
  byId("order").addEventListener("change", showBars);
  for (const button of document.querySelectorAll("[data-set-theme]"))
    button.addEventListener("click", () => setTheme(button.dataset.setTheme));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => theViewer.refresh());
  document.addEventListener("keydown", (event) => {  // a tip that is in the way goes
    if (event.key === "Escape" && document.activeElement?.matches("td[tabindex]")) document.activeElement.blur();
  });
  listenForPrint();
  listenForWidth();
}

const theViewer = new viewer.Viewer({
  canvas: byId("viewer"), play: byId("play"), scrub: byId("scrub"), frame: byId("frame"),
  speed: byId("speed"), turn: byId("turn"), reset: byId("reset"),
}, stepAction);

byId("title").textContent = document.title;
byId("footer").textContent = `Written by actformer ${report.version}.`;
if (report.rows.length) {
  byId("panels").hidden = false;
  if (report.rows.every((r) => !r.sweep)) {  // trainings alone: nothing was scored
    const panels = ["motions", "classes", "confusion", "projection"].map((name) => `#${name}, nav a[href="#${name}"]`);
    for (const part of document.querySelectorAll([".nav-group, .legend, .note, .skip", ...panels].join())) part.hidden = true;
  }
  byId("run").replaceChildren(...report.rows.map((r, i) =>
    option(String(i), r.status === "done" ? r.name : `${r.name} (${r.status === "failed" ? "failed" : "not finished"})`)));
  offerOrders();
  listen();
  chooseRun(0);
}
