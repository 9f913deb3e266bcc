#include "ingest/synth/ntu/performance.hpp"

#include "ingest/formats/ntu/actions.hpp"
#include "ingest/synth/performer/play.hpp"
#include "ingest/synth/programmes/ntu.hpp"

namespace actformer::ingest::synth {
namespace {

Casting without_cast(const NtuCasting& c) {
    return {{c.seed, static_cast<std::uint64_t>(c.setup), static_cast<std::uint64_t>(c.performer),
             static_cast<std::uint64_t>(c.replication), static_cast<std::uint64_t>(c.action)},
            {}};
}

Performer performer_of(int number) {
    return {body_of(number), static_cast<std::uint64_t>(number)};
}

/// Sides exchanged: as if seen in a mirror.
Joints mirrored(const Joints& in) {
    static constexpr std::array<Joint, joints> twin = {
        pelvis,      spine,         neck,       head,       right_shoulder, right_elbow, right_wrist,
        right_hand,  left_shoulder, left_elbow, left_wrist, left_hand,      right_hip,   right_knee,
        right_ankle, right_foot,    left_hip,   left_knee,  left_ankle,     left_foot,   chest,
        right_tip,   right_thumb,   left_tip,   left_thumb};
    Joints out;
    for (int j = 0; j < joints; ++j) out[twin[j]] = {-in[j].x, in[j].y, in[j].z};
    return out;
}

}  // namespace

int partner_of(const NtuCasting& casting) {
    auto random = without_cast(casting).stream(2);
    const bool side = ntu::xsub_train(casting.performer);
    for (;;) {
        const int partner = 1 + random.below(106);
        if (partner != casting.performer && ntu::xsub_train(partner) == side) return partner;
    }
}

Performance perform(const NtuCasting& casting) {
    const auto& programme = programme_of(casting.action);
    auto scene = without_cast(casting);
    scene.cast = {performer_of(casting.performer)};
    if (programme.persons == 2) scene.cast.push_back(performer_of(partner_of(casting)));
    if (scene.stream(3).chance(0.5) && programme.persons == 2)
        std::swap(scene.cast[0], scene.cast[1]);  // either may begin

    const auto played = play(programme, scene);
    Performance out{played.persons, {}, played.contact};
    const Rotation turn_scene = about_y(played.facing);
    for (const auto& figures : played.frames) {
        auto& frame = out.frames.emplace_back();
        for (int p = 0; p < out.persons; ++p) {
            frame[p] = played.mirrored ? mirrored(figures[p].at) : figures[p].at;
            for (auto& v : frame[p]) v = turn_scene * v + Vec{played.x, 0, played.z};
        }
    }
    return out;
}

}  // namespace actformer::ingest::synth
