// Gated recurrent units (GRU, Cho et al. 2014) over the frames of many sequences, and the dense layers behind them.
//
// Data layout
//   motion   (N, channels, T, nodes)       float   as motions lie everywhere
//   x        (N, T, inputs)                float   pose after pose, a node's channels side by side
//   initial  (N, HIDDEN)                   float   states before the first frame
//   w_in     (inputs, 3 HIDDEN)            float   gates r, z, n side by side
//   w_state  (HIDDEN, 3 HIDDEN)            float
//   bias     (6 HIDDEN)                    float   of w_in, then of w_state
//   states   (N, T, HIDDEN)                float
//
// A group of HIDDEN / VEC work-items walks one sequence through its frames; each keeps VEC units of the state in registers, and
// all read the whole state of the frame before from local memory.
//
// Macros (vectors.cl stands before this file): VEC, HIDDEN

// The position that `root` has in the first frame, the mean over the persons, is taken from the `moved` nodes from `first_moved` on.
kernel void poses(global const float* restrict motion, global float* restrict x, uint rows, uint begin,
                  uint channels, uint frames, uint nodes, uint numbers, uint root, uint first_moved,
                  uint moved) {
    const uint place = get_global_id(0), row = get_global_id(1);
    const uint inputs = channels * nodes;
    if (place >= inputs || row >= rows) return;
    const uint sequence = begin + row / frames, t = row % frames, node = place / channels,
               channel = place % channels, axis = channel % numbers;
    global const float* from = motion + (size_t)sequence * channels * frames * nodes;
    float value = from[((size_t)channel * frames + t) * nodes + node];
    if (axis < 3 && node >= first_moved && node < first_moved + moved) {
        float sum = 0;
        for (uint c = axis; c < channels; c += numbers) sum += from[(size_t)c * frames * nodes + root];
        value -= sum / (channels / numbers);
    }
    x[(size_t)row * inputs + place] = value;
}

VECTOR sigmoid(VECTOR v) {
    return 1.0f / (1.0f + exp(-v));
}

kernel void layer(global const float* restrict x, global const float* restrict initial,
                  global const float* restrict w_in, global const float* restrict w_state,
                  global const float* restrict bias, global float* restrict states, uint frames,
                  uint inputs) {
    local float before[HIDDEN];
    const uint item = get_local_id(0);
    const size_t sequence = get_group_id(0);
    VECTOR state = LOAD(item, initial + sequence * HIDDEN);
    for (uint t = 0; t < frames; ++t) {
        STORE(state, item, before);
        barrier(CLK_LOCAL_MEM_FENCE);
        VECTOR r = LOAD(item, bias) + LOAD(item, bias + 3 * HIDDEN);
        VECTOR z = LOAD(item, bias + HIDDEN) + LOAD(item, bias + 4 * HIDDEN);
        VECTOR n = LOAD(item, bias + 2 * HIDDEN), u = LOAD(item, bias + 5 * HIDDEN);
        global const float* pose = x + (sequence * frames + t) * inputs;
        for (uint i = 0; i < inputs; ++i) {
            global const float* w = w_in + (size_t)i * 3 * HIDDEN;
            const VECTOR value = pose[i];
            r = fma(value, LOAD(item, w), r);
            z = fma(value, LOAD(item, w + HIDDEN), z);
            n = fma(value, LOAD(item, w + 2 * HIDDEN), n);
        }
        for (uint i = 0; i < HIDDEN; ++i) {
            global const float* w = w_state + (size_t)i * 3 * HIDDEN;
            const VECTOR value = before[i];
            r = fma(value, LOAD(item, w), r);
            z = fma(value, LOAD(item, w + HIDDEN), z);
            u = fma(value, LOAD(item, w + 2 * HIDDEN), u);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        n = tanh(n + sigmoid(r) * u);
        state = n + sigmoid(z) * (state - n);
        STORE(state, item, states + (sequence * frames + t) * HIDDEN);
    }
}

// to (rows, outputs) from `first` rows on = w (outputs, inputs) times rows of x, `pitch` numbers apart from `start` on, plus bias;
// `squash` puts a tanh behind.
kernel void dense(global const float* restrict x, global const float* restrict w,
                  global const float* restrict bias, global float* restrict to, uint rows, uint inputs,
                  uint outputs, uint start, uint pitch, uint first, uint squash) {
    const uint output = get_global_id(0), row = get_global_id(1);
    if (output >= outputs || row >= rows) return;
    float sum = bias[output];
    for (uint i = 0; i < inputs; ++i)
        sum = fma(x[start + (size_t)row * pitch + i], w[(size_t)output * inputs + i], sum);
    to[(size_t)(first + row) * outputs + output] = squash ? tanh(sum) : sum;
}
