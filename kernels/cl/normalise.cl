// Limb-vector normalisation with re-centring: limbs to unit length, roots relative to their clip's mean root.
//
// Data layout
//   rows    (frames, P, pitch)  float   smoothed limbs: joint k's three numbers at 3k, joint 0 the root's position
//   start   (clips + 1)         uint    frames of a clip: start[clip] .. start[clip+1]-1
//   owner   (frames)            uint    the clip of each frame
//   bones   (clips, P, K)       float   mean length of every limb, 0 for the root
//   roots   (clips, P)          float4  mean position of every person's root
//   motion  (frames, P, K, 3)   float

// One work-item a (joint, sequence). Sums are compensated (Kahan), so that long clips lose nothing.
kernel void means(global const float* rows, global const uint* start, global float* bones,
                  global float4* roots, uint persons, uint joints, uint pitch, uint sequences) {
    const uint joint = get_global_id(0), sequence = get_global_id(1);
    if (joint >= joints || sequence >= sequences) return;
    const uint clip = sequence / persons, person = sequence % persons;
    const uint begin = start[clip], end = start[clip + 1];

    float3 sum = 0, lost = 0;
    for (uint frame = begin; frame < end; ++frame) {
        const float3 limb = vload3(joint, rows + ((size_t)frame * persons + person) * pitch);
        const float3 term = (joint == 0 ? limb : (float3)(sqrt(dot(limb, limb)))) - lost;
        const float3 next = sum + term;
        lost = (next - sum) - term;
        sum = next;
    }
    const float3 mean = sum / (float)(end - begin);
    bones[(size_t)sequence * joints + joint] = joint == 0 ? 0.0f : mean.x;
    if (joint == 0) roots[sequence] = (float4)(mean, 0.0f);
}

// One work-item a (joint, row).
kernel void unit_limbs(global const float* rows, global const uint* owner, global const float4* roots,
                       global float* motion, uint persons, uint joints, uint pitch, uint rows_count) {
    const uint joint = get_global_id(0), row = get_global_id(1);
    if (joint >= joints || row >= rows_count) return;
    float3 limb = vload3(joint, rows + (size_t)row * pitch);
    if (joint == 0) {
        const uint clip = owner[row / persons];
        float4 mean = 0;
        for (uint p = 0; p < persons; ++p) mean += roots[clip * persons + p];
        limb -= mean.xyz / (float)persons;
    } else {
        limb /= sqrt(dot(limb, limb)) + 1e-4f;
    }
    vstore3(limb, joint, motion + (size_t)row * joints * 3);
}
