// Temporal convolutions of 9 taps by minimal filtering: `split` takes tiles of frames to the points of the filtering, where
// multiply.cl multiplies by the weights, and `join` takes the products back to frames. Padding is 4 frames of zeros.
//
// Data layout
//   frames    (K, rows, pitch)            row n * T + t of joint k's plane; `rows` is padded to whole tiles of the multiply
//   points    (points, tile_rows, pitch)  row (k * sequences + n) * tiles + i for tile i of sequence n
//   bias      (pitch)
//
// Stride 1. Nine taps are 3 groups of 3, and a tile of 18 frames is 6 groups of 3:
//
//   y[18i + 3m + j] = sum_g sum_r w[3g + r] x[18i + 3(m + g) + j + r - 4]
//
// In r and j this is a filter of 3 taps with 3 results, F(3,3): 5 products in place of 9, at the points 0 1 -1 2 and
// infinity. In g and m it is one of 3 taps with 6 results, F(6,3): 8 in place of 18, at 0 1 -1 2 -2 1/2 -1/2 and infinity.
// One in the other makes 40 products for 162. Point (a, b) is number 5a + b.
//
// Stride 2. Even taps meet even frames and odd taps odd ones; each half is a filter of at most 5 taps at stride 1, done by
// F(4,5) with the same 8 points: 16 products for 36. Point a of phase p is number 8p + a; the phases' products are added.
//
// Macro: VEC, channels a work-item handles at once (vectors.cl stands before this file)

// Frame t of the plane's sequence that begins at `from`, zeros before and after it.
VECTOR frame_at(global const float* from, int t, uint frames, uint pitch) {
    return (uint)t < frames ? LOAD(0, from + t * pitch) : (VECTOR)(0.0f);
}

// Five numbers at the 5 points.
void split5(const VECTOR* d, VECTOR* v) {
    v[0] = 2.0f * (d[0] - d[2]) - d[1] + d[3];
    v[1] = d[3] - d[2] - 2.0f * d[1];
    v[2] = d[3] - 3.0f * d[2] + 2.0f * d[1];
    v[3] = d[3] - d[1];
    v[4] = d[4] - d[2] + 2.0f * (d[1] - d[3]);
}

// Five points as three numbers.
void join3(const VECTOR* m, VECTOR* y) {
    const VECTOR even = m[1] + m[2];
    y[0] = m[0] + even + m[3];
    y[1] = m[1] - m[2] + 2.0f * m[3];
    y[2] = even + 4.0f * m[3] + m[4];
}

// Eight numbers at the 8 points.
void split8(const VECTOR* d, VECTOR* v) {
    const VECTOR even1 = d[2] + d[6] - 4.25f * d[4], odd1 = d[1] + d[5] - 4.25f * d[3];
    const VECTOR even2 = 0.25f * d[2] - 1.25f * d[4] + d[6], odd2 = 0.5f * d[1] - 2.5f * d[3] + 2.0f * d[5];
    const VECTOR even3 = 4.0f * d[2] - 5.0f * d[4] + d[6], odd3 = 2.0f * d[1] - 2.5f * d[3] + 0.5f * d[5];
    v[0] = d[0] - d[6] + 5.25f * (d[4] - d[2]);
    v[1] = even1 + odd1;
    v[2] = even1 - odd1;
    v[3] = even2 + odd2;
    v[4] = even2 - odd2;
    v[5] = even3 + odd3;
    v[6] = even3 - odd3;
    v[7] = d[7] - d[1] + 5.25f * (d[3] - d[5]);
}

// Eight points as `results` numbers, 4 or 6.
void join8(const VECTOR* m, VECTOR* y, int results) {
    const VECTOR sum1 = m[1] + m[2], difference1 = m[1] - m[2];
    const VECTOR sum2 = m[3] + m[4], difference2 = m[3] - m[4];
    const VECTOR sum3 = m[5] + m[6], difference3 = m[5] - m[6];
    y[0] = m[0] + sum1 + sum2 + sum3;
    y[1] = difference1 + 2.0f * difference2 + 0.5f * difference3;
    y[2] = sum1 + 4.0f * sum2 + 0.25f * sum3;
    y[3] = difference1 + 8.0f * difference2 + 0.125f * difference3;
    if (results == 4) {
        y[3] += m[7];
    } else {
        y[4] = sum1 + 16.0f * sum2 + 0.0625f * sum3;
        y[5] = difference1 + 32.0f * difference2 + 0.03125f * difference3 + m[7];
    }
}

