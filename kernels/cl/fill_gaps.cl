// Gap filling: every output frame is a blend of two detections.
//
// Data layout
//   times   (detections)        float  when each detection was made, rising within a sequence
//   first   (clips*P + 1)       uint   detections of sequence s = clip*P + person: first[s] .. first[s+1]-1
//   start   (clips + 1)         uint   output frames of a clip: start[clip] .. start[clip+1]-1
//   step    (clips)             float  output frame t of a clip shows time t * step
//   owner   (frames)            uint   the clip of each output frame
//   pair    (frames, P)         uint2  the detections before and after
//   weight  (frames, P)         float  how much of the one after
//   limbs   (detections, C)     float  C = K*3 numbers a body
//   rows    (frames, P, pitch)  float  pitch = C rounded up to 16, the rest zero

// One work-item a (person, frame): binary search for the detections around the frame's time.
kernel void locate(global const float* times, global const uint* first, global const uint* start,
                   global const float* step, global const uint* owner, global uint2* pair,
                   global float* weight, uint persons, uint frames) {
    const uint person = get_global_id(0), frame = get_global_id(1);
    if (person >= persons || frame >= frames) return;
    const uint clip = owner[frame];
    const float time = (float)(frame - start[clip]) * step[clip];

    uint below = first[clip * persons + person];  // the last detection not after `time`, or the first of all
    uint above = first[clip * persons + person + 1];  // the one behind it, or the end
    const uint end = above;
    while (above - below > 1) {
        const uint middle = below + (above - below) / 2;
        if (times[middle] <= time)
            below = middle;
        else
            above = middle;
    }
    const uint next = min(below + 1, end - 1);
    const float span = times[next] - times[below];
    // Before the first detection the blend would reach below 0: the clamp holds it; after the last, span is 0.
    pair[frame * persons + person] = (uint2)(below, next);
    weight[frame * persons + person] = span > 0 ? clamp((time - times[below]) / span, 0.0f, 1.0f) : 0.0f;
}

// One work-item a (16 numbers, row).
kernel void blend(global const float* limbs, global const uint2* pair, global const float* weight,
                  global float* rows, uint numbers, uint rows_count) {
    const uint chunk = get_global_id(0), row = get_global_id(1);
    const uint chunks = (numbers + 15) / 16;
    if (chunk >= chunks || row >= rows_count) return;
    const uint2 at = pair[row];
    const float w = weight[row];
    global const float* before = limbs + (size_t)at.x * numbers + chunk * 16;
    global const float* after = limbs + (size_t)at.y * numbers + chunk * 16;
    global float* out = rows + ((size_t)row * chunks + chunk) * 16;

    const uint valid = min(16u, numbers - chunk * 16);
    if (valid == 16) {
        const float16 a = vload16(0, before);
        vstore16(w == 0 ? a : a + w * (vload16(0, after) - a), 0, out);
    } else {
        for (uint i = 0; i < 16; ++i) out[i] = i >= valid ? 0.0f : before[i] + w * (after[i] - before[i]);
    }
}
