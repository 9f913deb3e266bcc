// Gaussian smoothing of every coordinate over the frames of its clip, edges mirrored with the edge sample repeated
// (d c b a | a b c d | d c b a).
//
// Data layout
//   taps    (radius + 1)        float  the kernel's centre and its right half
//   start   (clips + 1)         uint   frames of a clip: start[clip] .. start[clip+1]-1
//   owner   (frames)            uint   the clip of each frame
//   in, out (frames, W)         float  W = P * pitch numbers a frame, a multiple of 16

// Frame `t` of a clip of `n` frames, mirrored back into it from wherever it lies.
inline uint mirrored(int t, int n) {
    const int period = 2 * n;
    int m = t % period;
    if (m < 0) m += period;
    return (uint)(m < n ? m : period - 1 - m);
}

// One work-item a (16 numbers, frame).
kernel void smooth(global const float* taps, global const uint* start, global const uint* owner,
                   global const float16* in, global float16* out, uint radius, uint chunks, uint frames) {
    const uint chunk = get_global_id(0), frame = get_global_id(1);
    if (chunk >= chunks || frame >= frames) return;
    const uint begin = start[owner[frame]];
    const int n = (int)(start[owner[frame] + 1] - begin), t = (int)(frame - begin);
    global const float16* column = in + (size_t)begin * chunks + chunk;

    float16 sum = taps[0] * column[(size_t)t * chunks];
    if (t >= (int)radius && t + (int)radius < n) {
        for (int r = 1; r <= (int)radius; ++r)
            sum += taps[r] * (column[(size_t)(t - r) * chunks] + column[(size_t)(t + r) * chunks]);
    } else {
        for (int r = 1; r <= (int)radius; ++r)
            sum += taps[r] * (column[(size_t)mirrored(t - r, n) * chunks] +
                              column[(size_t)mirrored(t + r, n) * chunks]);
    }
    out[(size_t)frame * chunks + chunk] = sum;
}
