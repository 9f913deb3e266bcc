// How often a test repeats itself.
#pragma once

namespace actformer::test {

#ifdef ACTFORMER_SANITIZED
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

/// Rounds of a test over drawn inputs: a twentieth under sanitizers, where a round costs ten to twenty times and takes the same ways.
constexpr int rounds(int all) {
    return sanitized ? all / 20 : all;
}

}  // namespace actformer::test
