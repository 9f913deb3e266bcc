// The multiply-adds a device can do at most: chains in registers, enough of them to hide the latency, no memory.
//
// Data layout
//   out   (work-items)  float   what comes out, so that nothing is optimised away
//
// Macros (vectors.cl stands before this file): VEC, CHAINS

kernel void peak(global float* out, uint steps) {
    VECTOR chain[CHAINS];
#pragma unroll
    for (int i = 0; i < CHAINS; ++i) chain[i] = (VECTOR)((float)(get_global_id(0) + i));
    const VECTOR factor = (VECTOR)(0.999f), term = (VECTOR)(0.001f);
    for (uint step = 0; step < steps; ++step)
#pragma unroll
        for (int i = 0; i < CHAINS; ++i) chain[i] = fma(chain[i], factor, term);
    VECTOR sum = chain[0];
#pragma unroll
    for (int i = 1; i < CHAINS; ++i) sum += chain[i];
    float all[VEC];
    STORE(sum, 0, all);
    float total = 0;
    for (int i = 0; i < VEC; ++i) total += all[i];
    out[get_global_id(0)] = total;
}
