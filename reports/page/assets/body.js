// Bodies: from a motion's joints and their names to solids that can be drawn, posed and sorted.
const body = (() => {
  const [MIDDLE, LEFT, RIGHT] = [0, 1, 2];  // sides of joints, and the parts of a body that have a colour each
  const TRUNK_PART = 3, PARTS = 4;

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
      return trunk.has(j) ? TRUNK * reach : tree.sides[j] === MIDDLE ? NECK * reach : limb;
    };
    return solids.flatMap(({ a, b, ball }) => {
      if (ball) return [HEAD * reach, HEAD * reach];
      if (tree.parents[b] !== a) return [FLANK * reach, 1.12 * FLANK * reach];
      // A limb that leaves a thicker part begins little thicker than it ends: no cones out of the chest.
      return [Math.min(radius(a), 1.45 * radius(b)), radius(b)];
    });
  }

  // --- Scenes: a motion with all that drawing it needs ---------------------------------------------

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
  function makeScene(motion, topology) {
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
  function pose(scene, time) {
    const { motion, world } = scene, x = motion.positions, size = world.length;
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

  return { PARTS, TRUNK_PART, makeScene, pose, project, sortSolids };
})();
