// The motion viewer: real motions above, generated ones below, in one canvas with one clock and one camera.
// Limbs are tapered cylinders lit from the upper left, painted from far to near.
const viewer = (() => {
  const [MIDDLE, LEFT, RIGHT] = [0, 1, 2];  // sides of joints, and the parts of a body that have a colour each
  const TRUNK_PART = 3, PARTS = 4;

  const clamp = (v, low, high) => Math.min(high, Math.max(low, v));

  // --- Bodies: from joint names and positions to solids -------------------------------------------

  /** The side that a joint's name tells: "left hip", "LHip", "l_hip", "hip.L". */
  function sideOf(name) {
    const lower = name.toLowerCase();
    if (lower.includes("left")) return LEFT;
    if (lower.includes("right")) return RIGHT;
    const letter = /^([lr])[^a-z]|[^a-z]([lr])$/.exec(lower) ?? /^([LR])[A-Z]/.exec(name);
    const found = letter && (letter[1] ?? letter[2]).toLowerCase();
    return found === "l" ? LEFT : found === "r" ? RIGHT : MIDDLE;
  }

  /** The joints, every parent before its children. */
  function parentsFirst(parents) {
    const depth = (j) => { let d = 0; while ((j = parents[j]) >= 0 && d < parents.length) ++d; return d; };
    return parents.map((_, j) => [depth(j), j]).sort((a, b) => a[0] - b[0] || a[1] - b[1]).map((pair) => pair[1]);
  }

  /** What the tree and its names tell: {parents, order, children, sides, head, crown}. */
  function readTopology({ parents, names }) {
    const order = parentsFirst(parents);
    const children = parents.map((_, j) => order.filter((c) => parents[c] === j));
    const sides = new Array(parents.length).fill(MIDDLE);
    for (const j of order) sides[j] = sideOf(names[j] ?? "") || (parents[j] >= 0 ? sides[parents[j]] : MIDDLE);
    const head = order.find((j) => (names[j] ?? "").toLowerCase().includes("head")) ?? -1;
    const tip = head >= 0 && children[head].length === 1 ? children[head][0] : -1;
    const crown = tip >= 0 && !children[tip].length ? tip : -1;
    return { parents, order, children, sides, head, crown };
  }

  const at = (motion, frame, person, joint) => ((frame * motion.persons + person) * motion.joints + joint) * 3;

  /** Lengths of a person's limbs, the mean of a few frames. */
  function limbLengths(motion, parents, person) {
    const frames = [0, 0.25, 0.5, 0.75].map((f) => Math.floor(f * motion.frames)), x = motion.positions;
    return parents.map((parent, j) => parent < 0 ? 0 : data.sum(frames.map((f) => {
      const a = at(motion, f, person, j), b = at(motion, f, person, parent);
      return Math.hypot(x[a] - x[b], x[a + 1] - x[b + 1], x[a + 2] - x[b + 2]);
    })) / frames.length);
  }

  /** Where arms and legs begin, [shoulder, hip] a side; a clavicle, much shorter than what follows, is no arm. */
  function limbRoots(tree, motion, lengths) {
    const begin = (j) => {
      while (tree.children[j].length === 1) {
        const next = tree.children[j][0], after = tree.children[next][0];
        if (after === undefined || lengths[next] > 0.75 * lengths[after]) break;
        j = next;
      }
      return j;
    };
    const height = (j) => motion.positions[at(motion, 0, 0, j) + 1];
    return [LEFT, RIGHT].map((side) => tree.order
      .filter((j) => tree.sides[j] === side && tree.parents[j] >= 0 && tree.sides[tree.parents[j]] === MIDDLE)
      .map(begin).sort((a, b) => height(b) - height(a)))
      .filter((roots) => roots.length === 2);
  }

  /** The joints from the root to where arms and legs begin, the ends left out. */
  function trunkOf(tree, roots) {
    const trunk = new Set([tree.order[0]]);
    for (const root of roots.flat())
      for (let j = tree.parents[root]; j >= 0; j = tree.parents[j]) if (tree.sides[j] === MIDDLE) trunk.add(j);
    return trunk;
  }

  /** Solids of one body, {a, b, part, leaf, ball}, from joint a to joint b; the head is a ball at b. */
  function solidsOf(tree, roots, trunk) {
    const part = (j) => (roots.length < 2 ? LEFT : trunk.has(j) ? TRUNK_PART : tree.sides[j]);
    const solids = tree.order.filter((j) => tree.parents[j] >= 0).map((j) =>
      ({ a: tree.parents[j], b: j, part: part(tree.parents[j]), leaf: !tree.children[j].length, ball: false }));
    // Flanks make the trunk as broad as a chest is, broader than deep.
    for (const [shoulder, hip] of roots) solids.push({ a: shoulder, b: hip, part: TRUNK_PART, leaf: false, ball: false });
    if (tree.head >= 0 && tree.parents[tree.head] >= 0)
      solids.push({ a: tree.parents[tree.head], b: tree.head, part: part(tree.head), leaf: true, ball: true });
    return solids;
  }

  /** How far each joint is from the tips beyond it, in metres along the limbs. */
  function lengthsBeyond(tree, lengths) {
    const beyond = lengths.map(() => 0);
    for (const j of [...tree.order].reverse())
      if (tree.parents[j] >= 0) beyond[tree.parents[j]] = Math.max(beyond[tree.parents[j]], beyond[j] + lengths[j]);
    return beyond;
  }

  // Shares of the body's reach, root to furthest tip, 1.2 m in an adult: toes and fingers, hips and
  // shoulders, neck, trunk, flanks, head.
  const THIN = 0.017, THICK = 0.041, NECK = 0.036, TRUNK = 0.074, FLANK = 0.06, HEAD = 0.086;

  /** [radius at a, radius at b] in metres for each solid of one person. */
  function radiiOf(tree, solids, trunk, lengths) {
    const beyond = lengthsBeyond(tree, lengths), reach = beyond[tree.order[0]] || 1;
    const radius = (j) => {
      const limb = reach * (THIN + THICK * Math.min(1, beyond[j] / (0.62 * reach)));
      return trunk.has(j) ? TRUNK * reach : tree.sides[j] === MIDDLE ? Math.max(NECK * reach, Math.min(limb, NECK * reach)) : limb;
    };
    return solids.flatMap(({ a, b, ball }) => {
      if (ball) return [HEAD * reach, HEAD * reach];
      if (tree.parents[b] !== a) return [FLANK * reach, 1.12 * FLANK * reach];
      // A limb that leaves a thicker part begins little thicker than it ends: no cones out of the chest.
      return [Math.min(radius(a), 1.45 * radius(b)), radius(b)];
    });
  }

  // --- Figures: a motion with all that drawing it needs -------------------------------------------

  function percentile(values, share) {
    const sorted = [...values].sort((a, b) => a - b);
    return sorted[Math.round(share * (sorted.length - 1))];
  }
  const eachFrame = (motion, make) => Array.from({ length: motion.frames }, (_, f) => make(f));

  /** The range of joints' offsets of one frame: `use(offset)` for every joint. */
  function forJoints(motion, frame, use) {
    const first = at(motion, frame, 0, 0), end = first + motion.persons * motion.joints * 3;
    for (let i = first; i < end; i += 3) use(i);
  }

  /** {x, z} the middle of the joints, floor and top heights, and the radius that holds the group at any turn. */
  function boundsOf(motion) {
    const x = motion.positions, count = x.length / 3;
    let sumX = 0, sumZ = 0;
    for (let i = 0; i < x.length; i += 3) { sumX += x[i]; sumZ += x[i + 2]; }
    const centre = { x: sumX / count, z: sumZ / count };
    const lowest = [], highest = [], widest = [];
    for (let f = 0; f < motion.frames; ++f) {
      let low = Infinity, high = -Infinity, wide = 0;
      forJoints(motion, f, (i) => {
        low = Math.min(low, x[i + 1]);
        high = Math.max(high, x[i + 1]);
        wide = Math.max(wide, Math.hypot(x[i] - centre.x, x[i + 2] - centre.z));
      });
      lowest.push(low), highest.push(high), widest.push(wide);
    }
    // A joint lost for a frame or two must not shrink the picture nor lift the feet off the floor.
    return { ...centre, floor: percentile(lowest, 0.05), top: percentile(highest, 0.97), radius: percentile(widest, 0.97) };
  }

  /** Adds up the horizontal directions that bodies face, from the lines between their sides' limb roots. */
  function facing(motion, roots) {
    let x = 0, z = 0, bodies = 0;
    if (roots.length < 2) return { x, z, bodies: 1 };
    for (let f = 0; f < motion.frames; f += 5) for (let p = 0; p < motion.persons; ++p) {
      let toX = 0, toZ = 0;
      for (const i of [0, 1]) {
        const left = at(motion, f, p, roots[0][i]), right = at(motion, f, p, roots[1][i]);
        toX += motion.positions[right] - motion.positions[left];
        toZ += motion.positions[right + 2] - motion.positions[left + 2];
      }
      const length = Math.hypot(toX, toZ) || 1;
      x += toZ / length;  // up x right = ahead
      z -= toX / length;
      ++bodies;
    }
    return { x, z, bodies };
  }

  /** The horizontal vector between the two persons furthest apart in the middle of the motion. */
  function longestLine(motion) {
    const frame = motion.frames >> 1, best = { x: 0, z: 0 };
    for (let p = 0; p < motion.persons; ++p) for (let q = p + 1; q < motion.persons; ++q) {
      const a = at(motion, frame, p, 0), b = at(motion, frame, q, 0);
      const x = motion.positions[b] - motion.positions[a], z = motion.positions[b + 2] - motion.positions[a + 2];
      if (Math.hypot(x, z) > Math.hypot(best.x, best.z)) Object.assign(best, { x, z });
    }
    return best;
  }

  /** The angle from which faces are seen; two who face each other are seen across the line between them. */
  function frontOf(motion, roots) {
    const ahead = facing(motion, roots), line = longestLine(motion);
    if (Math.hypot(ahead.x, ahead.z) > 0.5 * ahead.bodies || Math.hypot(line.x, line.z) < 1e-3)
      return Math.atan2(ahead.x, ahead.z);
    const across = line.z * ahead.x - line.x * ahead.z < 0 ? -1 : 1;
    return Math.atan2(across * line.z, across * -line.x);
  }

  /** Flanks and long limbs give a body its shadow; fingers and the rest of the trunk would only cost time. */
  function castsShadow(tree, { a, b, part, ball }, lengths) {
    if (ball) return false;
    const flank = tree.parents[b] !== a, longest = Math.max(...lengths);
    return flank || (part !== TRUNK_PART && lengths[b] > 0.28 * longest);
  }

  /** A motion made ready: solids, radii, bounds and the arrays that its frames are worked out in. */
  function makeFigure(motion, topology) {
    const tree = readTopology(topology);
    const people = Array.from({ length: motion.persons }, (_, p) => limbLengths(motion, tree.parents, p));
    const roots = limbRoots(tree, motion, people[0]), trunk = trunkOf(tree, roots), solids = solidsOf(tree, roots, trunk);
    const count = solids.length * motion.persons;
    return {
      motion, solids, casts: solids.filter((s) => castsShadow(tree, s, people[0])), bounds: boundsOf(motion), front: frontOf(motion, roots),
      radii: Float32Array.from(people.flatMap((lengths) => radiiOf(tree, solids, trunk, lengths))),
      world: new Float32Array(motion.persons * motion.joints * 3),
      screen: new Float32Array(motion.persons * motion.joints * 3),  // pixels right, pixels down, metres nearer
      order: Int16Array.from({ length: count }, (_, i) => i),
      nearness: new Float32Array(count),
    };
  }

  /** Joint positions at `time`, between the frames that were captured; each motion loops on its own. */
  function pose(figure, time) {
    const { motion, world } = figure, x = motion.positions, size = world.length;
    const place = (time * motion.fps) % motion.frames, frame = Math.min(Math.floor(place), motion.frames - 1);
    const next = Math.min(frame + 1, motion.frames - 1), share = place - frame;
    for (let i = 0; i < size; ++i) {
      const here = x[frame * size + i];
      world[i] = here + share * (x[next * size + i] - here);
    }
  }

  /** `world` as seen: the camera is orthographic, so that sizes compare across the cells. */
  function project({ world, screen, bounds }, eye) {
    for (let i = 0; i < world.length; i += 3) {
      const x = world[i] - bounds.x, y = world[i + 1] - bounds.floor, z = world[i + 2] - bounds.z;
      const level = x * eye.sin + z * eye.cos;
      screen[i] = eye.x + eye.scale * (x * eye.cos - z * eye.sin);
      screen[i + 1] = eye.y - eye.scale * (y * eye.cosUp - level * eye.sinUp);
      screen[i + 2] = level * eye.cosUp + y * eye.sinUp;
    }
  }

  /** Sorts solids from far to near. They hardly change between frames: insertion sort is quick and stable. */
  function sortSolids({ solids, motion, screen, order, nearness, radii }) {
    for (let i = 0; i < order.length; ++i) {
      const solid = solids[i % solids.length], first = Math.floor(i / solids.length) * motion.joints;
      const near = 0.5 * (screen[(first + solid.a) * 3 + 2] + screen[(first + solid.b) * 3 + 2]);
      // A head counts as near as the nearer end of the neck, which would otherwise run over its face.
      nearness[i] = 0.3 * radii[2 * i + 1] +
        (solid.ball ? Math.max(screen[(first + solid.a) * 3 + 2], screen[(first + solid.b) * 3 + 2]) : near);
    }
    for (let i = 1; i < order.length; ++i) {
      const moved = order[i];
      let j = i;
      for (; j > 0 && nearness[order[j - 1]] > nearness[moved]; --j) order[j] = order[j - 1];
      order[j] = moved;
    }
  }

  // --- Paint --------------------------------------------------------------------------------------

  // A person's head and trunk, left limbs, right limbs: the colours of `actformer render`.
  const PEOPLE = [
    ["#39518a", "#2f80ed", "#1fb6a6"], ["#a3431b", "#eb5e28", "#f4a91f"], ["#5b3a8c", "#8b5cf6", "#d75bc0"],
    ["#2c6b3f", "#2fa55a", "#9cc23c"], ["#8a2545", "#d1345b", "#f08a8a"], ["#4a4f59", "#6b7280", "#a3abb8"],
  ].map(([middle, left, right]) => [middle, left, right, middle]);  // in the order of parts
  const LIGHT = { x: -0.42, y: -0.58, z: 0.7 };
  const DEPTHS = 4, TURNS = 9, STOPS = [-1, -0.85, -0.5, -0.15, 0.2, 0.55, 0.85, 1];

  const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
  const mix = (a, b, share) => a.map((v, i) => v + (b[i] - v) * share);
  const css = (colour, alpha = 1) => `rgb(${colour.map((v) => Math.round(Math.min(255, v))).join(" ")} / ${alpha})`;

  /** `colour` where the light falls at cosine `towards` and the surface faces the eye at cosine `facingEye`. */
  function lit(colour, towards, facingEye) {
    const light = Math.max(0, towards), edge = Math.min(1, facingEye / 0.5);
    const shade = (0.62 + 0.44 * light) * (0.78 + 0.22 * edge);
    return colour.map((v) => v * shade + 26 * light ** 5);
  }

  /**
   * Across a limb of radius 1 whose normal at +1 has cosine `across` with the light in the picture's plane.
   * The solids of a trunk are `flat`: shaded as one broad body rather than as a bundle of cylinders.
   */
  function limbTone(context, colour, across, flat) {
    const tone = context.createLinearGradient(0, -1, 0, 1);
    for (const y of STOPS) {
      const bent = flat ? 0.35 * y : y, z = Math.sqrt(1 - bent * bent);
      tone.addColorStop((y + 1) / 2, css(lit(colour, bent * across + z * LIGHT.z, z)));
    }
    return tone;
  }

  function ballTone(context, colour) {
    const tone = context.createRadialGradient(0.55 * LIGHT.x, 0.55 * LIGHT.y, 0, 0, 0, 1.12);
    for (const r of [0, 0.25, 0.5, 0.75, 0.9, 1]) tone.addColorStop(r, css(lit(colour, 1 - 0.85 * r * r, 1.05 - r)));
    return tone;
  }

  /** Everything of a theme that strokes and fills use, made once: the frame loop makes no object. */
  function makePaint(context, element) {
    const style = getComputedStyle(element), read = (name) => style.getPropertyValue(name).trim();
    const paper = rgb(read("--paper")), sine = Math.hypot(LIGHT.x, LIGHT.y);
    const limbs = [], balls = [], rims = [];
    PEOPLE.flat().map(rgb).forEach((colour, i) => {
      rims.push(css(mix(colour, [8, 12, 22], 0.72)));
      for (let depth = 0; depth < DEPTHS; ++depth) {
        const hazy = mix(colour, paper, 0.3 * (1 - depth / (DEPTHS - 1)));
        balls.push(ballTone(context, hazy));
        for (let turn = 0; turn < TURNS; ++turn)
          limbs.push(limbTone(context, hazy, sine * ((2 * turn) / (TURNS - 1) - 1), i % PARTS === TRUNK_PART));
      }
    });
    const fading = (name, alpha) => {
      const fade = context.createRadialGradient(0, 0, 0, 0, 0, 1), colour = rgb(read(name));
      for (const [r, share] of [[0, 1], [0.45, 0.85], [1, 0]]) fade.addColorStop(r, css(colour, alpha * share));
      return fade;
    };
    return { limbs, balls, rims, ink: read("--ink"), quiet: read("--quiet"), rule: read("--rule"),
      floor: fading("--floor", 1), grid: fading("--floor-line", 1), shadow: fading("--shadow", 0.3) };
  }

  /** The sides and ends of a cone along x, in units of its larger radius, each `rim` wider. */
  function conePath(context, length, ra, rb, rim, endA, endB) {
    const angle = Math.acos(Math.max(-1, Math.min(1, (ra - rb) / length)));
    const cos = Math.cos(angle), sin = Math.sin(angle), a = ra + rim, b = rb + rim;
    context.beginPath();
    if (endA) context.arc(0, 0, a, angle, 2 * Math.PI - angle);
    else {
      context.moveTo(a * cos, a * sin);
      context.lineTo(a * cos, -a * sin);
    }
    if (endB) context.arc(length, 0, b, -angle, angle);
    else {
      context.lineTo(length + b * cos, -b * sin);
      context.lineTo(length + b * cos, b * sin);
    }
    context.closePath();
    context.fill();
  }

  /** A limb: a dark rim along its sides, and round its end where nothing follows, under its lit surface. */
  function paintLimb(context, paint, tone, solid, ax, ay, ra, bx, by, rb, rim) {
    const length = Math.hypot(bx - ax, by - ay), size = Math.max(ra, rb);
    const ux = length > 1e-3 ? (bx - ax) / length : 1, uy = length > 1e-3 ? (by - ay) / length : 0;
    // Seen end on, one end hides the other: a cone of no length is the larger ball.
    const long = Math.max(length, Math.abs(ra - rb) + 1e-3) / size;
    context.setTransform(ux * size, uy * size, -uy * size, ux * size, ax, ay);
    if (solid.part !== TRUNK_PART) {
      context.fillStyle = paint.rims[Math.floor(tone / DEPTHS)];
      conePath(context, long, ra / size, rb / size, rim / size, false, solid.leaf);
    }
    const across = -uy * LIGHT.x + ux * LIGHT.y;  // the normal at +y against the light
    const turn = Math.round(((across / Math.hypot(LIGHT.x, LIGHT.y) + 1) / 2) * (TURNS - 1));
    context.fillStyle = paint.limbs[tone * TURNS + turn];
    conePath(context, long, ra / size, rb / size, 0, true, true);
  }

  /** A head: an egg along the neck, rimmed all around. */
  function paintHead(context, paint, tone, ax, ay, bx, by, radius, rim) {
    const angle = Math.atan2(by - ay, bx - ax);
    context.setTransform(radius, 0, 0, radius, bx, by);
    for (const wider of [rim / radius, 0]) {
      context.fillStyle = wider ? paint.rims[Math.floor(tone / DEPTHS)] : paint.balls[tone];
      context.beginPath();
      context.ellipse(0, 0, 1.12 + wider, 0.92 + wider, angle, 0, 2 * Math.PI);
      context.fill();
    }
  }

  function paintBodies(context, paint, figure, eye) {
    const { solids, motion, screen, order, radii, bounds } = figure, rim = Math.max(0.6, 0.007 * eye.scale);
    for (let n = 0; n < order.length; ++n) {
      const i = order[n], solid = solids[i % solids.length], person = Math.floor(i / solids.length);
      const a = (person * motion.joints + solid.a) * 3, b = (person * motion.joints + solid.b) * 3;
      // The haze of distance is a whole person's: limbs of one body keep one colour.
      const share = 0.75 + screen[person * motion.joints * 3 + 2] / (2 * bounds.radius + 1);
      const depth = clamp(Math.round(share * (DEPTHS - 1)), 0, DEPTHS - 1);
      const tone = ((person % PEOPLE.length) * PARTS + solid.part) * DEPTHS + depth;
      const ra = radii[2 * i] * eye.scale, rb = radii[2 * i + 1] * eye.scale;
      if (solid.ball) paintHead(context, paint, tone, screen[a], screen[a + 1], screen[b], screen[b + 1], rb, rim);
      else paintLimb(context, paint, tone, solid, screen[a], screen[a + 1], ra, screen[b], screen[b + 1], rb, rim);
    }
  }

  /** Makes the floor's metres, x and z from the group's centre, the canvas' units; `size` metres are one unit. */
  function onFloor(context, eye, x, z, ux, uz, along, across) {
    const right = (fx, fz) => eye.scale * (fx * eye.cos - fz * eye.sin);
    const down = (fx, fz) => eye.scale * (fx * eye.sin + fz * eye.cos) * eye.sinUp;
    context.setTransform(right(ux, uz) * along, down(ux, uz) * along, right(-uz, ux) * across, down(-uz, ux) * across,
      eye.x + right(x, z), eye.y + down(x, z));
  }

  const SPACING = 0.5;  // metres between the lines of the floor

  /** A disc of `size` metres around the group that fades out, with lines. */
  function paintFloor(context, paint, figure, eye, size) {
    const ux = Math.cos(figure.front), uz = -Math.sin(figure.front);  // lines run as the group faces
    onFloor(context, eye, 0, 0, ux, uz, size, size);
    context.fillStyle = paint.floor;
    context.beginPath();
    context.arc(0, 0, 1, 0, 2 * Math.PI);
    context.fill();
    context.beginPath();
    for (let line = Math.ceil(-size / SPACING); line <= size / SPACING; ++line) {
      const place = (line * SPACING) / size, half = Math.sqrt(Math.max(0, 1 - place * place));
      context.moveTo(place, -half);
      context.lineTo(place, half);
      context.moveTo(-half, place);
      context.lineTo(half, place);
    }
    context.strokeStyle = paint.grid;
    context.lineWidth = 1 / (size * eye.scale);
    context.stroke();
  }

  const SHADOW_HEIGHT = 1.5;  // metres above the floor at which nothing of a shadow is left

  /** A soft blot under each solid that casts one, paler and wider the higher it is: light from straight above. */
  function paintShadow(context, paint, { casts, motion, world, bounds }, eye) {
    context.fillStyle = paint.shadow;
    for (let i = 0; i < casts.length * motion.persons; ++i) {
      const solid = casts[i % casts.length], first = Math.floor(i / casts.length) * motion.joints;
      const a = (first + solid.a) * 3, b = (first + solid.b) * 3;
      const height = Math.max(0, 0.5 * (world[a + 1] + world[b + 1]) - bounds.floor);
      if (height > SHADOW_HEIGHT) continue;
      const dx = world[b] - world[a], dz = world[b + 2] - world[a + 2], length = Math.hypot(dx, dz);
      const wide = 0.11 + 0.06 * height;
      const ux = length > 1e-4 ? dx / length : 1, uz = length > 1e-4 ? dz / length : 0;
      onFloor(context, eye, 0.5 * (world[a] + world[b]) - bounds.x, 0.5 * (world[a + 2] + world[b + 2]) - bounds.z,
        ux, uz, length / 2 + wide, wide);
      context.globalAlpha = 1 - height / SHADOW_HEIGHT;
      context.beginPath();
      context.arc(0, 0, 1, 0, 2 * Math.PI);
      context.fill();
    }
    context.globalAlpha = 1;
  }

  // --- The stage: cells, camera, clock ------------------------------------------------------------

  const START = { azimuth: -0.55, elevation: 0.2, zoom: 1 };
  const BAND = 26, TITLE = 20;  // heights of a band's heading and of a cell's title, pixels
  /** Cells of both bands: {bands: [{name, y, empty}], cells: [{x, y, width, height, figure}], height}. */
  function layout(sets, width) {
    const most = Math.max(1, ...sets.map((s) => s.figures.length));
    const columns = Math.min(most, width < 560 ? 2 : 4);
    const cellWidth = width / columns, cellHeight = clamp(cellWidth * 1.05, 190, columns > 2 ? 300 : 360);
    const bands = [], cells = [];
    let y = 0;
    for (const { name, figures, empty } of sets) {
      bands.push({ name, y, empty: figures.length ? "" : empty });
      y += BAND;
      figures.forEach((figure, i) => cells.push({ figure, x: (i % columns) * cellWidth,
        y: y + Math.floor(i / columns) * (cellHeight + TITLE), width: cellWidth, height: cellHeight }));
      y += figures.length ? Math.ceil(figures.length / columns) * (cellHeight + TITLE) : 40;
    }
    return { bands, cells, height: Math.ceil(y) };
  }

  /**
   * {scale, tall, floor}: pixels a metre at which the largest group fits its cell however it is turned, the
   * height of the tallest and the floor's radius in metres. All cells share them: sizes compare, floors lie level.
   */
  function fit(cells) {
    if (!cells.length) return { scale: 1, tall: 1, floor: 1 };
    const cos = Math.cos(START.elevation), sin = Math.sin(START.elevation), margin = 0.12;
    const tall = Math.max(...cells.map(({ figure: { bounds } }) => bounds.top - bounds.floor)) + margin;
    const wide = Math.max(...cells.map(({ figure: { bounds } }) => bounds.radius)) + margin;
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
      const { context, dense, eye } = this, { figure } = cell;
      context.setTransform(dense, 0, 0, dense, 0, 0);
      context.save();
      context.beginPath();
      context.rect(cell.x, cell.y, cell.width, cell.height);
      context.clip();
      this.aim(eye, cell, figure);
      pose(figure, this.time);
      project(figure, eye);
      sortSolids(figure);
      paintFloor(context, this.paint, figure, eye, this.fit.floor);
      paintShadow(context, this.paint, figure, eye);
      paintBodies(context, this.paint, figure, eye);
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
        context.font = "600 14px system-ui, sans-serif";
        context.fillText(band.name, 12, band.y + BAND / 2 + 2);
        context.fillStyle = paint.rule;
        if (band.y) context.fillRect(0, band.y, width, 1);
        context.fillStyle = paint.quiet;
        context.font = "13px system-ui, sans-serif";
        if (band.empty) context.fillText(band.empty, 12, band.y + BAND + 16);
      }
      context.textAlign = "center";
      context.font = "12px system-ui, sans-serif";
      for (const { figure, x, y, width: across, height } of place.cells)
        context.fillText(figure.motion.title, x + across / 2, y + height + TITLE / 2 - 2, across - 12);
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

    /** Shows `sets`, [{name, figures, empty}]; the clock goes to a third of the longest motion, paused. */
    show(sets, words) {
      const motions = sets.flatMap((s) => s.figures.map((f) => f.motion));
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

  return { Viewer, makeFigure };
})();
