// A skinned body with pose blend shapes, as SMPL (Loper et al. 2015, equations 2 to 10): shape, chain of joints, skin.
//
//   V_s = T + S beta      v_p = V_s + P vec(R_1 - I, ..)      v = sum_k w_k A_k [v_p; 1] + translation
//
// Data layout (K joints, V vertices, F = 9 (K - 1) pose features, B shapes)
//   rest         float  (3V)            the vertices of the mean body; `shapes` (B, 3V), `betas` (B); their sum `shaped` (3V)
//   joints       float  (K, 3)          of the shaped body at rest;   parents  int (K), each joint behind its parent
//   rotations    float  (frames, K, 9)  of every joint below its parent, row-major;   translations (frames, 3)
//   features     float  (panels, F, PANEL)           R_k - I behind the root
//   transforms   float  (panels, 12 K + 3, PANEL)    rows of A_k = [R | t - R j_k], then the translation
//   directions   float  (blocks, F, 3 TILE_VERTICES) P, so that one work-item reads its part in one stream
//   first        uint   (padded V + 1)  vertex v is moved by influences first[v] .. first[v+1]-1
//   joint, weight       (influences)    that is, by so much of this joint's transform
//   vertices     float  (frames, V, 3)
//
//         PANEL frames             The product of P with the features is nearly all there is to do. A work-item holds the sums of
//        +---+---+---+---+         TILE_VERTICES vertices at TILE_VECTORS vectors of VEC frames in registers. At every feature it
//   k -> |   |tile   |   |         takes TILE_VECTORS vectors of features and 3 TILE_VERTICES numbers of P, one for all frames. The
//        +---+---+---+---+         same vectors then blend the transforms, so that the unskinned body is never written.
//
// Panels keep a tile's features together: their rows lie PANEL numbers apart however many frames there are. ITEM_BLOCKS blocks of
// vertices share a work-item, so that its features and transforms stay in the nearest cache; neighbouring work-items take
// neighbouring frames, so that they share a group of P's blocks in the next. Frames and vertices are padded with copies of the last.
//
// Macros (vectors.cl stands before this file): JOINTS, PANEL, VEC, TILE_VERTICES, TILE_VECTORS, ITEM_BLOCKS.

#define FEATURES (9 * (JOINTS - 1))
#define TRANSFORM_ROWS (12 * JOINTS + 3)
#define TILE_NUMBERS (3 * TILE_VERTICES)

// Rotations add up along the chain: in double where the device has it.
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
#else
typedef float real;
#endif

// One work-item a coordinate.
kernel void shape(global const float* rest, global const float* shapes, global const float* betas,
                  global float* shaped, uint coordinates, uint count) {
    const uint i = get_global_id(0);
    if (i >= coordinates) return;
    float sum = 0;
    for (uint b = 0; b < count; ++b) sum = fma(betas[b], shapes[(size_t)b * coordinates + i], sum);
    shaped[i] = rest[i] + sum;
}

typedef struct {
    real rows[3][4];  // rotation and place in the world
} Placed;

static void place(Placed* out, const Placed* parent, const real* own, real x, real y, real z) {
    for (int i = 0; i < 3; ++i) {
        const real* row = parent->rows[i];
        for (int j = 0; j < 3; ++j)
            out->rows[i][j] = row[0] * own[j] + row[1] * own[3 + j] + row[2] * own[6 + j];
        out->rows[i][3] = row[0] * x + row[1] * y + row[2] * z + row[3];
    }
}

// One work-item a frame, those of the padding included.
kernel void chain(global const float* rotations, global const float* translations, global const float* joints,
                  global const int* parents, global float* features, global float* transforms,
                  global float* places, uint frames, uint padded) {
    const uint at = get_global_id(0);
    if (at >= padded) return;
    const uint frame = min(at, frames - 1);
    rotations += (size_t)frame * JOINTS * 9;
    features += (size_t)(at / PANEL) * FEATURES * PANEL + at % PANEL;
    transforms += (size_t)(at / PANEL) * TRANSFORM_ROWS * PANEL + at % PANEL;

    const Placed origin = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    Placed world[JOINTS];
    for (int k = 0; k < JOINTS; ++k) {
        const int parent = parents[k];
        real own[9], from[3];
        for (int i = 0; i < 9; ++i) {
            own[i] = rotations[9 * k + i];
            if (k > 0)
                features[(9 * (k - 1) + i) * PANEL] = rotations[9 * k + i] - (i % 4 == 0 ? 1.0f : 0.0f);
        }
        for (int d = 0; d < 3; ++d)
            from[d] = (real)joints[3 * k + d] - (parent < 0 ? (real)0 : (real)joints[3 * parent + d]);
        place(&world[k], parent < 0 ? &origin : &world[parent], own, from[0], from[1], from[2]);
        for (int i = 0; i < 3; ++i) {
            const real* row = world[k].rows[i];
            const real moved =
                row[3] - row[0] * joints[3 * k] - row[1] * joints[3 * k + 1] - row[2] * joints[3 * k + 2];
            for (int j = 0; j < 3; ++j) transforms[(12 * k + 4 * i + j) * PANEL] = (float)row[j];
            transforms[(12 * k + 4 * i + 3) * PANEL] = (float)moved;
            if (at < frames)
                places[((size_t)frame * JOINTS + k) * 3 + i] = (float)(row[3] + translations[3 * frame + i]);
        }
    }
    for (int i = 0; i < 3; ++i) transforms[(12 * JOINTS + i) * PANEL] = translations[3 * frame + i];
}

