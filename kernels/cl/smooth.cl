// Gaussian smoothing of every coordinate over the frames of its clip, edges mirrored with the edge sample repeated
// (d c b a | a b c d | d c b a). Frames are blended from detections as they are read, so that filled rows never go to memory.
//
// Data layout
//   taps    (2*radius + 1 + 2*(FRAMES-1))  float  the kernel, FRAMES-1 zeros before and behind
//   block   (blocks)            uint2  clip, and the first of its frames, of FRAMES frames that are made together
//   start   (clips + 1)         uint   frames of a clip: start[clip] .. start[clip+1]-1
//   pair    (frames, P)         uint2  the detections before and after each frame
//   weight  (frames, P)         float  how much of the one after
//   limbs   (detections, C)     float  C = K*3 numbers a body; 48 readable ones behind the last
//   rows    (frames, P, pitch)  float  pitch = C rounded up to 16, 48 at least; of no meaning behind the C numbers
//
// Macros (vectors.cl stands before this file): VEC, at most 16, and FRAMES. A work-item holds VEC * FRAMES sums.

// Frame `t` of a clip of `n` frames, mirrored back into it from wherever it lies.
inline uint mirrored(int t, int n) {
    if ((uint)t < (uint)n) return (uint)t;
    const int period = 2 * n;
    int m = t % period;
    if (m < 0) m += period;
    return (uint)(m < n ? m : period - 1 - m);
}

inline VECTOR filled(global const float* limbs, uint2 pair, float weight, uint numbers) {
    const VECTOR before = LOAD(0, limbs + (size_t)pair.x * numbers);
    if (weight == 0) return before;
    return before + weight * (LOAD(0, limbs + (size_t)pair.y * numbers) - before);
}

// One work-item a (VEC numbers of a person, FRAMES frames): every row it reads goes into all the sums at once.
kernel void smooth(global const float* taps, global const uint2* block, global const uint* start,
                   global const uint2* pair, global const float* weight, global const float* limbs,
                   global float* rows, uint radius, uint persons, uint chunks, uint numbers, uint blocks) {
    const uint column = get_global_id(0), b = get_global_id(1);
    if (column >= persons * chunks || b >= blocks) return;
    const uint person = column / chunks, chunk = column % chunks;
    const uint begin = start[block[b].x];
    const int n = (int)(start[block[b].x + 1] - begin), first = (int)block[b].y;
    global const uint2* pairs = pair + (size_t)begin * persons + person;
    global const float* weights = weight + (size_t)begin * persons + person;

    VECTOR sum[FRAMES];
#pragma unroll
    for (int f = 0; f < FRAMES; ++f) sum[f] = 0;
    const int reach = FRAMES + 2 * (int)radius;
    for (int r = 0; r < reach; ++r) {
        const size_t at = (size_t)mirrored(first + r - (int)radius, n) * persons;
        const VECTOR row = filled(limbs + chunk * VEC, pairs[at], weights[at], numbers);
#pragma unroll
        for (int f = 0; f < FRAMES; ++f) sum[f] = fma((VECTOR)(taps[FRAMES - 1 + r - f]), row, sum[f]);
    }
    // The bound is a constant and the sums stay in registers.
#pragma unroll
    for (int f = 0; f < FRAMES; ++f)
        if (first + f < n)
            STORE(sum[f], ((size_t)(begin + first + f) * persons + person) * chunks + chunk, rows);
}
