#include "ingest/formats/rotational/pose_rows.hpp"

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

struct OtherBody {
    std::uint64_t numbers;
    std::string_view name;
};

constexpr OtherBody other_bodies[] = {{156, "52 joints, as SMPL+H has"},
                                      {165, "55 joints, as SMPL-X has"},
                                      {66, "22 joints, as SMPL-X's body has"},
                                      {63, "21 joints, as SMPL-X's body without its root has"}};

}  // namespace

NumpyRows smpl_poses(const NumpyArray& array, std::string_view name) {
    if (array.shape.size() == 2)
        for (const auto& other : other_bodies)
            if (array.shape[1] == other.numbers)
                throw Error("{} {} has {}; SMPL's 24 are meant: (frames, 72)", in_quotes(name),
                            array.shape_text(), other.name);
    return NumpyRows(array, name, {smpl_joints * 3});
}

RotationalMotion motion_of(const NumpyRows& poses, const Translation& translation) {
    if (poses.count() == 0) throw Error("no frame");
    RotationVectors vectors;
    vectors.frames = poses.count();
    vectors.read = [&](std::uint64_t frame, double* pose, double* xyz) {
        poses.read(frame, pose);
        translation(frame, xyz);
    };
    return as_recorded(vectors);
}

std::unique_ptr<RotationalClip> whole(const RotationalMotion& motion, const RotationalTarget& target) {
    return RotationalTrack(motion, target).cut(0, motion.frames);
}

}  // namespace actformer::ingest
