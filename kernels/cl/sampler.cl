// Batches of windows out of clips that lie on the device (philox.cl stands before this file).
//
// Data layout
//   motion      (frames, P, K, C)     float  K nodes of C numbers, clips one after the other
//   clip        (clips)               uint4  first frame, frames, label, 0
//   by_class    (clips)               uint   clips ordered by label
//   class_first (drawn + 1)           uint   clips of the i-th class that has any: by_class[class_first[i]] ...
//   class_edge  (drawn)               ulong  running sum of the classes' weights, its own weight included
//   window      (windows)             uint2  clip, first frame
//   values      (samples, P*C, T, K)  float
//   labels      (samples)             uint
//   picks       (samples)             uint2  clip, first frame: what was drawn
//
// Random words, key the seed: counter (block, first_sample + sample, batch low, batch high). Block 0 holds a 64-bit number for the class,
// a word for the clip and a word for the first frame; blocks from 1 on hold a word for each swap of persons. A number
// below n is the high half of word * n: its bias, n in 2^32 (for the class in 2^64), is beyond any sample to see.
//
// Windows are centred where `share` is 1 / (T * P): the position in the first three numbers of node `root`, its mean over the
// window's frames and persons, is taken from those of `moved` nodes from `first_moved` on. 0 leaves them. Sums run in one order
// and nothing is contracted, so that all devices agree to the bit.

#pragma OPENCL FP_CONTRACT OFF

// The frame shown at `t`: `start` on, and where the clip ends before, 0 1 .. n-1 n-2 .. 1 0 1 .., or with `hold` n-1 n-1 ..
uint shown(uint start, uint t, uint frames, uint hold) {
    if (start + t < frames) return start + t;
    if (hold) return frames - 1;
    if (frames == 1) return 0;
    const uint period = 2 * (frames - 1), phase = t % period;
    return phase < frames ? phase : period - phase;
}

// The root's mean over the frames shown and all persons.
float3 mean_root(global const float* clip, uint start, uint frames, uint hold, uint window, uint persons,
                 uint nodes, uint numbers, uint root, float share) {
    float3 sum = 0;
    for (uint t = 0; share > 0 && t < window; ++t) {
        global const float* at =
            clip + (size_t)shown(start, t, frames, hold) * persons * nodes * numbers + root * numbers;
        for (uint p = 0; p < persons; ++p, at += nodes * numbers) sum += vload3(0, at);
    }
    return sum * share;
}

// One frame of one sample; four bits of `order` a person say whom of the clip to show.
void copy_frame(global const float* from, global float* to, uint t, ulong order, float3 centre,
                uint first_moved, uint moved, uint window, uint persons, uint nodes, uint numbers) {
    const float offset[3] = {centre.x, centre.y, centre.z};
    for (uint p = 0; p < persons; ++p, order >>= 4) {
        global const float* body = from + (uint)(order & 15) * nodes * numbers;
        for (uint c = 0; c < numbers; ++c) {
            global float* row = to + ((size_t)(p * numbers + c) * window + t) * nodes;
            for (uint k = 0; k < nodes; ++k) row[k] = body[k * numbers + c];
            for (uint k = first_moved; c < 3 && k < first_moved + moved; ++k)
                row[k] = body[k * numbers + c] - offset[c];
        }
    }
}

// A permutation of `persons`, each as likely (Fisher and Yates), four bits a person.
ulong draw_order(uint persons, uint4 counter, uint2 key) {
    ulong order = 0xFEDCBA9876543210UL;
    uint words[4];
    for (uint i = persons - 1, used = 0; i > 0 && i < 16; --i, ++used) {
        if (used % 4 == 0) {
            ++counter.x;
            vstore4(philox(counter, key), 0, words);
        }
        const uint j = mul_hi(words[used % 4], i + 1);
        const ulong differ = ((order >> (4 * i)) ^ (order >> (4 * j))) & 15;
        order ^= (differ << (4 * i)) | (i == j ? 0 : differ << (4 * j));
    }
    return order;
}

// The first class whose edge lies above `at`.
uint find_class(global const ulong* class_edge, uint drawn, ulong at) {
    uint below = 0, above = drawn - 1;
    while (below < above) {
        const uint middle = (below + above) / 2;
        if (class_edge[middle] > at)
            above = middle;
        else
            below = middle + 1;
    }
    return below;
}

// One work-item a (frame, sample): each draws its sample's choices anew, which is cheaper than a second launch.
kernel void draw(global const float* motion, global const uint4* clip, global const uint* by_class,
                 global const uint* class_first, global const ulong* class_edge, uint drawn, uint seed_low,
                 uint seed_high, uint batch_low, uint batch_high, uint first_sample, uint permute, uint hold,
                 float share, uint samples, uint window, uint persons, uint nodes, uint numbers, uint root,
                 uint first_moved, uint moved, global float* values, global uint* labels,
                 global uint2* picks) {
    const uint t = get_global_id(0), sample = get_global_id(1);
    if (t >= window || sample >= samples) return;
    const uint2 key = (uint2)(seed_low, seed_high);
    const uint4 counter = (uint4)(0, first_sample + sample, batch_low, batch_high),
                words = philox(counter, key);

    const ulong at = mul_hi(((ulong)words.y << 32) | words.x, class_edge[drawn - 1]);
    const uint class = find_class(class_edge, drawn, at);
    const uint first = class_first[class];
    const uint c = by_class[first + mul_hi(words.z, class_first[class + 1] - first)];
    const uint frames = clip[c].y;
    const uint start = frames > window ? mul_hi(words.w, frames - window + 1) : 0;
    const ulong order = permute ? draw_order(persons, counter, key) : 0xFEDCBA9876543210UL;

    const size_t row = (size_t)persons * nodes * numbers;
    global const float* from = motion + clip[c].x * row;
    const float3 centre = mean_root(from, start, frames, hold, window, persons, nodes, numbers, root, share);
    copy_frame(from + shown(start, t, frames, hold) * row, values + sample * row * window, t, order, centre,
               first_moved, moved, window, persons, nodes, numbers);
    if (t == 0) {
        labels[sample] = clip[c].z;
        picks[sample] = (uint2)(c, start);
    }
}

// One work-item a (frame, sample): sample i shows window[first + i], persons in the clip's order.
kernel void cut(global const float* motion, global const uint4* clip, global const uint2* windows, uint first,
                float share, uint samples, uint window, uint persons, uint nodes, uint numbers, uint root,
                uint first_moved, uint moved, global float* values, global uint* labels,
                global uint2* picks) {
    const uint t = get_global_id(0), sample = get_global_id(1);
    if (t >= window || sample >= samples) return;
    const uint2 pick = windows[first + sample];
    const uint4 c = clip[pick.x];
    const size_t row = (size_t)persons * nodes * numbers;
    global const float* from = motion + c.x * row;
    const float3 centre = mean_root(from, pick.y, c.y, 0, window, persons, nodes, numbers, root, share);
    copy_frame(from + shown(pick.y, t, c.y, 0) * row, values + sample * row * window, t, 0xFEDCBA9876543210UL,
               centre, first_moved, moved, window, persons, nodes, numbers);
    if (t == 0) {
        labels[sample] = c.z;
        picks[sample] = pick;
    }
}
