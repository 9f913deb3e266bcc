#include "reports/page/moving.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reports/page/packed.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

/// The box that joints stay in.
struct Box {
    std::array<float, 3> low{}, high{};

    explicit Box(const std::vector<float>& joints) {
        low.fill(INFINITY), high.fill(-INFINITY);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            low[i % 3] = std::min(low[i % 3], joints[i]);
            high[i % 3] = std::max(high[i % 3], joints[i]);
        }
    }
    float centre(std::size_t axis) const { return (low[axis] + high[axis]) / 2; }
    float half() const {
        float most = 0;
        for (std::size_t a = 0; a < 3; ++a) most = std::max(most, (high[a] - low[a]) / 2);
        return most;
    }
};

/// Joints (frames / step, persons, K, 3), with bodies that are not there put where they were last seen.
std::vector<float> shown_joints(const JointMotion& motion, std::uint32_t frames, std::uint32_t step) {
    auto joints = motion.joints;
    const std::size_t body = motion.topology.joints() * 3, frame = motion.persons * body;
    for (std::uint32_t t = 1; t < frames; ++t)
        for (std::uint32_t p = 0; p < motion.persons; ++p)
            if (!motion.visible(t, p))
                std::copy_n(&joints[(t - 1) * frame + p * body], body, &joints[t * frame + p * body]);
    std::vector<float> out;
    for (std::uint32_t t = 0; t < frames; t += step)
        out.insert(out.end(), &joints[t * frame], &joints[t * frame] + frame);
    return out;
}

}  // namespace

nlohmann::ordered_json packed_motion(const JointMotion& motion, std::uint32_t frames, std::uint32_t step) {
    constexpr float most = 32767;
    const auto joints = shown_joints(motion, std::min(frames, motion.frames), step);
    const Box box(joints);
    const float scale = std::max(box.half(), 1e-3F) / most;
    std::vector<std::int16_t> whole(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const float steps = std::round((joints[i] - box.centre(i % 3)) / scale);
        whole[i] = static_cast<std::int16_t>(std::clamp(steps, -most, most));
    }
    Json out{{"label", motion.label ? Json(*motion.label) : Json(nullptr)},
             {"title", motion.title},
             {"persons", motion.persons},
             {"frames", joints.size() / (motion.persons * motion.topology.joints() * 3)},
             {"fps", motion.fps / step}};
    out["origin"] = {box.centre(0), box.centre(1), box.centre(2)};
    out["scale"] = scale;
    out["xyz"] = packed(whole);
    return out;
}

nlohmann::ordered_json topology_json(const ingest::Topology& topology) {
    return {{"parents", topology.parents}, {"names", topology.names}};
}

}  // namespace actformer::reports
