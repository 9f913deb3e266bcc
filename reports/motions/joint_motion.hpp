// What is drawn: one motion of one or more persons as joint positions, with a title.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/body_model.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"
#include "reports/motions/body_skin.hpp"

namespace actformer::reports {

/// joints (frames, persons, K, 3) float32 in metres, y up, right-handed, for K joints of `topology`.
struct JointMotion {
    std::string title;  ///< UTF-8; may be empty, and is cut to fit
    ingest::Topology topology;
    std::uint32_t persons = 0, frames = 0;
    double fps = 30;
    std::vector<float> joints;
    std::vector<std::uint8_t> seen;  ///< (frames, persons), 0 where a body is not there; empty: always there
    std::optional<std::uint32_t> label;      ///< its class, where that is known
    std::shared_ptr<const BodySkin> skin{};  ///< drawn in place of limbs; null: limbs are drawn
    ingest::Motion rotations{};              ///< (frames, persons, 25, 6) that move the skin

    const float* at(std::size_t frame, std::size_t person, std::size_t joint) const {
        return &joints[((frame * persons + person) * topology.joints() + joint) * 3];
    }
    bool visible(std::size_t frame, std::size_t person) const {
        return seen.empty() || seen[frame * persons + person] != 0;
    }
    double seconds() const { return frames / fps; }
};

/// The most persons that one motion may have: beyond it, nobody could tell them apart.
constexpr std::uint32_t most_persons = 64;

/// Throws Error naming the motion and the place where it cannot be drawn: no frames, nobody in sight, too
/// many persons, sizes that disagree, or (of visible bodies) a joint that is not a number or further than 100
/// km away.
void check(const JointMotion& motion);

/// Throws Error as check() does, and where the motion does not fit the body model.
JointMotion joint_motion(const ingest::Motion& motion, const ingest::BodyModel& body, double fps,
                         std::string title);

/// Rotations of SMPL's joints with a body on them, whose skeleton takes the place of `body`'s. Throws Error as joint_motion() and
/// ingest::check_takes_body() do.
JointMotion joint_motion(const ingest::Motion& motion, ingest::BodyModel body, double fps, std::string title,
                         const std::shared_ptr<const BodySkin>& skin);

/// A raw capture, every body in it a person that is seen in some frames. Throws Error as check() does.
JointMotion joint_motion(const ingest::SkeletonFile& file, std::string title);

}  // namespace actformer::reports