// One work-item a (vector of channels, tile).
kernel void split(global const float* restrict frames, global float* restrict points, uint sequences, uint length,
                  uint tiles, uint strips, uint rows, uint tile_rows, uint pitch) {
    const uint at = get_global_id(0) * VEC, row = get_global_id(1), strip = row / tiles;
    if (at >= pitch || strip >= strips) return;
    global const float* from =
        frames + ((size_t)(strip / sequences) * rows + strip % sequences * length) * pitch + at;
    global float* to = points + (size_t)row * pitch + at;
    const size_t plane = (size_t)tile_rows * pitch;
    const int start = (int)(row % tiles) * 18 - 4;

    VECTOR at5[5][8];
#pragma unroll
    for (int m = 0; m < 8; ++m) {
        VECTOR d[5], v[5];
#pragma unroll
        for (int q = 0; q < 5; ++q) d[q] = frame_at(from, start + 3 * m + q, length, pitch);
        split5(d, v);
#pragma unroll
        for (int b = 0; b < 5; ++b) at5[b][m] = v[b];
    }
#pragma unroll
    for (int b = 0; b < 5; ++b) {
        VECTOR v[8];
        split8(at5[b], v);
#pragma unroll
        for (int a = 0; a < 8; ++a) STORE(v[a], 0, to + (a * 5 + b) * plane);
    }
}

// One work-item a (vector of channels, tile). Adds the bias and, where `add` is 1, the residual (laid out as the frames);
// negatives become 0.
kernel void join(global const float* restrict points, global const float* restrict bias,
                 global const float* restrict residual, global float* restrict frames, uint add, uint sequences,
                 uint length, uint tiles, uint strips, uint rows, uint tile_rows, uint pitch) {
    const uint at = get_global_id(0) * VEC, row = get_global_id(1), strip = row / tiles;
    if (at >= pitch || strip >= strips) return;
    global const float* from = points + (size_t)row * pitch + at;
    const size_t base = ((size_t)(strip / sequences) * rows + strip % sequences * length) * pitch + at;
    const size_t plane = (size_t)tile_rows * pitch;
    const uint start = row % tiles * 18;
    const VECTOR offset = LOAD(0, bias + at);

    VECTOR groups[6][5];
#pragma unroll
    for (int b = 0; b < 5; ++b) {
        VECTOR m[8], y[6];
#pragma unroll
        for (int a = 0; a < 8; ++a) m[a] = LOAD(0, from + (a * 5 + b) * plane);
        join8(m, y, 6);
#pragma unroll
        for (int g = 0; g < 6; ++g) groups[g][b] = y[g];
    }
#pragma unroll
    for (int g = 0; g < 6; ++g) {
        VECTOR y[3];
        join3(groups[g], y);
#pragma unroll
        for (int j = 0; j < 3; ++j) {
            const uint t = start + 3 * g + j;
            if (t >= length) return;
            VECTOR out = y[j] + offset;
            if (add) out += LOAD(0, residual + base + t * pitch);
            STORE(fmax(out, 0.0f), 0, frames + base + t * pitch);
        }
    }
}

// One work-item a (vector of channels, tile).
kernel void split_strided(global const float* restrict frames, global float* restrict points, uint sequences, uint length,
                          uint tiles, uint strips, uint rows, uint tile_rows, uint pitch) {
    const uint at = get_global_id(0) * VEC, row = get_global_id(1), strip = row / tiles;
    if (at >= pitch || strip >= strips) return;
    global const float* from =
        frames + ((size_t)(strip / sequences) * rows + strip % sequences * length) * pitch + at;
    global float* to = points + (size_t)row * pitch + at;
    const size_t plane = (size_t)tile_rows * pitch;
    const int start = (int)(row % tiles) * 8 - 4;

#pragma unroll
    for (int phase = 0; phase < 2; ++phase) {
        VECTOR d[8], v[8];
#pragma unroll
        for (int q = 0; q < 8; ++q) d[q] = frame_at(from, start + 2 * q + phase, length, pitch);
        split8(d, v);
#pragma unroll
        for (int a = 0; a < 8; ++a) STORE(v[a], 0, to + (phase * 8 + a) * plane);
    }
}

// One work-item a (vector of channels, tile); `points` holds the 8 sums over both phases, `length` counts the results.
kernel void join_strided(global const float* restrict points, global const float* restrict bias,
                         global const float* restrict residual, global float* restrict frames, uint add,
                         uint sequences, uint length, uint tiles, uint strips, uint rows, uint tile_rows, uint pitch) {
    const uint at = get_global_id(0) * VEC, row = get_global_id(1), strip = row / tiles;
    if (at >= pitch || strip >= strips) return;
    global const float* from = points + (size_t)row * pitch + at;
    const size_t base = ((size_t)(strip / sequences) * rows + strip % sequences * length) * pitch + at;
    const size_t plane = (size_t)tile_rows * pitch;
    const VECTOR offset = LOAD(0, bias + at);

    VECTOR m[8], y[4];
#pragma unroll
    for (int a = 0; a < 8; ++a) m[a] = LOAD(0, from + a * plane);
    join8(m, y, 4);
#pragma unroll
    for (int j = 0; j < 4; ++j) {
        const uint t = row % tiles * 4 + j;
        if (t >= length) return;
        VECTOR out = y[j] + offset;
        if (add) out += LOAD(0, residual + base + t * pitch);
        STORE(fmax(out, 0.0f), 0, frames + base + t * pitch);
    }
}
