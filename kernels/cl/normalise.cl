// Limb-vector normalisation with re-centring: limbs to unit length, roots relative to their clip's mean root.
//
// Data layout
//   rows    (frames, P, pitch)  float   smoothed limbs: joint k's three numbers at 3k, joint 0 the root's position; 48 numbers
//                                       can be read from the beginning of any row
//   start   (clips + 1)         uint    frames of a clip: start[clip] .. start[clip+1]-1
//   owner   (frames)            uint    the clip of each frame
//   bones   (clips, P, K)       float   mean length of every limb, 0 for the root
//   roots   (clips, P)          float4  mean position of every person's root
//   motion  (frames, P, K, 3)   float
//
// Joints are taken by sixteens, 48 numbers. The last sixteen end with the last joint and may overlap those before, whose results
// come out alike. A body of fewer joints is one sixteen that is stored in part.

inline uint sixteens(uint joints) {
    return (joints + 15) / 16;
}

// The first joint of sixteen number `i`.
inline uint first_joint(uint i, uint joints) {
    return joints < 16 ? 0 : min(16 * i, joints - 16);
}

// The lengths of the sixteen limbs whose numbers are a, b, c.
inline float16 lengths(float16 a, float16 b, float16 c) {
    a *= a, b *= b, c *= c;
    const float16 x = (float16)(a.s0369, a.scf, b.s258b, b.se, c.s147a, c.sd);
    const float16 y = (float16)(a.s147a, a.sd, b.s0369, b.scf, c.s258b, c.se);
    const float16 z = (float16)(a.s258b, a.se, b.s147a, b.sd, c.s0369, c.scf);
    return sqrt(x + y + z);
}

// Stores the first `count` of up to 16 numbers.
inline void store(float16 values, global float* to, uint count) {
    if (count >= 16) {
        vstore16(values, 0, to);
        return;
    }
    float each[16];
    vstore16(values, 0, each);
    for (uint i = 0; i < count; ++i) to[i] = each[i];
}

// One work-item a (sixteen, sequence). Sums carry what rounding took from them (Kahan), so that long clips lose nothing.
kernel void means(global const float* rows, global const uint* start, global float* bones,
                  global float4* roots, uint persons, uint joints, uint pitch, uint sequences) {
    const uint i = get_global_id(0), sequence = get_global_id(1);
    if (i >= sixteens(joints) || sequence >= sequences) return;
    const uint clip = sequence / persons, person = sequence % persons;
    const uint begin = start[clip], end = start[clip + 1];
    const size_t stride = (size_t)persons * pitch;
    rows += ((size_t)begin * persons + person) * pitch;
    bones += (size_t)sequence * joints;

    const uint joint = first_joint(i, joints);
    float16 sum = 0, gone = 0;
    for (uint frame = 0; frame < end - begin; ++frame) {
        global const float* limbs = rows + frame * stride + 3 * joint;
        const float16 term = lengths(vload16(0, limbs), vload16(1, limbs), vload16(2, limbs)) - gone;
        const float16 next = sum + term;
        gone = (next - sum) - term;
        sum = next;
    }
    store(sum / (float)(end - begin), bones + joint, joints);
    if (i > 0) return;

    float3 root = 0, lost = 0;
    for (uint frame = 0; frame < end - begin; ++frame) {
        const float3 term = vload3(0, rows + frame * stride) - lost, next = root + term;
        lost = (next - root) - term;
        root = next;
    }
    roots[sequence] = (float4)(root / (float)(end - begin), 0.0f);
    bones[0] = 0;
}

// One work-item a row.
kernel void unit_limbs(global const float* rows, global const uint* owner, global const float4* roots,
                       global float* motion, uint persons, uint joints, uint pitch, uint rows_count) {
    const uint row = get_global_id(0);
    if (row >= rows_count) return;
    rows += (size_t)row * pitch;
    motion += (size_t)row * joints * 3;
    for (uint i = 0; i < sixteens(joints); ++i) {
        const uint joint = first_joint(i, joints), valid = 3 * joints;
        const float16 a = vload16(0, rows + 3 * joint), b = vload16(1, rows + 3 * joint),
                      c = vload16(2, rows + 3 * joint);
        const float16 s = 1.0f / (lengths(a, b, c) + 1e-4f);
        store(a * s.s0001112223334445, motion + 3 * joint, valid);
        store(b * s.s55666777888999aa, motion + 3 * joint + 16, valid - min(valid, 16u));
        store(c * s.sabbbcccdddeeefff, motion + 3 * joint + 32, valid - min(valid, 32u));
    }
    const uint clip = owner[row / persons];
    float4 mean = 0;
    for (uint p = 0; p < persons; ++p) mean += roots[clip * persons + p];
    vstore3(vload3(0, rows) - mean.xyz / (float)persons, 0, motion);
}
