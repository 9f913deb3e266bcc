// Gap filling: every output frame is a blend of two detections. Which two, and how much of each, is found here; smooth.cl blends.
//
// Data layout
//   times   (detections)        float  when each detection was made, rising within a sequence
//   first   (clips*P + 1)       uint   detections of sequence s = clip*P + person: first[s] .. first[s+1]-1
//   start   (clips + 1)         uint   output frames of a clip: start[clip] .. start[clip+1]-1
//   step    (clips)             float  output frame t of a clip shows time t * step
//   owner   (frames)            uint   the clip of each output frame
//   pair    (frames, P)         uint2  the detections before and after
//   weight  (frames, P)         float  how much of the one after

// One work-item a (person, frame): binary search for the detections around the frame's time.
kernel void locate(global const float* times, global const uint* first, global const uint* start,
                   global const float* step, global const uint* owner, global uint2* pair,
                   global float* weight, uint persons, uint frames) {
    const uint person = get_global_id(0), frame = get_global_id(1);
    if (person >= persons || frame >= frames) return;
    const uint clip = owner[frame];
    const float time = (float)(frame - start[clip]) * step[clip];

    uint below = first[clip * persons + person];  // the last detection not after `time`, or the first of all
    uint above = first[clip * persons + person + 1];  // the one behind it, or the end
    const uint end = above;
    while (above - below > 1) {
        const uint middle = below + (above - below) / 2;
        if (times[middle] <= time)
            below = middle;
        else
            above = middle;
    }
    const uint next = min(below + 1, end - 1);
    const float span = times[next] - times[below];
    // Before the first detection the blend would reach below 0: the clamp holds it; after the last, span is 0.
    pair[frame * persons + person] = (uint2)(below, next);
    weight[frame * persons + person] = span > 0 ? clamp((time - times[below]) / span, 0.0f, 1.0f) : 0.0f;
}
