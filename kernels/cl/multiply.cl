// The packed multiply: many small matrix products in one launch, each the sum of a few.
//
//   out[problem] = sum over the problem's segments (panel, set) of a[panel] * w[set]      (rows, depth) x (depth, columns)
//
// A graph convolution is one problem a joint, with a segment for each part of its neighbourhood; a temporal convolution is
// one problem for each point of its Winograd filtering.
//
// Data layout                                          BLOCK = TILE_VECTORS * VEC columns
//   a        (panels, a_rows, A_PITCH)      float      row by row, `depth` numbers of each used
//   w        (sets, columns / BLOCK, depth, BLOCK)     so that one work-item reads its weights in one stream; with
//            (sets, depth, columns / BLOCK, BLOCK)     COLUMNS_FIRST, so that neighbours read theirs side by side
//   first    (problems + 1)                 uint       segments of a problem: first[problem] .. first[problem + 1] - 1
//   segment  (segments)                     uint2      panel, set
//   scale    (segments)                     float      only with GRAPH: what is summed by the segment's end is multiplied
//   bias     (problems, OUT_PITCH)          float      only with GRAPH: added last, and negatives become 0
//   out      (problems, out_rows, OUT_PITCH) float
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
// Macros (vectors.cl stands before this file): VEC, TILE_ROWS, TILE_VECTORS, ITEM_TILES, COLUMNS_FIRST, GRAPH, A_PITCH,
// OUT_PITCH. The pitches are macros so that a row's address is a constant away from the next one's.

#define BLOCK (TILE_VECTORS * VEC)

kernel void multiply(global const float* restrict a, global const float* restrict w,
                     global const uint* restrict first, global const uint2* restrict segment,
                     global const float* restrict scale, global const float* restrict bias,
                     global float* restrict out, uint tiles, uint columns, uint problems, uint depth,
                     uint a_rows, uint out_rows) {
    const uint column = get_global_id(COLUMNS_FIRST ? 0 : 1), problem = get_global_id(2);
    const uint begin = get_global_id(COLUMNS_FIRST ? 1 : 0) * ITEM_TILES;
    if (column >= columns || begin >= tiles || problem >= problems) return;

    for (uint tile = begin; tile < min(begin + ITEM_TILES, tiles); ++tile) {
        VECTOR sum[TILE_ROWS][TILE_VECTORS];
#pragma unroll
        for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
            for (int v = 0; v < TILE_VECTORS; ++v) sum[r][v] = 0;

        const size_t step = COLUMNS_FIRST ? columns * BLOCK : BLOCK;
        for (uint s = first[problem]; s < first[problem + 1]; ++s) {
            global const float* restrict rows =
                a + ((size_t)segment[s].x * a_rows + tile * TILE_ROWS) * A_PITCH;
            global const float* restrict weights =
                w + ((size_t)segment[s].y * columns * depth + column * (COLUMNS_FIRST ? 1 : depth)) * BLOCK;
            for (size_t k = 0; k < depth; ++k) {
                VECTOR weight[TILE_VECTORS];
#pragma unroll
                for (int v = 0; v < TILE_VECTORS; ++v) weight[v] = LOAD(v, weights + k * step);
#pragma unroll
                for (int r = 0; r < TILE_ROWS; ++r) {
                    const VECTOR x = rows[k + r * A_PITCH];
#pragma unroll
                    for (int v = 0; v < TILE_VECTORS; ++v) sum[r][v] = fma(x, weight[v], sum[r][v]);
                }
            }
#ifdef GRAPH
#pragma unroll
            for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
                for (int v = 0; v < TILE_VECTORS; ++v) sum[r][v] *= scale[s];
#endif
        }
        global float* to = out + ((size_t)problem * out_rows + tile * TILE_ROWS) * OUT_PITCH + column * BLOCK;
#pragma unroll
        for (int v = 0; v < TILE_VECTORS; ++v) {
#ifdef GRAPH
            const VECTOR offset = LOAD(column * TILE_VECTORS + v, bias + problem * OUT_PITCH);
#endif
#pragma unroll
            for (int r = 0; r < TILE_ROWS; ++r) {
#ifdef GRAPH
                sum[r][v] = fmax(sum[r][v] + offset, 0.0f);
#endif
                STORE(sum[r][v], v, to + r * OUT_PITCH);
            }
        }
    }
}
