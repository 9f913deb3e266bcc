// Forward kinematics of many ragged clips: channel values in, limbs out. One work-item a frame; those past
// the last do nothing.
//
//   values       float  per clip (channels, frames): clip c's value of channel i at its frame f lies at
//                       value_first[c] + i * frames(c) + f, so that neighbouring work-items read neighbouring addresses
//   joints       Joint  clip c owns joints joint_first[c] .. joint_first[c+1]-1, depth first, each after its parent
//   joint_first  uint   (clips + 1)
//   frame_first  uint   (clips + 1)  clip c owns frames frame_first[c] .. frame_first[c+1]-1
//   value_first  ulong  (clips)
//   transforms   float  (slots, 12, total frames)  scratch; a transform is the matrix by columns, then a vector
//   limbs        float  (total frames, K, 3)  joint 0 the root's position, joint k the vector from k's kept parent to k
//
// A joint's place in its parent is its OFFSET, where each position channel takes the place of its coordinate.
// Its matrix is its parent's times the rotations in the order of its channels. The vector carried along the
// tree runs from the nearest kept ancestor, not from the origin: a limb is then as exact far from the origin
// as near it.
//
// A joint that follows its parent finds the parent's transform in registers, so that only joints of two
// children or more use a slot. Bits 3i .. 3i+2 of `channels` are channel i: 0 1 2 the position's x y z, 3 4 5
// a rotation about x y z.

typedef struct {
    float offset[3];
    uint channels;
    uint channel_count;
    uint first_channel;
    int load;  // slot of the parent's transform, or one of the two below
    int save;  // slot for this joint's own transform, negative for none
    int limb;  // which of the K it is, negative where it is not kept
} Joint;

#define KEPT_IN_REGISTERS -1
#define NO_PARENT -2

#define RADIANS_PER_DEGREE 0.017453292519943295f

typedef struct {
    float3 x, y, z;  // columns of the matrix
    float3 reach;    // from the nearest kept ancestor, or from the origin where there is none
} Transform;

static uint clip_of(uint frame, global const uint* frame_first, uint clips) {
    uint low = 0, high = clips;
    while (high - low > 1) {
        const uint middle = (low + high) / 2;
        if (frame_first[middle] <= frame)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static float3 load_vector(global const float* at, size_t total) {
    return (float3)(at[0], at[total], at[2 * total]);
}

static void save_vector(float3 v, global float* at, size_t total) {
    at[0] = v.x;
    at[total] = v.y;
    at[2 * total] = v.z;
}

static Transform load_transform(global const float* at, size_t total) {
    Transform t;
    t.x = load_vector(at, total);
    t.y = load_vector(at + 3 * total, total);
    t.z = load_vector(at + 6 * total, total);
    t.reach = load_vector(at + 9 * total, total);
    return t;
}

static void save_transform(Transform t, global float* at, size_t total) {
    save_vector(t.x, at, total);
    save_vector(t.y, at + 3 * total, total);
    save_vector(t.z, at + 6 * total, total);
    save_vector(t.reach, at + 9 * total, total);
}

// Sine and cosine of degrees, to 1e-7. Quarter turns come off exactly, as they would not in radians; what is
// left is within 45 degrees, where short series do.
static float2 sine_and_cosine(float degrees) {
    const float quarters = rint(degrees * (1.0f / 90.0f));
    const float r = fma(quarters, -90.0f, degrees) * RADIANS_PER_DEGREE, r2 = r * r;
    const float s =
        r + r * r2 * fma(r2, fma(r2, fma(r2, 2.7557319e-6f, -1.9841270e-4f), 8.3333333e-3f), -0.16666667f);
    const float c =
        fma(r2, fma(r2, fma(r2, fma(r2, 2.4801587e-5f, -1.3888889e-3f), 4.1666667e-2f), -0.5f), 1.0f);
    const int quadrant = (int)quarters & 3;
    const float2 turned = quadrant & 1 ? (float2)(c, -s) : (float2)(s, c);
    return quadrant & 2 ? -turned : turned;
}

// Turns the columns u and v, in the plane that they span, by an angle from u to v.
static void turn(float3* u, float3* v, float s, float c) {
    const float3 turned = c * *u + s * *v;
    *v = c * *v - s * *u;
    *u = turned;
}

// `row` is the joint's first channel at this frame.
static float3 place_in_parent(global const Joint* joint, global const float* row, size_t frames) {
    float3 place = (float3)(joint->offset[0], joint->offset[1], joint->offset[2]);
    for (uint i = 0; i < joint->channel_count; ++i) {
        const uint channel = (joint->channels >> (3 * i)) & 7;
        if (channel > 2) continue;
        const float value = row[i * frames];
        if (channel == 0)
            place.x = value;
        else if (channel == 1)
            place.y = value;
        else
            place.z = value;
    }
    return place;
}

static void rotate_by_channels(Transform* t, global const Joint* joint, global const float* row,
                               size_t frames) {
    for (uint i = 0; i < joint->channel_count; ++i) {
        const uint channel = (joint->channels >> (3 * i)) & 7;
        if (channel < 3) continue;
        const float2 sc = sine_and_cosine(row[i * frames]);
        if (channel == 3)
            turn(&t->y, &t->z, sc.x, sc.y);
        else if (channel == 4)
            turn(&t->z, &t->x, sc.x, sc.y);
        else
            turn(&t->x, &t->y, sc.x, sc.y);
    }
}

kernel void forward_kinematics(global const float* values, global const Joint* joints,
                               global const uint* joint_first, global const uint* frame_first,
                               global const ulong* value_first, uint clips, uint total_frames,
                               uint limbs_a_frame, float metres_a_unit, global float* transforms,
                               global float* limbs) {
    const size_t frame = get_global_id(0);
    const size_t total = total_frames;
    if (frame >= total) return;
    const uint clip = clip_of((uint)frame, frame_first, clips);
    const size_t frames = frame_first[clip + 1] - frame_first[clip];
    global const float* column = values + value_first[clip] + (frame - frame_first[clip]);

    Transform t;
    t.x = t.y = t.z = t.reach = (float3)(0.0f);
    const uint last = joint_first[clip + 1];
    for (uint j = joint_first[clip]; j < last; ++j) {
        global const Joint* joint = joints + j;
        global const float* row = column + joint->first_channel * frames;
        if (joint->load == NO_PARENT) {
            t.x = (float3)(1.0f, 0.0f, 0.0f);
            t.y = (float3)(0.0f, 1.0f, 0.0f);
            t.z = (float3)(0.0f, 0.0f, 1.0f);
            t.reach = (float3)(0.0f);
        } else if (joint->load != KEPT_IN_REGISTERS) {
            t = load_transform(transforms + (size_t)joint->load * 12 * total + frame, total);
        }
        const float3 place = place_in_parent(joint, row, frames);
        t.reach += t.x * place.x + t.y * place.y + t.z * place.z;
        rotate_by_channels(&t, joint, row, frames);
        if (joint->limb >= 0) {
            vstore3(t.reach * metres_a_unit, frame * limbs_a_frame + joint->limb, limbs);
            t.reach = (float3)(0.0f);
        }
        if (joint->save >= 0) save_transform(t, transforms + (size_t)joint->save * 12 * total + frame, total);
    }
}
