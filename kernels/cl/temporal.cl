// Temporal convolutions of 9 taps by Winograd's minimal filtering (Winograd 1980; Lavin and Gray, CVPR 2016): `transform_input` takes tiles of
// frames to the points of the filtering, where multiply.cl multiplies by the weights, and `transform_output` takes the products back to
// frames. Padding is 4 frames of zeros.
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

// A tile of 18 results from the frames it needs, `start` being the first of them.
void split_tile(global const float* from, global float* to, int start, uint length, uint pitch,
                size_t plane) {
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

// The same for a tile of 4 results at stride 2.
void split_strided_tile(global const float* from, global float* to, int start, uint length, uint pitch,
                        size_t plane) {
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

// Frame t of a sequence: the sum with the bias and the residual, if any; negatives become 0.
void finish(VECTOR y, VECTOR bias, global const float* residual, global float* to, uint add) {
    y += bias;
    if (add) y += LOAD(0, residual);
    STORE(fmax(y, 0.0f), 0, to);
}

// Results from `start` to the sequence's end, 18 at most.
void join_tile(global const float* from, VECTOR bias, global const float* residual, global float* to,
               uint add, uint start, uint length, uint pitch, size_t plane) {
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
            finish(y[j], bias, residual + t * pitch, to + t * pitch, add);
        }
    }
}

// The same for 4 results at stride 2, whose points are the sums over both phases.
void join_strided_tile(global const float* from, VECTOR bias, global const float* residual, global float* to,
                       uint add, uint start, uint length, uint pitch, size_t plane) {
    VECTOR m[8], y[4];
#pragma unroll
    for (int a = 0; a < 8; ++a) m[a] = LOAD(0, from + a * plane);
    join8(m, y, 4);
#pragma unroll
    for (int j = 0; j < 4; ++j) {
        const uint t = start + j;
        if (t >= length) return;
        finish(y[j], bias, residual + t * pitch, to + t * pitch, add);
    }
}

// A work-item takes a tile, and of its channels every get_global_size(0)-th vector. `length` counts frames here and
// results in `transform_output`. With `stride` 2 both do so at a stride.
kernel void transform_input(global const float* restrict frames, global float* restrict points, uint stride,
                            uint sequences, uint length, uint tiles, uint strips, uint rows, uint tile_rows,
                            uint pitch) {
    const uint row = get_global_id(1), strip = row / tiles;
    if (strip >= strips) return;
    const size_t first = (size_t)(strip / sequences) * rows + strip % sequences * length;
    const size_t plane = (size_t)tile_rows * pitch;
    const int start = (int)(row % tiles) * (stride == 1 ? 18 : 8) - 4;
    for (uint at = get_global_id(0) * VEC; at < pitch; at += get_global_size(0) * VEC) {
        global const float* from = frames + first * pitch + at;
        global float* to = points + (size_t)row * pitch + at;
        if (stride == 1)
            split_tile(from, to, start, length, pitch, plane);
        else
            split_strided_tile(from, to, start, length, pitch, plane);
    }
}

// A work-item as in `transform_input`. Adds the bias and, where `add` is 1, the residual, which is laid out as the frames; negatives
// become 0.
kernel void transform_output(global const float* restrict points, global const float* restrict bias,
                             global const float* restrict residual, global float* restrict frames, uint add,
                             uint stride, uint sequences, uint length, uint tiles, uint strips, uint rows,
                             uint tile_rows, uint pitch) {
    const uint row = get_global_id(1), strip = row / tiles;
    if (strip >= strips) return;
    const size_t first = (size_t)(strip / sequences) * rows + strip % sequences * length;
    const size_t plane = (size_t)tile_rows * pitch;
    const uint start = row % tiles * (stride == 1 ? 18 : 4);
    for (uint at = get_global_id(0) * VEC; at < pitch; at += get_global_size(0) * VEC) {
        global const float* from = points + (size_t)row * pitch + at;
        global const float* other = add ? residual + first * pitch + at : bias;
        global float* to = frames + first * pitch + at;
        if (stride == 1)
            join_tile(from, LOAD(0, bias + at), other, to, add, start, length, pitch, plane);
        else
            join_strided_tile(from, LOAD(0, bias + at), other, to, add, start, length, pitch, plane);
    }
}
