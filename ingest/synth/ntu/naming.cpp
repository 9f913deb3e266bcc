#include "ingest/synth/ntu/naming.hpp"

#include <fmt/format.h>

#include <array>

#include "ingest/formats/ntu/actions.hpp"

namespace actformer::ingest::synth {
namespace {

/// Performers the cross-subject protocol tests on, and those it trains on: 53 each.
const std::array<std::vector<int>, 2>& sides() {
    static const auto both = [] {
        std::array<std::vector<int>, 2> out;
        for (int p = 1; p <= performers; ++p) out[ntu::xsub_train(p) ? 1 : 0].push_back(p);
        return out;
    }();
    return both;
}

}  // namespace

std::string ClipId::name() const {
    return fmt::format("S{:03}C{:03}P{:03}R{:03}A{:03}", setup, camera, performer, replication, action);
}

ClipId clip_at(std::uint64_t i, const std::vector<int>& actions) {
    const auto n = actions.size();
    const int action = actions[i % n];

    // Digits of the clip's number within its action, the fastest first: the sides of the splits, then who and
    // where.
    auto rest = i / n;
    const auto digit = [&rest](std::uint64_t base) {
        const auto d = rest % base;
        rest /= base;
        return d;
    };
    const auto side = digit(2), parity = digit(2), camera = digit(3), replication = digit(2);
    const auto half = performers / 2, pairs = setups / 2;
    const auto who = digit(half), where = digit(pairs);

    // Slow digits turn with the fast ones and with the action, so that a small set is spread out too. Each
    // digit is shifted only by others that stay as they are or are found again from what is shown, so no clip
    // comes twice.
    const auto a = static_cast<std::uint64_t>(action);
    const auto low = side + 2 * parity + 4 * camera + 12 * replication;
    ClipId id;
    id.action = action;
    const auto train = (side + a) % 2;
    const auto odd = (parity + side + a / 2) % 2;
    id.camera = 1 + static_cast<int>((camera + parity + side + a) % cameras);
    id.replication = 1 + static_cast<int>((replication + camera + a / 3) % replications);
    id.performer = sides()[train][(who + 11 * low + 7 * a) % half];
    id.setup = 1 + static_cast<int>(2 * ((where + 3 * who + 5 * low + 3 * a) % pairs) + odd);
    return id;
}

}  // namespace actformer::ingest::synth
