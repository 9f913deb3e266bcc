// Philox4x32-10, the counter-based generator of Salmon, Moraes, Dror and Shaw (2011): ten rounds turn a counter of four
// words and a key of two into four random words. It keeps no state and uses integers only, so that the same counter and
// key give the same words on every device and in any order of work-items. This file is put before those that draw.

uint4 philox(uint4 counter, uint2 key) {
    for (int round = 0; round < 10; ++round) {
        const uint low0 = 0xD2511F53u * counter.x, high0 = mul_hi(0xD2511F53u, counter.x);
        const uint low1 = 0xCD9E8D57u * counter.z, high1 = mul_hi(0xCD9E8D57u, counter.z);
        counter = (uint4)(high1 ^ counter.y ^ key.x, low1, high0 ^ counter.w ^ key.y, low0);
        key += (uint2)(0x9E3779B9u, 0xBB67AE85u);
    }
    return counter;
}
