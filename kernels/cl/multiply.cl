// The packed multiply: many small matrix products in one launch, each the sum of a few.
//
//   out[problem] = sum over the problem's segments (panel, set) of a[panel] * w[set]      (rows, depth) x (depth, columns)
//
// A graph convolution is one problem a joint, with a segment for each part of its neighbourhood; a temporal convolution is
// one problem for each point of its minimal filtering.
//
// Data layout                                          BLOCK = TILE_VECTORS * VEC columns
//   a        (panels, a_rows, a_pitch)      float      row by row, `depth` numbers of each used
//   w        (sets, columns / BLOCK, depth, BLOCK)     so that one work-item reads its weights in one stream
//   first    (problems + 1)                 uint       segments of a problem: first[problem] .. first[problem + 1] - 1
//   segment  (segments)                     uint2      panel, set
//   bias     (problems, out_pitch)          float      only with BIAS_RELU: added before negatives become 0
//   out      (problems, out_rows, out_pitch) float
// Rows are padded to whole tiles: those beyond the last hold finite numbers of no meaning.
//
//            TILE_VECTORS vectors
//           +------+------+        One work-item holds a tile of TILE_ROWS x TILE_VECTORS sums in registers. At every
//           |  w k |      |        step of depth it takes TILE_VECTORS vectors of weights and TILE_ROWS numbers of a.
//      +--+ +------+------+        ITEM_TILES tiles, one below the other, share the work-item, so that its weights stay
//   a  |k | | sum  | sum  |        in the nearest cache.
//      |  | | ...  | ...  |
//      +--+ +------+------+        COLUMNS_FIRST numbers work-items along columns first (neighbours then share rows, which
//                                  GPUs read once), else along rows.
//
// Macros (vectors.cl stands before this file): VEC, TILE_ROWS, TILE_VECTORS, ITEM_TILES, COLUMNS_FIRST, BIAS_RELU

#define BLOCK (TILE_VECTORS * VEC)

kernel void multiply(global const float* restrict a, global const float* restrict w, global const uint* restrict first,
                     global const uint2* restrict segment, global const float* restrict bias,
                     global float* restrict out, uint tiles, uint columns, uint problems, uint depth, uint a_rows,
                     uint a_pitch, uint out_rows, uint out_pitch) {
    const uint column = get_global_id(COLUMNS_FIRST ? 0 : 1), problem = get_global_id(2);
    const uint begin = get_global_id(COLUMNS_FIRST ? 1 : 0) * ITEM_TILES;
    if (column >= columns || begin >= tiles || problem >= problems) return;

    for (uint tile = begin; tile < min(begin + ITEM_TILES, tiles); ++tile) {
        VECTOR sum[TILE_ROWS][TILE_VECTORS];
#pragma unroll
        for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
            for (int v = 0; v < TILE_VECTORS; ++v)
#ifdef BIAS_RELU
                sum[r][v] = LOAD(column * TILE_VECTORS + v, bias + problem * out_pitch);
#else
                sum[r][v] = 0;
#endif
        for (uint s = first[problem]; s < first[problem + 1]; ++s) {
            global const float* restrict rows = a + ((size_t)segment[s].x * a_rows + tile * TILE_ROWS) * a_pitch;
            global const float* restrict weights = w + ((size_t)segment[s].y * columns + column) * depth * BLOCK;
            for (uint k = 0; k < depth; ++k) {
                VECTOR weight[TILE_VECTORS];
#pragma unroll
                for (int v = 0; v < TILE_VECTORS; ++v) weight[v] = LOAD(v, weights + k * BLOCK);
#pragma unroll
                for (int r = 0; r < TILE_ROWS; ++r) {
                    const VECTOR x = rows[r * a_pitch + k];
#pragma unroll
                    for (int v = 0; v < TILE_VECTORS; ++v) sum[r][v] = fma(x, weight[v], sum[r][v]);
                }
            }
        }
        global float* to = out + ((size_t)problem * out_rows + tile * TILE_ROWS) * out_pitch + column * BLOCK;
#pragma unroll
        for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
            for (int v = 0; v < TILE_VECTORS; ++v) {
#ifdef BIAS_RELU
                STORE(fmax(sum[r][v], 0.0f), v, to + r * out_pitch);
#else
                STORE(sum[r][v], v, to + r * out_pitch);
#endif
            }
    }
}
