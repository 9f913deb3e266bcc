// Motions on their way into the recogniser, along the skeleton, and out.
//
// Data layout
//   motion    (sequences, C, T, K)        float
//   panels    (panels, rows, pitch)       float  row n * T + t of a joint's panel: its channels in frame t of sequence n,
//                                                zero from C to pitch; `rows` is sequences * T padded to whole tiles
//   first     (panels + 1)                uint   sources of a gathered panel: first[p] .. first[p + 1] - 1
//   source    (sources)                   uint   the panel to take
//   share     (sources)                   float  and how much of it
//   features  (sequences, channels)       float
//   logits    (sequences, classes)        float
//
// Macro: VEC, channels a work-item handles at once (vectors.cl stands before this file)

// One work-item a (joint, row): channel c of joint k becomes scale[k*C + c] * it + shift[k*C + c], the data's batch norm.
kernel void enter(global const float* motion, global const float* scale, global const float* shift,
                  global float* panels, uint begin, uint sequences, uint channels, uint frames, uint joints,
                  uint rows, uint pitch) {
    const uint joint = get_global_id(0), row = get_global_id(1);
    if (joint >= joints || row >= sequences * frames) return;
    const uint sequence = row / frames, t = row % frames;
    global const float* from =
        motion + (((size_t)(begin + sequence) * channels) * frames + t) * joints + joint;
    global float* to = panels + ((size_t)joint * rows + row) * pitch;
    for (uint c = 0; c < channels; ++c)
        to[c] = from[(size_t)c * frames * joints] * scale[joint * channels + c] + shift[joint * channels + c];
    for (uint c = channels; c < pitch; ++c) to[c] = 0;
}

// A work-item takes a (row, panel), and of its channels every get_global_size(0)-th vector. Panels are gathered from the
// same memory that they go to, behind its first `behind` panels. Frame t of the result is frame t * stride of the sources.
kernel void gather(global const float* panels, global const uint* first, global const uint* source,
                   global const float* share, global float* gathered, uint sequences, uint frames_in,
                   uint frames, uint stride, uint rows_in, uint rows, uint pitch, uint panel_count,
                   uint behind) {
    const uint row = get_global_id(1), panel = get_global_id(2);
    if (row >= sequences * frames || panel >= panel_count) return;
    const uint from = stride == 1 ? row : row / frames * frames_in + row % frames * stride;
    const uint begin = first[panel], end = first[panel + 1];
    for (uint at = get_global_id(0) * VEC; at < pitch; at += get_global_size(0) * VEC) {
        VECTOR sum = 0;
        for (uint s = begin; s < end; ++s)
            sum += share[s] * LOAD(0, panels + ((size_t)source[s] * rows_in + from) * pitch + at);
        STORE(sum, 0, gathered + ((size_t)(behind + panel) * rows + row) * pitch + at);
    }
}

// One work-item a (channel, sequence): the mean over frames and joints.
kernel void pool(global const float* panels, global float* features, uint begin, uint sequences,
                 uint channels, uint frames, uint joints, uint rows, uint pitch) {
    const uint channel = get_global_id(0), sequence = get_global_id(1);
    if (channel >= channels || sequence >= sequences) return;
    float all = 0;
    for (uint k = 0; k < joints; ++k) {
        global const float* from = panels + ((size_t)k * rows + sequence * frames) * pitch + channel;
        float sum = 0;
        for (uint t = 0; t < frames; ++t) sum += from[t * pitch];
        all += sum / (float)frames;
    }
    features[(size_t)(begin + sequence) * channels + channel] = all / (float)joints;
}

// One work-item a (class, sequence): weights (classes, channels).
kernel void classify(global const float* features, global const float* weights, global const float* bias,
                     global float* logits, uint sequences, uint channels, uint classes) {
    const uint class = get_global_id(0), sequence = get_global_id(1);
    if (class >= classes || sequence >= sequences) return;
    global const float* x = features + (size_t)sequence * channels;
    global const float* w = weights + (size_t) class * channels;
    float sum = 0;
    for (uint c = 0; c < channels; ++c) sum += x[c] * w[c];
    logits[(size_t)sequence * classes + class] = sum + bias[class];
}