// Writes TILE_NUMBERS numbers of VEC frames, the first `valid` numbers of the first `frames` frames.
static void write_tile(const VECTOR* numbers, global float* to, size_t stride, uint valid, uint frames) {
    float each[TILE_NUMBERS][VEC];
#pragma unroll
    for (int i = 0; i < TILE_NUMBERS; ++i) STORE(numbers[i], 0, each[i]);
    if (valid == TILE_NUMBERS && frames >= VEC) {
#pragma unroll
        for (int l = 0; l < VEC; ++l)
#pragma unroll
            for (int i = 0; i < TILE_NUMBERS; ++i) to[l * stride + i] = each[i][l];
        return;
    }
    for (uint l = 0; l < min((uint)VEC, frames); ++l)
        for (uint i = 0; i < valid; ++i) to[l * stride + i] = each[i][l];
}

// One work-item TILE_VECTORS * VEC frames and ITEM_BLOCKS blocks of vertices.
kernel void skin(global const float* restrict features, global const float* restrict transforms,
                 global const float* restrict shaped, global const float* restrict directions,
                 global const uint* restrict first, global const uint* restrict joint,
                 global const float* restrict weight, global float* restrict vertices, uint frames,
                 uint vertex_count, uint tiles, uint blocks) {
    const uint tile = get_global_id(0), begin = get_global_id(1) * ITEM_BLOCKS;
    if (tile >= tiles || begin >= blocks) return;
    const uint frame = tile * TILE_VECTORS * VEC;
    features += (size_t)(frame / PANEL) * FEATURES * PANEL + frame % PANEL;
    transforms += (size_t)(frame / PANEL) * TRANSFORM_ROWS * PANEL + frame % PANEL;
    const size_t stride = (size_t)vertex_count * 3;

    for (uint block = begin; block < min(begin + ITEM_BLOCKS, blocks); ++block) {
        VECTOR sum[TILE_VECTORS][TILE_NUMBERS];
#pragma unroll
        for (int v = 0; v < TILE_VECTORS; ++v)
#pragma unroll
            for (int i = 0; i < TILE_NUMBERS; ++i) sum[v][i] = shaped[block * TILE_NUMBERS + i];

        global const float* restrict own = directions + (size_t)block * FEATURES * TILE_NUMBERS;
        for (int k = 0; k < FEATURES; ++k) {
            VECTOR feature[TILE_VECTORS];
#pragma unroll
            for (int v = 0; v < TILE_VECTORS; ++v) feature[v] = LOAD(v, features + k * PANEL);
#pragma unroll
            for (int i = 0; i < TILE_NUMBERS; ++i) {
                const VECTOR direction = own[k * TILE_NUMBERS + i];
#pragma unroll
                for (int v = 0; v < TILE_VECTORS; ++v) sum[v][i] = fma(direction, feature[v], sum[v][i]);
            }
        }

        const uint vertex = block * TILE_VERTICES;
        const uint valid = 3 * min(vertex_count - vertex, (uint)TILE_VERTICES);
#pragma unroll
        for (int v = 0; v < TILE_VECTORS; ++v) {
            if (frame + v * VEC >= frames) break;
#pragma unroll
            for (int n = 0; n < TILE_VERTICES; ++n) {
                VECTOR blend[12];
#pragma unroll
                for (int i = 0; i < 12; ++i) blend[i] = 0;
                for (uint s = first[vertex + n]; s < first[vertex + n + 1]; ++s) {
                    global const float* restrict rows = transforms + joint[s] * (12 * PANEL);
                    const VECTOR share = weight[s];
#pragma unroll
                    for (int i = 0; i < 12; ++i) blend[i] = fma(share, LOAD(v, rows + i * PANEL), blend[i]);
                }
                const VECTOR x = sum[v][3 * n], y = sum[v][3 * n + 1], z = sum[v][3 * n + 2];
#pragma unroll
                for (int i = 0; i < 3; ++i)
                    sum[v][3 * n + i] =
                        fma(blend[4 * i], x,
                            fma(blend[4 * i + 1], y, fma(blend[4 * i + 2], z, blend[4 * i + 3]))) +
                        LOAD(v, transforms + (12 * JOINTS + i) * PANEL);
            }
            write_tile(sum[v], vertices + (size_t)(frame + v * VEC) * stride + vertex * 3, stride, valid,
                       frames - (frame + v * VEC));
        }
    }
}
