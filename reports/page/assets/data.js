// Decoding: from the report's JSON to typed arrays and plain numbers. Nothing here touches the page.
const data = (() => {
  /** Little-endian 16-bit numbers from base64, on any machine; `Type` is Int16Array or Uint16Array. */
  function decode16(base64, Type) {
    const bytes = atob(base64);
    const out = new Type(bytes.length >> 1);
    for (let i = 0; i < out.length; ++i)
      out[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
    return out;
  }

  /** Joint positions in metres, (frames, persons, joints, 3); null where the motion is not whole. */
  function decodeMotion(motion, joints) {
    const raw = decode16(motion.xyz, Int16Array);
    if (motion.frames < 1 || raw.length !== motion.frames * motion.persons * joints * 3) return null;
    const positions = new Float32Array(raw.length);
    for (let i = 0; i < raw.length; ++i) positions[i] = motion.origin[i % 3] + motion.scale * raw[i];
    const { label, title, persons, frames, fps } = motion;
    return { label, title, persons, frames, joints, fps: fps > 0 ? fps : 30, positions };
  }

  /** A point cloud {x, y, labels}; one unit of int16 is 1/4096 of a standardised axis. */
  function decodePoints(points) {
    const xy = decode16(points.xy, Int16Array), labels = decode16(points.labels, Uint16Array);
    const count = Math.min(xy.length >> 1, labels.length);
    const x = new Float32Array(count), y = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
      x[i] = xy[2 * i] / 4096;
      y[i] = xy[2 * i + 1] / 4096;
    }
    return { x, y, labels };
  }

  /** Remembers what `make` gave for an object; each motion and cloud is decoded once, when first shown. */
  function remembered(make) {
    const known = new WeakMap();
    return (object, ...rest) => {
      if (!known.has(object)) known.set(object, make(object, ...rest));
      return known.get(object);
    };
  }
  const motionOf = remembered(decodeMotion), pointsOf = remembered(decodePoints);

  /** One motion of each action that has any, so that columns show an action each. */
  function oneEach(motions, actions) {
    return actions.map((action) => motions.find((m) => m.label === action)).filter(Boolean);
  }

  /** Up to `most` motions a side of `action`, or of as many actions for -1: {topology, real, generated}. */
  function motionsOf(report, row, action, most) {
    if (!row.motions) return null;
    const topology = report.topologies[row.motions.topology];
    if (!topology) return null;
    const real = report.motion_sets[row.motions.real] || [], made = report.motion_sets[row.motions.generated] || [];
    const labels = [...new Set([...made, ...real].map((m) => m.label))];
    const both = labels.filter((l) => real.some((m) => m.label === l) && made.some((m) => m.label === l));
    const shown = (both.length ? both : labels).slice(0, most);
    const choose = (set) =>
      (action < 0 ? oneEach(set, shown) : set.filter((m) => m.label === action).slice(0, most))
        .map((m) => motionOf(m, topology.parents.length)).filter(Boolean);
    return { topology, real: choose(real), generated: choose(made) };
  }

  const sum = (values) => values.reduce((a, b) => a + b, 0);

  /** The `most` largest cells off the diagonal by share of their row: {asked, recognised, count, of}. */
  function commonConfusions(confusion, most) {
    const all = [];
    confusion.forEach((line, asked) => {
      const of = sum(line);
      line.forEach((count, recognised) => {
        if (count > 0 && recognised !== asked) all.push({ asked, recognised, count, of });
      });
    });
    return all.sort((a, b) => b.count / b.of - a.count / a.of || b.count - a.count).slice(0, most);
  }

  /** Class indices, the worst by `column` first; classes without the figure come last. As they are without a column. */
  function classOrder(perClass, column) {
    const indices = perClass.map((_, i) => i);
    if (!column) return indices;
    const key = (i) => {
      const value = perClass[i][column.key];
      return value == null ? Infinity : column.better === "higher" ? value : -value;
    };
    return indices.sort((a, b) => (key(a) === key(b) ? a - b : key(a) - key(b)));
  }

  const present = (value) => typeof value === "number" && Number.isFinite(value);

  /** `value` with three digits or so: 12.5, 3.57, 0.0412, 1240. */
  function figure(value) {
    const size = Math.abs(value);
    const digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 || size === 0 ? 2 : 4;
    return value.toFixed(digits).replace("-", "−");
  }

  const capital = (words) => words.charAt(0).toUpperCase() + words.slice(1);

  return { motionsOf, pointsOf, commonConfusions, classOrder, present, figure, capital, sum };
})();
