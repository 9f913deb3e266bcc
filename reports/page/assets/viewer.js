// The motion viewer: real motions above, generated ones of one run or of two below, in one canvas with one clock and one camera.
const viewer = (() => {
  const { pose, project, sortSolids } = body;
  const { clamp, makePaint, paintBodies, paintFloor, paintShadow } = paint;

  // --- The stage: cells, camera, clock ------------------------------------------------------------

  const START = { azimuth: -0.55, elevation: 0.2, zoom: 1 };
  const BAND = 26, TITLE = 20;  // heights of a band's heading and of a cell's title, pixels
  const BAND_FONT = "600 14px system-ui, sans-serif", TITLE_FONT = "12px system-ui, sans-serif";
  /**
   * Cells of all bands: {bands: [{name, y, empty}], cells: [{x, y, width, height, scene}], height}. Of three bands or more, cells are
   * so low that a window holds them and the controls, and what it is too narrow for comes below all bands, with their headings again.
   */
  function layout(sets, width) {
    const most = Math.max(1, ...sets.map((s) => s.scenes.length)), many = sets.length > 2;
    const columns = Math.min(most, width < 560 ? 2 : 4), part = many ? columns : most;
    const cellWidth = width / columns, cellHeight = many ? 190 : clamp(cellWidth * 1.05, 190, columns > 2 ? 300 : 360);
    const bands = [], cells = [];
    let y = 0;
    for (let first = 0; first < most; first += part) for (const { name, scenes, empty } of sets) {
      const here = scenes.slice(first, first + part);
      if (first && !here.length) continue;
      bands.push({ name, y, empty: here.length ? "" : empty });
      y += BAND;
      here.forEach((scene, i) => cells.push({ scene, x: (i % columns) * cellWidth,
        y: y + Math.floor(i / columns) * (cellHeight + TITLE), width: cellWidth, height: cellHeight }));
      y += here.length ? Math.ceil(here.length / columns) * (cellHeight + TITLE) : 40;
    }
    return { bands, cells, height: Math.ceil(y) };
  }

  /** `words`, or as many letters of their beginning, or of their end, as fit `width` pixels with an ellipsis. */
  function fitting(context, words, width, end = false) {
    const letters = [...words];
    let shown = words;
    while (letters.length && context.measureText(shown).width > width) {
      if (end) letters.shift();
      else letters.pop();
      shown = end ? `…${letters.join("").replace(/^[\s·]+/, "")}` : `${letters.join("").trimEnd()}…`;
    }
    return shown;
  }

  /**
   * {scale, tall, floor}: pixels a metre at which the largest group fits its cell however it is turned, the
   * height of the tallest and the floor's radius in metres. All cells share them: sizes compare, floors lie level.
   */
  function fit(cells) {
    if (!cells.length) return { scale: 1, tall: 1, floor: 1 };
    const cos = Math.cos(START.elevation), sin = Math.sin(START.elevation), margin = 0.12;
    const tall = Math.max(...cells.map(({ scene: { bounds } }) => bounds.top - bounds.floor)) + margin;
    const wide = Math.max(...cells.map(({ scene: { bounds } }) => bounds.radius)) + margin;
    const { width, height } = cells[0], scale = Math.min(width / (2 * wide), height / (tall * cos + 2 * wide * sin));
    return { tall, scale, floor: Math.min(wide + 0.4, width / (2 * scale), (height / scale - tall * cos) / (2 * sin)) };
  }

  class Stage {
    constructor(canvas) {
      this.canvas = canvas;
      this.context = canvas.getContext("2d");
      this.time = 0;
      this.eye = { x: 0, y: 0, scale: 1, sin: 0, cos: 1, sinUp: 0, cosUp: 1 };
      this.sets = [];
      this.place = layout([], 1);
      this.resetView();
      this.restyle();
    }

    resetView() {
      Object.assign(this, START);
    }

    show(sets) {
      this.sets = sets;
      this.resize();
    }

    /** Takes up the colours of the theme. */
    restyle() {
      this.paint = makePaint(this.context, this.canvas);
    }

    /** Fits the canvas to its box and to the screen's pixels. */
    resize() {
      this.width = this.canvas.parentElement.clientWidth;
      if (!this.width) return;
      this.place = layout(this.sets, this.width);
      this.fit = fit(this.place.cells);
      this.dense = Math.min(2, window.devicePixelRatio || 1);
      this.canvas.width = Math.round(this.width * this.dense);
      this.canvas.height = Math.round(this.place.height * this.dense);
      this.canvas.style.height = `${this.place.height}px`;
      this.fitWords();
    }

    /** Headings begin with what tells them apart, titles end with it; these may be set a sixth narrower. */
    fitWords() {
      const { context, place } = this;
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.font = BAND_FONT;
      for (const band of place.bands) band.heading = fitting(context, band.name, this.width - 24);
      context.font = TITLE_FONT;
      for (const cell of place.cells) cell.title = fitting(context, cell.scene.motion.title, 1.2 * (cell.width - 12), true);
    }

    orbit(right, up) {
      this.azimuth -= right;
      this.elevation = clamp(this.elevation + up, 0.02, 1.5);
    }

    zoomBy(factor) {
      this.zoom = clamp(this.zoom * factor, 0.4, 8);
    }

    draw() {
      const { context, place } = this;
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, this.canvas.width, this.canvas.height);
      for (const cell of place.cells) this.drawCell(cell);
      this.drawWords();
    }

    drawCell(cell) {
      const { context, dense, eye } = this, { scene } = cell;
      context.setTransform(dense, 0, 0, dense, 0, 0);
      context.save();
      context.beginPath();
      context.rect(cell.x, cell.y, cell.width, cell.height);
      context.clip();
      this.aim(eye, cell, scene);
      pose(scene, this.time);
      project(scene, eye);
      sortSolids(scene);
      paintFloor(context, this.paint, scene, eye, this.fit.floor);
      paintShadow(context, this.paint, scene, eye);
      paintBodies(context, this.paint, scene, eye);
      context.restore();
    }

    /** Points the eye at the middle of the group: `eye.x, eye.y` is where the floor under it comes to lie. */
    aim(eye, cell, { front }) {
      const angle = front + this.azimuth;
      eye.sin = Math.sin(angle);
      eye.cos = Math.cos(angle);
      eye.sinUp = Math.sin(this.elevation);
      eye.cosUp = Math.cos(this.elevation);
      eye.scale = this.fit.scale * this.zoom * this.dense;
      eye.x = (cell.x + cell.width / 2) * this.dense;
      eye.y = (cell.y + cell.height / 2) * this.dense + 0.5 * eye.scale * this.fit.tall * eye.cosUp;
    }

    drawWords() {
      const { context, dense, place, paint, width } = this;
      context.setTransform(dense, 0, 0, dense, 0, 0);
      context.textBaseline = "middle";
      for (const band of place.bands) {
        context.textAlign = "left";
        context.fillStyle = paint.ink;
        context.font = BAND_FONT;
        context.fillText(band.heading, 12, band.y + BAND / 2 + 2);
        context.fillStyle = paint.rule;
        if (band.y) context.fillRect(0, band.y, width, 1);
        context.fillStyle = paint.quiet;
        context.font = "13px system-ui, sans-serif";
        if (band.empty) context.fillText(band.empty, 12, band.y + BAND + 16);
      }
      context.textAlign = "center";
      context.font = TITLE_FONT;
      for (const { title, x, y, width: across, height } of place.cells)
        context.fillText(title, x + across / 2, y + height + TITLE / 2 - 2, across - 12);
    }
  }

  // --- The viewer: stage, controls and keys -------------------------------------------------------

  /** Calls `drag(dx, dy)` for one pointer and `pinch(factor)` for two. */
  function followPointers(canvas, drag, pinch) {
    const down = new Map();
    const apart = () => {
      const [a, b] = [...down.values()];
      return Math.hypot(a.x - b.x, a.y - b.y) || 1;
    };
    canvas.addEventListener("pointerdown", (event) => {
      down.set(event.pointerId, { x: event.clientX, y: event.clientY });
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const last = down.get(event.pointerId);
      if (!last) return;
      const before = down.size === 2 ? apart() : 0, dx = event.clientX - last.x, dy = event.clientY - last.y;
      last.x = event.clientX;
      last.y = event.clientY;
      if (before) pinch(apart() / before);
      else if (down.size === 1) drag(dx, dy);
    });
    for (const type of ["pointerup", "pointercancel"])
      canvas.addEventListener(type, (event) => down.delete(event.pointerId));
  }

  class Viewer {
    /** `parts`: {canvas, play, scrub, frame, speed, turn, reset}, elements; `stepAction(±1)` for [ and ]. */
    constructor(parts, stepAction) {
      this.parts = parts;
      this.stepAction = stepAction;
      this.stage = new Stage(parts.canvas);
      this.playing = false;
      this.wanted = 0;  // the animation frame asked for, 0 for none
      this.tick = this.tick.bind(this);
      this.listen();
    }

    /** Shows `sets`, [{name, scenes, empty}]; the clock goes to a third of the longest motion, paused. */
    show(sets, words) {
      const motions = sets.flatMap((s) => s.scenes.map((f) => f.motion));
      const lasts = (m) => m.frames / m.fps;
      this.longest = motions.reduce((a, b) => (lasts(b) > lasts(a) ? b : a), motions[0]);
      this.parts.canvas.setAttribute("aria-label", words);
      this.parts.scrub.max = this.longest.frames - 1;
      this.setPlaying(false);
      this.stage.show(sets);
      this.seek(Math.round(this.longest.frames / 3));
    }

    seek(frame) {
      const { frames, fps } = this.longest;
      this.stage.time = (((frame % frames) + frames) % frames) / fps;
      this.invalidate();
    }

    get frame() {
      return Math.min(this.longest.frames - 1, Math.floor(this.stage.time * this.longest.fps + 1e-6));
    }

    setPlaying(playing) {
      this.playing = playing;
      this.last = 0;
      this.parts.play.textContent = playing ? "❚❚ Pause" : "▶ Play";
      this.parts.play.setAttribute("aria-pressed", playing);
      this.invalidate();
    }

    /** Asks for one drawing; while nothing moves, nothing is drawn. */
    invalidate() {
      if (!this.wanted && this.longest) this.wanted = requestAnimationFrame(this.tick);
    }

    tick(now) {
      this.wanted = 0;
      const turning = this.parts.turn.checked, passed = this.last ? Math.min(0.1, (now - this.last) / 1000) : 0;
      this.last = this.playing || turning ? now : 0;
      if (this.playing) {
        const lasts = this.longest.frames / this.longest.fps;
        this.stage.time = (this.stage.time + passed * Number(this.parts.speed.value)) % lasts;
      }
      if (turning) this.stage.azimuth += passed * 0.5;
      this.stage.draw();
      this.tell();
      if (this.playing || turning) this.invalidate();
    }

    /** Brings slider and words up to date, only when the frame has changed. */
    tell() {
      const { scrub, frame } = this.parts, at = this.frame, { frames, fps } = this.longest;
      if (this.told === at && this.toldOf === this.longest) return;
      this.told = at;
      this.toldOf = this.longest;
      scrub.value = at;
      frame.textContent = `${at + 1} / ${frames} · ${(at / fps).toFixed(2)} s`;
      scrub.setAttribute("aria-valuetext", `frame ${at + 1} of ${frames}`);
    }

    /** After a change of width or theme. */
    refresh() {
      this.stage.restyle();
      if (!this.longest) return;
      this.stage.resize();
      this.stage.draw();
    }

    resetView() {
      this.stage.resetView();
      this.invalidate();
    }

    step(frames) {
      this.setPlaying(false);
      this.seek(this.frame + frames);
    }

    view(change) {
      change(this.stage);
      this.invalidate();
    }

    listen() {
      const { canvas, play, scrub, turn, reset } = this.parts;
      play.addEventListener("click", () => this.setPlaying(!this.playing));
      scrub.addEventListener("input", () => this.seek(Number(scrub.value)));
      turn.addEventListener("change", () => this.invalidate());
      reset.addEventListener("click", () => this.resetView());
      canvas.addEventListener("dblclick", () => this.resetView());
      canvas.addEventListener("contextrestored", () => this.refresh());  // a lost picture does not come back by itself
      canvas.addEventListener("keydown", (event) => this.key(event));
      canvas.addEventListener("wheel", (event) => {
        if (document.activeElement !== canvas && !event.ctrlKey) return;  // the page scrolls
        event.preventDefault();
        this.view((stage) => stage.zoomBy(Math.exp(-0.0015 * event.deltaY)));
      }, { passive: false });
      followPointers(canvas, (dx, dy) => this.view((stage) => stage.orbit(0.009 * dx, 0.007 * dy)),
        (factor) => this.view((stage) => stage.zoomBy(factor)));
    }

    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const act = (event.shiftKey && ORBIT_KEYS[event.key]) || (!event.shiftKey && STEP_KEYS[event.key]) || KEYS[event.key];
      if (!act) return;
      event.preventDefault();
      act(this);
    }
  }

  const orbitKey = (right, up) => (v) => v.view((stage) => stage.orbit(right, up));
  const zoomKey = (factor) => (v) => v.view((stage) => stage.zoomBy(factor));
  const ORBIT_KEYS = {
    ArrowLeft: orbitKey(-0.12, 0), ArrowRight: orbitKey(0.12, 0), ArrowUp: orbitKey(0, 0.08), ArrowDown: orbitKey(0, -0.08),
  };
  const STEP_KEYS = { ArrowLeft: (v) => v.step(-1), ArrowRight: (v) => v.step(1) };
  const KEYS = {
    " ": (v) => v.setPlaying(!v.playing), Home: (v) => v.resetView(),
    "+": zoomKey(1.15), "=": zoomKey(1.15), "-": zoomKey(1 / 1.15), _: zoomKey(1 / 1.15),
    "[": (v) => v.stepAction(-1), "]": (v) => v.stepAction(1),
  };

  return { Viewer };
})();
