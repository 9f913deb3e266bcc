// Paint: limbs as tapered cylinders lit from the upper left, painted from far to near; floor and shadows.
const paint = (() => {
  const { PARTS, TRUNK_PART } = body;
  const clamp = (v, low, high) => Math.min(high, Math.max(low, v));

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

  function paintBodies(context, paint, scene, eye) {
    const { solids, motion, screen, order, radii, bounds } = scene, rim = Math.max(0.6, 0.007 * eye.scale);
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
  function paintFloor(context, paint, scene, eye, size) {
    const ux = Math.cos(scene.front), uz = -Math.sin(scene.front);  // lines run as the group faces
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

  return { clamp, makePaint, paintBodies, paintFloor, paintShadow };
})();
