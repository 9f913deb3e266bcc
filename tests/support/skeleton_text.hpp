// Raw NTU RGB+D text made by hand, well-formed until a test breaks it.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace actformer::test {

using Pose = std::array<std::array<double, 3>, 25>;

/// One body: a pose in every frame in which it is seen.
struct SeenBody {
    std::string id;
    std::vector<std::optional<Pose>> frames;
};

/// A smooth random motion in metres, some 3 m before the camera; `seed` tells bodies apart.
inline std::vector<Pose> random_motion(int frames, unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    std::vector<Pose> motion(frames);
    for (std::size_t j = 0; j < 25; ++j)
        for (std::size_t d = 0; d < 3; ++d) {
            const double at = (d == 2 ? 3 : 0) + uniform() - 0.5, swing = 0.3 * uniform(),
                         speed = 0.3 * uniform();
            for (int t = 0; t < frames; ++t)
                motion[t][j][d] = at + swing * std::sin(speed * t) + 0.01 * uniform();
        }
    return motion;
}

inline SeenBody always_seen(const std::string& id, const std::vector<Pose>& motion) {
    return {id, {motion.begin(), motion.end()}};
}

inline std::string skeleton_text(int frames, const std::vector<SeenBody>& bodies,
                                 const std::string& newline = "\n") {
    std::string text = std::to_string(frames) + newline;
    for (int t = 0; t < frames; ++t) {
        int seen = 0;
        for (const auto& body : bodies) seen += body.frames[t].has_value();
        text += std::to_string(seen) + newline;
        for (const auto& body : bodies) {
            if (!body.frames[t]) continue;
            text += body.id + " 0 1 1 1 1 0 0.02764709 0.05745083 2" + newline + "25" + newline;
            for (const auto& joint : *body.frames[t])
                text += fmt::format(
                    "{:.7g} {:.7g} {:.7g} 277.4 191.8 1036.2 519.1 -0.2059419 0.053 0.96 -0.12 2{}", joint[0],
                    joint[1], joint[2], newline);
        }
    }
    return text;
}

/// A clip of one body seen throughout.
inline std::string plain_clip(int frames = 20, unsigned seed = 1) {
    return skeleton_text(frames, {always_seen("72057594037931101", random_motion(frames, seed))});
}

}  // namespace actformer::test
